#version 450
// c[i] = a[(i + shift) mod count] + kFactor b[i]
layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kFactor = 1;
layout(std430, set = 0, binding = 0) readonly buffer A { uint a[]; };
layout(std430, set = 0, binding = 1) readonly buffer B { uint b[]; };
layout(std430, set = 0, binding = 2) writeonly buffer C { uint c[]; };
layout(push_constant) uniform Push { uint count; uint shift; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i < count) c[i] = a[(i + shift) % count] + kFactor * b[i];
}
