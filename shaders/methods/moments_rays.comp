#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_device.glsl"

// The nodes of all rays, which every sun, azimuth and order share. One invocation a node; the one after
// a ray's last node is its end.
void main() {
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  load_scene();
  load_media();
  int k = index % (push.steps + 1);
  int j = index / (push.steps + 1) % RAYS;
  int i = index / (push.steps + 1) / RAYS;
  TableRay ray = table_ray(i, j);
  Cuts cuts = cuts_of(ray.altitude_km, ray.mu, ray.length_km);
  RayNode node;
  node.t_km = ray.length_km;
  node.width_km = 0.0;
  if (k < push.steps) {
    Vec2 rule = gauss_node(push.steps, k);
    node = ray_node(cuts, rule.x, rule.y);
  }
  Real h = altitude_after(ray.altitude_km, ray.mu, node.t_km);
  Real mu = mu_after(ray.altitude_km, ray.mu, node.t_km, h);
  Real column[MEDIA_SIZE];
  Real density[MEDIA_SIZE];
  columns_along(ray.altitude_km, ray.mu, node.t_km, column);
  densities(h, density);
  UNROLL for (int c = 0; c < MEDIA; ++c) column[c] *= share_of_extinction(c);

  if (k == push.steps) {
    UNROLL for (int g = 0; g < GROUPS; ++g) {
      ray_data[ground_at(i, j) + g] = ray.down ? lambertian(g) * transmittance_of(column, g) : Vec4(0.0);
    }
    return;
  }
  int at = node_at(i, j, k);
  SunRange range = sun_range(push.grid, h);
  Real fine = node_of_altitude(push.grid, h) / Real(push.grid.altitudes - 1) * Real(push.fine_altitudes - 1);
  ray_data[at] = Vec4(h, mu, node.t_km, fine);
  ray_data[at + 1] = Vec4(range.centre, range.low, Real(push.grid.suns - 1) / (range.high - range.low), 0.0);
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    Vec4 seen = transmittance_of(column, g) * node.width_km;
    UNROLL for (int l = 0; l <= DEGREE; ++l) {
      Vec4 scattered = Vec4(0.0);
      UNROLL for (int c = 0; c < MEDIA; ++c) {
        scattered = scattered + scattering(c, g) * density[c] * scattered_share(c, l, g);
      }
      ray_data[at + 2 + l * GROUPS + g] = scattered * seen;
    }
  }
}
