#version 450
#extension GL_GOOGLE_include_directive : require
#include "device.glsl"

// Segments of each half of a ray that a step of a walk looks at.
layout(constant_id = 10) const int SEGMENTS = 8;
// Whether proposals know where the light is.
layout(constant_id = 11) const bool GUIDED = false;
// What the ground is (surface/data.glsl).
layout(constant_id = 12) const int SURFACE_KIND = 0;

layout(std430, binding = OWN) restrict readonly buffer GuideBuffer { Real path_guide[]; };
// By lane, between two dispatches: direction and altitude, sun and strength, then the throughput of every
// group of wavelengths; where the ground is not the same everywhere also two axes.
layout(std430, binding = OWN + 1) restrict buffer WalkBuffer { Vec4 walks[]; };
// By lane: walks done, vertices of this walk, whether its first one is on the ground.
layout(std430, binding = OWN + 2) restrict buffer CountBuffer { ivec4 counts[]; };
// By lane: sums over finished blocks and over the block in progress, each of inscatter and of ground.
layout(std430, binding = OWN + 3) restrict buffer SumBuffer { Vec4 sums[]; };
layout(std430, binding = OWN + 4) restrict buffer UnfinishedBuffer { uint unfinished; };  // lanes
// km from the camera to the ground along each ray; idle where the ground is the same everywhere.
layout(std430, binding = OWN + 5) restrict readonly buffer DistanceBuffer { Real distances_km[]; };

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
  int lane = int(gl_GlobalInvocationID.x);
  int lanes = push.rays_in_tile * push.slices;
  if (lane >= lanes) return;
  load_scene();
  load_media();
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
  walk.direction = walks[lane].xyz;
  walk.altitude_km = walks[lane].w;
  walk.sun = walks[lanes + lane].xyz;
  walk.strength = walks[lanes + lane].w;
  walk.vertices = count.y;
  bool ground_first = count.z != 0;
  if (SURFACE) {
    walk.foot_east = walks[(2 + GROUPS) * lanes + lane].xyz;
    walk.foot_up = walks[(3 + GROUPS) * lanes + lane].xyz;
  }
  // 0 where the ray does not end on the ground.
  Real ground_km = SURFACE ? distances_km[ray] : 0.0;
  bool on_ground = SURFACE && ground_km < ENDLESS && end_of_ray(ray) >= ground_km * (1.0 - 1e-6);
  Real width_km = on_ground ? max(pixel_width_km(ground_km), 1e-9) : 0.0;
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    throughput[g] = walks[(2 + g) * lanes + lane];
    if (fresh) {
      sums[g * lanes + lane] = Vec4(0.0);
      sums[(GROUPS + g) * lanes + lane] = Vec4(0.0);
    }
    sky[g] = fresh ? Vec4(0.0) : sums[(2 * GROUPS + g) * lanes + lane];
    ground[g] = fresh ? Vec4(0.0) : sums[(3 * GROUPS + g) * lanes + lane];
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
        sums[g * lanes + lane] += sky[g];
        sums[(GROUPS + g) * lanes + lane] += ground[g];
        sky[g] = Vec4(0.0);
        ground[g] = Vec4(0.0);
      }
    }
  }

  if (count.x < walks_of_lane) atomicAdd(unfinished, 1u);
  walks[lane] = Vec4(walk.direction, walk.altitude_km);
  walks[lanes + lane] = Vec4(walk.sun, walk.strength);
  if (SURFACE) {
    walks[(2 + GROUPS) * lanes + lane] = Vec4(walk.foot_east, 0.0);
    walks[(3 + GROUPS) * lanes + lane] = Vec4(walk.foot_up, 0.0);
  }
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    walks[(2 + g) * lanes + lane] = throughput[g];
    sums[(2 * GROUPS + g) * lanes + lane] = sky[g];
    sums[(3 * GROUPS + g) * lanes + lane] = ground[g];
  }
  counts[lane] = ivec4(count.x, walk.vertices, ground_first ? 1 : 0, 0);
}
