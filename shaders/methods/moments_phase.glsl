// The phase functions of a scene as the moment tables use them, after device.glsl. The buffer is filled by
// engine/methods/moments/phase_series.cpp.
layout(constant_id = 10) const int DEGREE = 4;         // of the moments, L
layout(constant_id = 11) const bool PARTICLES = true;  // Rayleigh's function has no odd terms
const int SERIES = DEGREE + 1;                         // terms in azimuth
const int TERMS = 2 * DEGREE + 3;                      // of a particle's phase in order one
const int SLOTS = (DEGREE + 1) * (DEGREE + 2) / 2 + 1; // the last one is the aureole's
const int AUREOLE = SLOTS - 1;

layout(binding = OWN, rgba32f) uniform restrict readonly imageBuffer phase_series;
// (2 l + 1) / (4 pi) chi_l of each constituent's phase, l below TERMS, damped beyond L.
#define series(c, l, group) READ(phase_series, ((c) * TERMS + (l)) * GROUPS + (group))
// What of a moment of degree l up to L a constituent scatters on.
#define scattered_share(c, l, group) READ(phase_series, (MEDIA * TERMS + (c) * SERIES + (l)) * GROUPS + (group))
// Of a constituent's extinction, less its forward peak.
#define share_of_extinction(c) READ(phase_series, MEDIA * (TERMS + SERIES) * GROUPS + (c)).x
// The aureole's function of angle.
#define aureole(node, group) \
  READ(phase_series, MEDIA * ((TERMS + SERIES) * GROUPS + 1) + (node) * GROUPS + (group))
