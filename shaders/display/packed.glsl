// Four bytes a pixel: R, G, B, 255.
uint packed(vec3 levels) {
  uvec3 bytes = uvec3(levels + 0.5);
  return bytes.x | (bytes.y << 8) | (bytes.z << 16) | 0xff000000u;
}
