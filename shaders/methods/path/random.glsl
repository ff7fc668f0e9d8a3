// Random numbers of the walks: a hash of what they belong to, so that no state is carried and no result
// depends on how the work is cut.

// [Jarzynski and Olano 2020, Hash functions for GPU rendering, JCGT 9(3): pcg4d]
UVec4 pcg4d(UVec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v = v ^ (v >> 16u);
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

// What a walk's numbers depend on, and nothing else: not on how the work is cut.
struct Stream {
  Uint ray;
  Uint path;
  Uint seed;
};

// Four numbers in (0, 1), the same in float and in double.
Vec4 uniform_numbers(Stream stream, int index) {
  UVec4 bits = pcg4d(UVec4(stream.ray, stream.path, Uint(index), stream.seed));
  return (Vec4(bits >> 9u) + Vec4(0.5)) * (1.0 / 8388608.0);
}
