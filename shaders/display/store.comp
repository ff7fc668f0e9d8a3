#version 450

// Nothing but stores: the least that a pass over a frame could be.
layout(local_size_x = 64) in;
layout(binding = 0, rgba32ui) uniform writeonly uimageBuffer words;
layout(push_constant) uniform Push { int end; } push;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  if (i < push.end) imageStore(words, i, uvec4(0xff000000u));
}
