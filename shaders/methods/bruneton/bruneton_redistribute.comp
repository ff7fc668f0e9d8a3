#version 450
#extension GL_GOOGLE_include_directive : require
// How much of the radiance along each direction of the grid goes on along each of the source table's, at
// one altitude: phase function times solid angle, of all constituents in the proportion in which they
// scatter there. Both azimuths of an incoming direction, left and right of the sun, are one node. An
// invocation is a pair of directions.
#include "device.glsl"
#include "methods/bruneton/tables.glsl"
layout(std430, binding = FREE) restrict writeonly buffer ShareBuffer {
  Vec4 shares[];
};

layout(push_constant) uniform Push {
  int first_pair;
  int end_pair;
  int altitude;
  int out_zeniths;  // directions of the source, as computed
  int out_azimuths;
} push;

// Scattering coefficient times phase function, 1/(km sr); in the end over their sum without phase.
void add_phases(Vec3 from, Vec3 to, ARRAY(Real, density, MEDIA_SIZE),
                INOUT_ARRAY(Vec4, sum, GROUPS_SIZE)) {
  Vec4 phases[MEDIA_GROUPS_SIZE];
  scattering_towards(scattering_angle(from, to), phases);
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      sum[g] = sum[g] + phases[c * GROUPS + g] * density[c];
    }
  }
}

bool any_scatters(ARRAY(Real, density, MEDIA_SIZE)) {
  Real sum = 0.0;
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      Vec4 coefficient = scattering(c, g) * density[c];
      sum += coefficient.x + coefficient.y + coefficient.z + coefficient.w;
    }
  }
  return sum > 0.0;
}

// Densities in the proportions that constituents have at an altitude. A node where nothing scatters, at the top of
// air that ends there or in a gap, is still a neighbour of places where something does: it has the proportions
// a little below it, or else all there is.
void scatterers_at(Real h, OUT_ARRAY(Real, density, MEDIA_SIZE)) {
  densities(h, density);
  if (any_scatters(density)) return;
  densities(h * 0.999, density);
  if (any_scatters(density)) return;
  UNROLL for (int c = 0; c < MEDIA; ++c) density[c] = 1.0;
}

void main() {
  load_scene();
  load_media();
  load_grids();
  int pair = push.first_pair + int(gl_GlobalInvocationID.x);
  if (pair >= push.end_pair) return;
  int outgoing = pair % (push.out_zeniths * push.out_azimuths);
  int incoming = pair / (push.out_zeniths * push.out_azimuths);
  Real out_zenith = PI * Real(outgoing / push.out_azimuths) / Real(push.out_zeniths - 1);
  Real out_azimuth = PI * Real(outgoing % push.out_azimuths) / Real(push.out_azimuths - 1);
  int zenith = incoming / grid.azimuths;
  int k = incoming % grid.azimuths;
  Real mu = node_cosine(push.altitude, zenith);
  Real in_azimuth = node_azimuth(k);
  Real solid_angle = node_solid_angle(push.altitude, zenith, k);
  Vec3 to = direction_of(cos(out_zenith), out_azimuth);

  Real density[MEDIA_SIZE];
  scatterers_at(node_altitude(push.altitude), density);
  Vec4 sum[GROUPS];
  UNROLL for (int g = 0; g < GROUPS; ++g) sum[g] = Vec4(0.0);
  add_phases(direction_of(mu, in_azimuth), to, density, sum);
  add_phases(direction_of(mu, -in_azimuth), to, density, sum);
  int pairs = grid.zeniths * grid.azimuths * push.out_zeniths * push.out_azimuths;
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 coefficient = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      coefficient = coefficient + scattering(c, g) * density[c];
    }
    shares[g * pairs + pair] = 0.5 * solid_angle * sum[g] / max(coefficient, Vec4(1e-30));
  }
}
