#extension GL_EXT_control_flow_attributes : require

// What the physics files stand on in a shader: types, constants of the pipeline, buffers.
// engine/physics/physics.h is the same for C++.
#define Real float
#define Uint uint
#define UVec4 uvec4
#define Vec2 vec2
#define Vec3 vec3
#define Vec4 vec4
#define CONSTANT const
#define UNROLL [[unroll]]
// For loops that load from buffers and are long when unrolled: software drivers compile code in a time that grows
// faster than its length (a sum over 66 moments from four nodes each: 12 s unrolled, 0.6 s rolled), and run it no
// faster. An array that is indexed in such a loop lives in memory, everywhere.
#define ROLLED [[dont_unroll]]
#define ARRAY(T, name, n) in T name[n]
#define OUT_ARRAY(T, name, n) out T name[n]
#define INOUT_ARRAY(T, name, n) inout T name[n]
#define INOUT(T) inout T
// Tables are imageBuffers: on software devices a load from one costs a thirtieth of one from a storage buffer,
// which is read lane by lane, and less than an exponential.
#define READ(buffer, i) imageLoad(buffer, i)
#define READ_REAL(buffer, i) imageLoad(buffer, i).x
#define READ_UINT(buffer, i) imageLoad(buffer, i).x
#define WRITE(buffer, i, value) imageStore(buffer, i, value)
#define WRITE_REAL(buffer, i, value) imageStore(buffer, i, Vec4(value))

layout(local_size_x = 64) in;

// Constituents by type of profile, in this order; see engine/physics/pack.h.
layout(constant_id = 0) const int EXPONENTIALS = 0;
layout(constant_id = 1) const int TENTS = 0;
layout(constant_id = 2) const int QUADRATICS = 0;
layout(constant_id = 3) const int UNIFORMS = 0;
layout(constant_id = 4) const int TABLES = 0;
layout(constant_id = 5) const int MEDIA_SIZE = 1;  // of arrays: their sum, at least 1
layout(constant_id = 6) const int GROUPS = 1;      // wavelengths come in groups of four
#ifdef ANY_PROJECTION  // of a kernel whose rays take long: one pipeline for pictures and for lists of directions
#define PROJECTION scene.projection
#else
layout(constant_id = 7) const int PROJECTION = 0;
#endif
layout(constant_id = 8) const bool NEAR_SUN = false;
layout(constant_id = 9) const bool MANY_SUNS = false;  // more than one point of the disc
// Software devices run both sides of a branch: a kernel that is told that no phase function is tabulated
// evaluates the others in a third of the time. Apart from the scene's constants, so that kernels need not
// set it.
layout(constant_id = 31) const bool PHASE_TABLES = true;
const int MEDIA = EXPONENTIALS + TENTS + QUADRATICS + UNIFORMS + TABLES;
const int MEDIA_GROUPS_SIZE = MEDIA_SIZE * GROUPS;
#define GROUPS_SIZE GROUPS
#ifndef COLUMN_NODES
const int COLUMN_NODES = 8;  // physics/columns.glsl; a kernel that needs less defines it before
#endif

#include "physics/layout.glsl"

layout(std430, binding = 0) restrict readonly buffer SceneBuffer { SceneData stored_scene; };
layout(std430, binding = 1) restrict readonly buffer MediaBuffer { MediumData media[]; };
// By wavelength, in groups of four: ground albedo, limb-darkening exponent, then for each constituent
// extinction, scattering (1/km where its profile is 1) and depolarisation gamma.
layout(binding = 2, rgba32f) uniform restrict readonly imageBuffer spectra;
layout(binding = 3, rgba32f) uniform restrict readonly imageBuffer profile_nodes;
layout(binding = 4, r32f) uniform restrict readonly imageBuffer phase_angles;
layout(binding = 5, rgba32f) uniform restrict readonly imageBuffer phase_values;
// Points of the sun's disc: offset in the plane of the disc in units of the sine of its radius, then
// for each group of wavelengths the point's weight; at the end the scale of the disc that this frame draws, 1/sr.
layout(binding = 6, rgba32f) uniform restrict readonly imageBuffer sun_points;
layout(binding = 7, rgba32f) uniform restrict readonly imageBuffer directions;
layout(binding = 8, rgba32f) uniform restrict readonly imageBuffer quadrature;  // node, weight; then kinks
// How the ground differs from place to place (surface/data.glsl).
layout(binding = 9, rgba32f) uniform restrict readonly imageBuffer surface_values;
// Where rays end, km from the camera: one for all, or one a ray.
layout(binding = 10, r32f) uniform restrict readonly imageBuffer ends_km;
layout(binding = 11, r32ui) uniform restrict readonly uimageBuffer surface_texels;  // of a map
#define OWN 12  // a shader's own bindings: OWN, OWN + 1, ...

// A shader's main() begins with load_scene(), and load_media() where it marches, before any branch: what is not
// yet masked and the same for all invocations is one scalar load on software devices (64 floats of a structure
// take 25 ns then, behind a branch 430).
SceneData scene;
MediumData medium_[MEDIA_SIZE];
Vec4 extinction_[MEDIA_GROUPS_SIZE];
Vec4 scattering_[MEDIA_GROUPS_SIZE];

void load_scene() { scene = stored_scene; }

void load_media() {
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    medium_[c] = media[c];
    UNROLL for (int group = 0; group < GROUPS; ++group) {
      extinction_[c * GROUPS + group] = READ(spectra, (2 + 3 * c) * GROUPS + group);
      scattering_[c * GROUPS + group] = READ(spectra, (3 + 3 * c) * GROUPS + group);
    }
  }
}

#define medium(c) medium_[c]
#define extinction(c, group) extinction_[(c) * GROUPS + (group)]
#define scattering(c, group) scattering_[(c) * GROUPS + (group)]
#define depolarisation(c, group) READ(spectra, (4 + 3 * (c)) * GROUPS + (group))
#define ground_albedo(group) READ(spectra, group)
#define surface_texel(i) READ_UINT(surface_texels, i)
#define limb_exponent(group) READ(spectra, GROUPS + (group))
#define sun_offset(k) READ(sun_points, (k) * (GROUPS + 1)).xyz
#define sun_weight(k, group) READ(sun_points, (k) * (GROUPS + 1) + 1 + (group))
#define disc_scale(group) READ(sun_points, scene.disc_points * (GROUPS + 1) + (group))

#include "physics/physics.glsl"

// What a method leaves of a ray for every group of wavelengths: quantity * GROUPS + group picks a
// plane of `rays_in_tile` values. Radiance is per unit irradiance, 1/sr.
#define INSCATTER 0
#define GROUND 1
#define TRANSMITTANCE 2   // to the ground or to space
#define STANDARD_ERROR 3  // of inscatter and ground together; of random methods only
