#version 450
// Texels of every kind that kernels know, and a storage buffer between them:
// counts[i] += table[i].w + values[i] + pairs[i].y + plain[i]
layout(local_size_x = 64) in;
layout(binding = 0, rgba32f) uniform readonly imageBuffer table;
layout(binding = 1, r32f) uniform readonly imageBuffer values;
layout(binding = 2, rgba32ui) uniform readonly uimageBuffer pairs;
layout(std430, binding = 3) readonly buffer Plain { uint plain[]; };
layout(binding = 4, r32ui) uniform uimageBuffer counts;

void main() {
  int i = int(gl_GlobalInvocationID.x);
  uint sum = imageLoad(counts, i).x + uint(imageLoad(table, i).w) + uint(imageLoad(values, i).x) +
             imageLoad(pairs, i).y + plain[i];
  imageStore(counts, i, uvec4(sum));
}
