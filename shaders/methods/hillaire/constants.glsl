// Sizes of the tables of Hillaire's method, as the kernels are specialised by them; 10 and 11 are those of
// the optical depths.
layout(constant_id = 12) const int MULTIPLE_SUNS = 2;
layout(constant_id = 13) const int MULTIPLE_ALTITUDES = 2;
layout(constant_id = 14) const int SKY_VIEW_AZIMUTHS = 2;
layout(constant_id = 15) const int SKY_VIEW_ELEVATIONS = 4;
layout(constant_id = 16) const int SKY_VIEW_STOPS = 1;  // of parts of rays; 1: whole rays

// The share of each constituent's scattering that changes a direction, by group of wavelengths: the rest is
// a forward peak that goes straight on. Tables are made without it (with optical depths to match), and
// first order is given back by pixels what it lost of its phase function.
layout(binding = OWN + 1, rgba32f) uniform restrict readonly imageBuffer scattering_kept;
Vec4 forward_gain_[MEDIA_GROUPS_SIZE];
#define forward_gain(c, group) forward_gain_[(c) * GROUPS + (group)]

void take_out_forward_peak() {
  UNROLL for (int i = 0; i < MEDIA * GROUPS; ++i) {
    Vec4 kept = READ(scattering_kept, i);
    extinction_[i] = extinction_[i] - scattering_[i] * (1.0 - kept);
    scattering_[i] = scattering_[i] * kept;
    forward_gain_[i] = 1.0 / kept;
  }
}

#define OPTICAL_DEPTH_BINDING OWN
#include "tables/optical_depth_buffer.glsl"
#include "tables/stops.glsl"
#include "methods/hillaire/coordinates.glsl"
#include "methods/hillaire/march.glsl"
