#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"

// The nodes of all rays, which every sun, azimuth and order share: one invocation a ray.

Vec4 balance[GROUPS];  // first what the nodes take out of a beam, then what brings that to what the ray does

// What counts in the balance: a layer that only absorbs makes no light, and nodes that miss it, as few do a thin
// one, would make some of everything else.
Vec4 balanced_extinction(int c, int g) {
  return min(extinction(c, g), 4.0 * scattering(c, g)) * share_of_extinction(c);
}

Vec4 balanced_depth(ARRAY(Real, column, MEDIA_SIZE), int g) {
  Vec4 depth = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) depth = depth + balanced_extinction(c, g) * column[c];
  return depth;
}

void write_node(int i, int j, int k, TableRay ray, Cuts cuts) {
  Vec2 rule = gauss_node(push.steps, k);
  RayNode node = ray_node(cuts, rule.x, rule.y);
  Real h = altitude_after(ray.altitude_km, ray.mu, node.t_km);
  Real mu = mu_after(ray.altitude_km, ray.mu, node.t_km, h);
  Real column[MEDIA_SIZE];
  Real density[MEDIA_SIZE];
  columns_along(ray.altitude_km, ray.mu, node.t_km, column);
  densities(h, density);
  int at = node_at(i, j, k);
  SunRange range = sun_range(push.grid, h);
  Real fine = node_of_altitude(push.grid, h) / Real(push.grid.altitudes - 1) * Real(push.fine_altitudes - 1);
  WRITE(ray_data, at, Vec4(h, mu, node.t_km, fine));
  WRITE(ray_data, at + 1, Vec4(range.centre, range.low, Real(push.grid.suns - 1) / (range.high - range.low), 0.0));
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 taken = exp(-balanced_depth(column, g)) * node.width_km;
    Vec4 depth = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      balance[g] = balance[g] + balanced_extinction(c, g) * density[c] * taken;
      depth = depth + extinction(c, g) * (share_of_extinction(c) * column[c]);
    }
    Vec4 seen = exp(-depth) * node.width_km;
    ROLLED for (int l = 0; l <= DEGREE; ++l) {
      Vec4 scattered = Vec4(0.0);
      UNROLL for (int c = 0; c < MEDIA; ++c) {
        scattered = scattered + scattering(c, g) * density[c] * scattered_share(c, l, g);
      }
      WRITE(ray_data, at + 2 + l * GROUPS + g, scattered * seen);
    }
  }
}

void main() {
  load_scene();
  load_media();
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  int j = index % RAYS;
  int i = index / RAYS;
  TableRay ray = table_ray(i, j);
  Cuts cuts = cuts_of(ray.altitude_km, ray.mu, ray.length_km);
  UNROLL for (int g = 0; g < GROUPS; ++g) balance[g] = Vec4(0.0);
  for (int k = 0; k < push.steps; ++k) write_node(i, j, k, ray, cuts);

  Real column[MEDIA_SIZE];
  columns_along(ray.altitude_km, ray.mu, ray.length_km, column);
  UNROLL for (int g = 0; g < GROUPS; ++g) balance[g] = balance_of(balance[g], balanced_depth(column, g));
  UNROLL for (int c = 0; c < MEDIA; ++c) column[c] *= share_of_extinction(c);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    WRITE(ray_data, ground_at(i, j) + g, ray.down ? lambertian(g) * transmittance_of(column, g) : Vec4(0.0));
  }
  for (int k = 0; k < push.steps; ++k) {
    int at = node_at(i, j, k) + 2;
    ROLLED for (int l = 0; l <= DEGREE; ++l) {
      UNROLL for (int g = 0; g < GROUPS; ++g) {
        WRITE(ray_data, at + l * GROUPS + g, READ(ray_data, at + l * GROUPS + g) * balance[g]);
      }
    }
  }
}
