// Reads the diffuse irradiance of the ground by the sun's zenith cosine, per unit of the sun's. Define
// IRRADIANCE_BINDING first.
layout(binding = IRRADIANCE_BINDING, rgba32f) uniform restrict readonly imageBuffer irradiances;

Vec4 diffuse_irradiance(Real mu_s, int group) {
  Between sun = between_suns(source, mu_s);
  int low = group * source.suns + sun.node;
  return decoded(mix(READ(irradiances, low), READ(irradiances, low + 1), sun.share));
}
