// Light of two events and more by random walks from the camera, with the sun looked at from every
// vertex [e.g. Novak et al. 2018, Monte Carlo methods for volumetric light transport]. Whatever the
// proposals below are, each term is divided by the density that it was drawn with: they decide how
// noisy the result is, never what it is. All wavelengths of a batch share a walk.
#include "path/random.glsl"
#include "path/guide.glsl"
#include "path/walk.glsl"
#include "path/leg.glsl"
#include "path/deflection.glsl"
#include "path/direction.glsl"
#include "path/distance.glsl"

// The share of the light that leaves a vertex of those that a direction brings, for every wavelength:
// 1/(km sr) in air, 1/sr and with the cosine at the ground.
void scattered_share(Scatterer scatterer, Vec3 direction, ARRAY(Real, density, MEDIA_SIZE),
                     ARRAY(Real, matter, MATTERS), OUT_ARRAY(Vec4, scattered, GROUPS_SIZE)) {
  Vec4 phase[MEDIA_GROUPS_SIZE];
  scattering_towards(scattering_angle(direction, scatterer.incoming), phase);
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    scattered[group] = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      scattered[group] = scattered[group] + phase[c * GROUPS_SIZE + group] * density[c];
    }
    if (!scatterer.ground) continue;
    if (SURFACE_KIND != SURFACE_UNIFORM) {
      scattered[group] = direction.z > 0.0 ? reflected_beam(scatterer.place, matter, direction,
                                                            -scatterer.incoming, group)
                                           : Vec4(0.0);
    } else {
      scattered[group] = lambertian(group) * max(direction.z, 0.0);
    }
  }
}

// What a walk has come to where the ground is not the same everywhere. What the camera itself sees is looked at
// as finely as a pixel shows it, and has its slope; what lights that, in less detail and as
// level ground at the height of the sea.
CONSTANT Real COARSE_LOOK = 0.002;  // of the planet's radius

GroundPlace ground_at(Walk walk, Real width_km, OUT_ARRAY(Real, matter, MATTERS)) {
  Vec3 n = place_of(walk);
  look_at_ground(n, width_km, matter);
  GroundPlace place;
  place.up = Vec3(0.0, 0.0, 1.0);
  place.normal = place.up;
  if (walk.vertices == 1 && surface_relief_km() > 0.0) {
    // Into the walk's frame, whose axes the foot point's are known in.
    Vec3 normal = surface_normal(n * scene.planet_radius_km, width_km);
    place.normal = normalize(walk.foot_east * normal.x +
                             cross(walk.foot_up, walk.foot_east) * normal.y +
                             walk.foot_up * normal.z);
  }
  return place;
}

// Goes on to the next vertex; throughput is then that of the light which gets to it. False where
// the walk has left the shell, or nothing lies before the end of its ray.
bool fly(INOUT(Walk) walk, Real end_km, bool height_ends, Vec4 u, INOUT_ARRAY(Vec4, throughput, GROUPS_SIZE), INOUT(Flight) flight) {
  Leg leg = leg_from(walk.altitude_km, walk.direction.z, end_km);
  if (height_ends) leg.meets_ground = true;
  flight = choose_flight(walk, leg, throughput, u);
  if (height_ends && flight.ground) {
    flight.altitude_km = altitude_after(walk.altitude_km, walk.direction.z, flight.distance_km);
  }
  if (flight.ends || !(flight.density > 0.0)) return false;
  Real column[MEDIA_SIZE];
  columns_along(walk.altitude_km, walk.direction.z, flight.distance_km, column);
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    throughput[group] = throughput[group] * transmittance_of(column, group) / flight.density;
  }
  Turn turn = turn_along(walk.altitude_km, walk.direction, flight.distance_km, flight.altitude_km);
  if (NEAR_SUN) walk.sun = walk.sun - walk.direction * flight.distance_km;
  walk.sun = turned(turn, walk.sun);
  walk.direction = turned(turn, walk.direction);
  if (SURFACE_KIND != SURFACE_UNIFORM) {
    walk.foot_east = turned(turn, walk.foot_east);
    walk.foot_up = turned(turn, walk.foot_up);
  }
  walk.altitude_km = flight.altitude_km;
  walk.vertices += 1;
  return true;
}

Real strongest(ARRAY(Vec4, throughput, GROUPS_SIZE)) {
  Real result = 0.0;
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    Vec4 v = throughput[group];
    result = max(result, max(max(v.x, v.y), max(v.z, v.w)));
  }
  return result;
}

// How far a walk may go: its first ray as far as the frame's.
Real end_of_flight(Path path, Walk walk) {
  return path.cut && walk.vertices == 0 ? path.length_km : ENDLESS;
}

// One vertex more: flies there, at most as far as `end_km`, adds what it scatters of the sun's light to `radiance` (from the second
// vertex on), and turns. False where the walk is over.
// `width_km`: what a pixel is wide where its ray ends on the ground; 0 where something else ends it.
bool step_walk(INOUT(Walk) walk, Stream stream, int orders, Real end_km, Real width_km,
               INOUT_ARRAY(Vec4, throughput, GROUPS_SIZE), INOUT_ARRAY(Vec4, radiance, GROUPS_SIZE),
               INOUT(bool) ground_first) {
  Vec4 u = uniform_numbers(stream, 2 * walk.vertices);
  Vec4 v = uniform_numbers(stream, 2 * walk.vertices + 1);
  Flight flight;
  bool height_ends = SURFACE_KIND != SURFACE_UNIFORM && end_km < ENDLESS && width_km > 0.0;
  if (!fly(walk, end_km, height_ends, u, throughput, flight)) return false;
  if (walk.vertices == 1) ground_first = flight.ground;

  Scatterer scatterer;
  scatterer.ground = flight.ground;
  scatterer.incoming = walk.direction;
  Real matter[MATTERS];
  if (SURFACE_KIND != SURFACE_UNIFORM) {
    scatterer.place =
        ground_at(walk, walk.vertices == 1 ? width_km : COARSE_LOOK * scene.planet_radius_km, matter);
  }
  Real density[MEDIA_SIZE];
  densities(walk.altitude_km, density);
  Vec4 scattered[GROUPS_SIZE];
  SunRay sun = sun_from(walk);
  bool lit = !meets_ground(walk.altitude_km, sun.direction.z) &&
             !(flight.ground && sun.direction.z <= 0.0);
  Real carried = 0.0;
  Real sunlit = 0.0;
  if (lit) {
    Real column[MEDIA_SIZE];
    columns_to_top(walk.altitude_km, sun.direction.z, column);
    scattered_share(scatterer, sun.direction, density, matter, scattered);
    UNROLL for (int group = 0; group < GROUPS; ++group) {
      Vec4 light = throughput[group] * transmittance_of(column, group);
      carried += total(throughput[group]);
      sunlit += total(light);
      if (walk.vertices > 1) {
        radiance[group] = radiance[group] + light * scattered[group] * sun.irradiance;
      }
    }
  }
  if (walk.vertices == orders) return false;

  Real share[MEDIA_SIZE];
  Real sum = 0.0;
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    share[c] = 0.0;
    UNROLL for (int group = 0; group < GROUPS; ++group) {
      share[c] += density[c] * total(throughput[group] * scattering(c, group));
    }
    sum += share[c];
  }
  if (!flight.ground && !(sum > 0.0)) return false;
  UNROLL for (int c = 0; c < MEDIA; ++c) share[c] = share[c] / sum;

  Aim aim = aim_at(sun.direction, walk.altitude_km, carried > 0.0 ? min(sunlit / carried, 1.0) : 0.0,
                   scatterer.ground ? 1.0 : scattered_widely(share));
  walk.direction = choose_direction(scatterer, aim, sun.direction, share, Vec4(v.x, v.y, v.z, u.w));
  scattered_share(scatterer, walk.direction, density, matter, scattered);
  Real proposed = direction_density(scatterer, aim, sun.direction, share, walk.direction);
  if (!(proposed > 0.0)) return false;
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    throughput[group] = throughput[group] * scattered[group] / proposed;
  }

  // Roulette, on what the walk may find: towards the sun a forward peak lies ahead.
  Real strength = strongest(throughput);
  if (GUIDED) strength *= sky_light(aim.place) * (0.1 + from_sky_density(aim, walk.direction));
  if (aim.sun > 0.0) strength *= 1.0 + 4.0 * PI * peak_density(sun.direction, walk.direction);
  if (!(strength > 0.0)) return false;
  if (walk.vertices == 1) {
    walk.strength = strength;
    return true;
  }
  Real survives = min(strength / walk.strength, 1.0);
  if (v.w >= survives) return false;
  UNROLL for (int group = 0; group < GROUPS; ++group) throughput[group] = throughput[group] / survives;
  return true;
}
