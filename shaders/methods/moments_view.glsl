// What the kernels that read the finished moments have in common.
#include "device.glsl"

layout(constant_id = 10) const int DEGREE = 4;
layout(constant_id = 11) const bool PARTICLES = true;
const int TERMS = 2 * DEGREE + 3;
const int SLOTS = (DEGREE + 1) * (DEGREE + 2) / 2 + 1;
const int AUREOLE = SLOTS - 1;

#include "methods/moments.glsl"

// See moments_device.glsl; behind them, the aureole's function of angle.
layout(std430, binding = OWN) restrict readonly buffer PhaseSeriesBuffer { Vec4 phase_series[]; };
#define series(c, l, group) phase_series[((c) * TERMS + (l)) * GROUPS + (group)]
#define peak(c, group) phase_series[(MEDIA * TERMS + (c)) * GROUPS + (group)]
#define share_of_extinction(c) phase_series[MEDIA * (TERMS + 1) * GROUPS + (c)].x
#define aureole(node, group) phase_series[MEDIA * ((TERMS + 1) * GROUPS + 1) + (node) * GROUPS + (group)]

// All orders together, [altitude][sun][moment][group], then the irradiance of the ground by sun.
layout(std430, binding = OWN + 1) restrict readonly buffer MomentBuffer { Vec4 moments[]; };
