#version 450
#extension GL_GOOGLE_include_directive : require
#include "methods/moments_sky.glsl"

// What the nodes of the sky's rays send to the camera, as a series in azimuth, at the few azimuths that
// stand for all: one invocation a point, a node, an elevation and a group.

void main() {
  load_scene();
  load_media();
  int index = push.first + int(gl_GlobalInvocationID.x);
  if (index >= push.end) return;
  int g = index % GROUPS;
  int k = index / GROUPS % push.steps;
  int e = index / GROUPS / push.steps % (2 * push.elevations);
  int point = index / GROUPS / push.steps / (2 * push.elevations);
  SkyRay ray = sky_ray(e);
  SkyNode node = sky_node(ray, k);
  SunRange range = sun_range(push.grid, node.altitude_km);
  Real first = node_of_sun(push.grid, range, axis_at(ray, 1.0, node.t_km, node.altitude_km));
  Real last = node_of_sun(push.grid, range, axis_at(ray, -1.0, node.t_km, node.altitude_km));
  int points = sky_points(abs(last - first));
  if (point == 0 && g == 0) WRITE(ray_data, place_at(e, k), Vec4(node.altitude_km, node.mu, node.t_km, Real(points)));
  if (point >= points) return;
  Sender sender = sender_at(ray, node, azimuth_point(point, points), g);
  int own = sent_at(e, k, point) + g;
  ROLLED for (int m = 0; m <= DEGREE; ++m) WRITE(ray_data, own + m * GROUPS, term_of(sender, m));
  WRITE(ray_data, own + SERIES * GROUPS, aureole_of(sender));
}
