// Reads the view table: light of the orders from the second on. Included after view_table.glsl; define
// VIEW_BINDING first.
layout(binding = VIEW_BINDING, rgba32f) uniform restrict readonly imageBuffer views;

Vec4 view_in_direction(ViewPosition at, int texel) {
  int next = texel + grid.azimuths;
  return mix(mix(READ(views, texel), READ(views, texel + 1), at.azimuth.share),
             mix(READ(views, next), READ(views, next + 1), at.azimuth.share), at.zenith.share);
}

Vec4 scattered(ViewPosition at, int group) {
  Vec4 value = Vec4(0.0);
  UNROLL for (int s = 0; s < VIEW_SUNS; ++s) {
    UNROLL for (int a = 0; a < VIEW_ALTITUDES; ++a) {
      Real weight = (s == 0 ? 1.0 - at.sun.share : at.sun.share) *
                    (a == 0 ? 1.0 - at.altitude.share : at.altitude.share);
      int texel = group * texels() + view_texel(at, a, s);
      value = value + weight * view_in_direction(at, texel);
    }
  }
  return decoded(value);
}
