#version 450
#extension GL_GOOGLE_include_directive : require
#define ANY_PROJECTION
#include "device.glsl"

// Segments of each half of a ray that a step of a walk looks at.
layout(constant_id = 10) const int SEGMENTS = 8;
// Whether proposals know where the light is.
layout(constant_id = 11) const bool GUIDED = false;
// What the ground is (surface/data.glsl).
layout(constant_id = 12) const int SURFACE_KIND = 0;

layout(binding = OWN, r32f) uniform restrict readonly imageBuffer path_guide;
// By lane, between two dispatches: direction and altitude, sun and strength, then the throughput of every
// group of wavelengths; where the ground is not the same everywhere also two axes.
layout(binding = OWN + 1, rgba32f) uniform restrict imageBuffer walks;
// By lane: walks done, vertices of this walk, whether its first one is on the ground.
layout(std430, binding = OWN + 2) restrict buffer CountBuffer { ivec4 counts[]; };
// By lane: sums over finished blocks and over the block in progress, each of inscatter and of ground.
layout(binding = OWN + 3, rgba32f) uniform restrict imageBuffer sums;
layout(std430, binding = OWN + 4) restrict buffer UnfinishedBuffer { uint unfinished; };  // lanes
// km from the camera to the ground along each ray; idle where the ground is the same everywhere.
layout(binding = OWN + 5, r32f) uniform restrict readonly imageBuffer distances_km;

#include "surface/surface.glsl"
#include "methods/path.glsl"

const bool SURFACE = SURFACE_KIND != SURFACE_UNIFORM;

layout(push_constant) uniform Push {
  int first_ray;      // of the tile, in the frame
  int rays_in_tile;
  int slices;         // of each ray's walks, a lane for each
  int walks_of_ray;
  int orders;         // -1 all
  int steps;          // of this dispatch
  uint seed;
  uint fresh;         // 1: nothing has been done yet
} push;

// Float sums of many walks keep their digits when they are summed by blocks.
const int BLOCK = 512;

void main() {
  load_scene();
  load_media();
  int lane = int(gl_GlobalInvocationID.x);
  int lanes = push.rays_in_tile * push.slices;
  if (lane >= lanes) return;
  bool fresh = push.fresh != 0u;
  int slice = lane % push.slices;
  int ray = push.first_ray + lane / push.slices;
  PixelRay pixel = pixel_ray(ray);
  Path path = path_of_ray(ray, pixel);
  int walks_of_lane =
      meets_planet(path)
          ? (push.walks_of_ray - slice + push.slices - 1) / push.slices
          : 0;

  Walk walk;
  Vec4 throughput[GROUPS];
  Vec4 sky[GROUPS];
  Vec4 ground[GROUPS];
  ivec4 count = fresh ? ivec4(0) : counts[lane];
  walk.direction = READ(walks, lane).xyz;
  walk.altitude_km = READ(walks, lane).w;
  walk.sun = READ(walks, lanes + lane).xyz;
  walk.strength = READ(walks, lanes + lane).w;
  walk.vertices = count.y;
  bool ground_first = count.z != 0;
  if (SURFACE) {
    walk.foot_east = READ(walks, (2 + GROUPS) * lanes + lane).xyz;
    walk.foot_up = READ(walks, (3 + GROUPS) * lanes + lane).xyz;
  }
  // 0 where the ray does not end on the ground.
  Real ground_km = SURFACE ? READ_REAL(distances_km, ray) : 0.0;
  bool on_ground = SURFACE && ground_km < ENDLESS && end_of_ray(ray) >= ground_km * (1.0 - 1e-6);
  Real width_km = on_ground ? max(pixel_width_km(ground_km), 1e-9) : 0.0;
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    throughput[g] = READ(walks, (2 + g) * lanes + lane);
    if (fresh) {
      WRITE(sums, g * lanes + lane, Vec4(0.0));
      WRITE(sums, (GROUPS + g) * lanes + lane, Vec4(0.0));
    }
    sky[g] = fresh ? Vec4(0.0) : READ(sums, (2 * GROUPS + g) * lanes + lane);
    ground[g] = fresh ? Vec4(0.0) : READ(sums, (3 * GROUPS + g) * lanes + lane);
  }

  Stream stream;
  stream.ray = uint(ray);
  stream.seed = push.seed;
  for (int i = 0; i < push.steps; ++i) {
    if (count.x == walks_of_lane) break;
    stream.path = uint(count.x * push.slices + slice);
    if (walk.vertices == 0) walk = start_walk(path, stream, throughput);
    Vec4 radiance[GROUPS];
    UNROLL for (int g = 0; g < GROUPS; ++g) radiance[g] = Vec4(0.0);
    bool goes_on = step_walk(walk, stream, push.orders, end_of_flight(path, walk), width_km, throughput,
                             radiance, ground_first);
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      if (ground_first) {
        ground[g] += radiance[g];
      } else {
        sky[g] += radiance[g];
      }
    }
    if (goes_on) continue;
    walk.vertices = 0;
    count.x += 1;
    if (count.x % BLOCK == 0 || count.x == walks_of_lane) {
      UNROLL for (int g = 0; g < GROUPS; ++g) {
        WRITE(sums, g * lanes + lane, READ(sums, g * lanes + lane) + sky[g]);
        WRITE(sums, (GROUPS + g) * lanes + lane, READ(sums, (GROUPS + g) * lanes + lane) + ground[g]);
        sky[g] = Vec4(0.0);
        ground[g] = Vec4(0.0);
      }
    }
  }

  if (count.x < walks_of_lane) atomicAdd(unfinished, 1u);
  WRITE(walks, lane, Vec4(walk.direction, walk.altitude_km));
  WRITE(walks, lanes + lane, Vec4(walk.sun, walk.strength));
  if (SURFACE) {
    WRITE(walks, (2 + GROUPS) * lanes + lane, Vec4(walk.foot_east, 0.0));
    WRITE(walks, (3 + GROUPS) * lanes + lane, Vec4(walk.foot_up, 0.0));
  }
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    WRITE(walks, (2 + g) * lanes + lane, throughput[g]);
    WRITE(sums, (2 * GROUPS + g) * lanes + lane, sky[g]);
    WRITE(sums, (3 * GROUPS + g) * lanes + lane, ground[g]);
  }
  counts[lane] = ivec4(count.x, walk.vertices, ground_first ? 1 : 0, 0);
}
