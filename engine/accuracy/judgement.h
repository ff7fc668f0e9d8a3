// A picture that was made elsewhere against the converged solution of a scene.
#pragma once

#include <vector>

#include "engine/accuracy/comparison.h"
#include "engine/accuracy/reference.h"
#include "engine/engine.h"
#include "engine/image/picture.h"

namespace cyanometer {

/// How good the reference of a judgement must be. Where noise stays above it, walks end after
/// some twenty seconds on two cores of a software device, and the interval says what is not
/// known.
struct JudgementGoal {
  ReferenceGoal reference{.rays = 256, .noise = 0.004};
  int contours = 512;  ///< that are looked at, of all that the picture has
};

/// Error, bias, p99 and maximum on stratified pixels against `path`; the colours of the same
/// pixels; contours wherever the picture has some. What shows the sun's disc or a star is left
/// out where the scene shows them.
/// @throws OverLimit, Cancelled, DeviceLost
Comparison judge(Engine& engine, const Scene& scene, const ExrImage& image,
                 const JudgementGoal& goal = {}, const Watch& watch = {});

/// Its error by pixel (error_map), of the whole frame, against the finest solution without
/// random numbers.
std::vector<float> judged_map(Engine& engine, const Scene& scene, const ExrImage& image,
                              const Watch& watch = {});

}  // namespace cyanometer
