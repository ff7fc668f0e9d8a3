// Reads the source table: what the air scatters towards a direction, per unit of its scattering
// coefficient (1/sr). Define SOURCE_BINDING first.
layout(binding = SOURCE_BINDING, rgba32f) uniform restrict readonly imageBuffer sources;

// Where a ray's point and direction lie in the table.
struct SourcePosition {
  Between altitude;
  Between zenith;
  Between azimuth;
  Between sun;
};

int source_directions() { return source.zeniths * source.azimuths; }

SourcePosition source_position(Real altitude_coordinate, Real zenith_coordinate, Real mu_s,
                               Real cos_azimuth) {
  SourcePosition position;
  position.altitude = between(altitude_coordinate, source.altitudes);
  position.zenith = between(zenith_coordinate, source.zeniths);
  position.azimuth =
      between(acos(cos_azimuth) / PI * Real(source.azimuths - 1), source.azimuths);
  position.sun = between_suns(source, mu_s);
  return position;
}

// Of the four neighbours in direction from `texel` on.
Vec4 source_towards(int texel, Between zenith, Between azimuth) {
  int next = texel + source.azimuths;
  return mix(mix(READ(sources, texel), READ(sources, texel + 1), azimuth.share),
             mix(READ(sources, next), READ(sources, next + 1), azimuth.share), zenith.share);
}

Vec4 source_at(SourcePosition at, int group) {
  int row = source.suns * source_directions();
  int low = ((group * source.altitudes + at.altitude.node) * source.suns + at.sun.node) *
                source_directions() +
            at.zenith.node * source.azimuths + at.azimuth.node;
  int next = low + source_directions();
  return decoded(mix(mix(source_towards(low, at.zenith, at.azimuth),
                         source_towards(next, at.zenith, at.azimuth), at.sun.share),
                     mix(source_towards(low + row, at.zenith, at.azimuth),
                         source_towards(next + row, at.zenith, at.azimuth), at.sun.share),
                     at.altitude.share));
}
