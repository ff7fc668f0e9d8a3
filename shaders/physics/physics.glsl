// All of the physics, in the order in which it builds up. Shaders get here through device.glsl,
// C++ through engine/physics/physics.h.
#include "physics/constants.glsl"
#include "physics/sphere.glsl"
#include "physics/profile.glsl"
#include "physics/quadrature.glsl"
#include "physics/columns.glsl"
#include "physics/phase.glsl"
#include "physics/sun.glsl"
#include "physics/camera.glsl"
#include "physics/shadow.glsl"
#include "physics/transfer.glsl"
