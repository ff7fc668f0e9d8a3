// What the kernels that fill the moment tables have in common: constants, buffers, and where things
// lie in them. Groups of wavelengths are innermost everywhere.
#include "device.glsl"

#include "methods/moments_phase.glsl"

layout(constant_id = 12) const int AZIMUTHS = 6;         // of a ray in half a turn
const int LIGHT_SLOTS = SERIES + 1;                      // of a ray's light: they and the aureole's
// Ratios of moments are packed as halves, those of two slots in one texel: a ratio's rounding is a part in 4000 of
// its own term.
const int ROW_SLOTS = (SERIES + 1) / 2 + 1;              // terms of a row in pairs, and the logarithm
const int ORDER_SLOTS = (SLOTS - 1) / 2 + 1;             // the logarithm, then ratios 1, 2, ... in pairs

#include "methods/moments.glsl"

layout(binding = OWN + 1, rgba32f) uniform restrict imageBuffer ray_data;
layout(binding = OWN + 2, rgba32f) uniform restrict imageBuffer light;
layout(binding = OWN + 3, rgba32f) uniform restrict imageBuffer moments;
layout(binding = OWN + 4, rgba32ui) uniform restrict uimageBuffer rows;
layout(binding = OWN + 5, rgba32ui) uniform restrict uimageBuffer fine_order;

layout(push_constant) uniform Push {
  MomentGrid grid;
  int fine_altitudes;  // of the table that rays read
  int up, down;        // directions above and below the horizon
  int steps;           // nodes of a ray
  int first_steps;     // of order one, on each lit part
  int first, end;      // invocations of this dispatch
  int each_azimuth;    // whether order one is traced at each azimuth, or at a few that stand for all
  int first_azimuth, end_azimuth;  // of order one in this dispatch, where it is each
  int first_altitude;              // of the rows there are now
  int chunks;          // of orders, by which all later ones are told; 0 where none are added
} push;

#define RAYS (push.up + push.down)

// Altitude nodes i, rays j, their nodes k: position, where the sun's nodes lie there, then for l = 0 to L
// what a moment contributes; and for the ray what the ground at its end contributes.
const int NODE_SIZE = 2 + (DEGREE + 1) * GROUPS;
int node_at(int i, int j, int k) {
  return ((i * RAYS + j) * push.steps + k) * NODE_SIZE;
}
int ground_at(int i, int j) {
  return push.grid.altitudes * RAYS * push.steps * NODE_SIZE + (i * RAYS + j) * GROUPS;
}

// Light of a ray under the sun s: its azimuthal terms m = 0 to L, then its aureole.
int light_at(int i, int j, int s) {
  return ((i * RAYS + j) * push.grid.suns + s) * LIGHT_SLOTS * GROUPS;
}

// Tables: of one order, the sum of all, the same with more altitudes, and the sums after some earlier orders.
// Behind the moments of each lies the ground's diffuse irradiance.
int table_size(int altitudes) { return (altitudes * SLOTS + 1) * push.grid.suns * GROUPS; }
int sum_table() { return table_size(push.grid.altitudes); }
int earlier_table(int n) {
  return (2 + n) * table_size(push.grid.altitudes) + table_size(push.fine_altitudes);
}
int moment_at(int i, int s, int slot) { return ((i * push.grid.suns + s) * SLOTS + slot) * GROUPS; }
int irradiance_at(int altitudes, int s) { return altitudes * push.grid.suns * SLOTS * GROUPS + s * GROUPS; }

// One order with more altitudes.
int order_at(int fine, int s) { return (fine * push.grid.suns + s) * ORDER_SLOTS * GROUPS; }

// What a node k of a ray sees under the sun s: azimuthal terms of its source over the lowest moment,
// and that moment's logarithm.
int row_at(int i, int j, int k, int s) {
  return ((((i - push.first_altitude) * RAYS + j) * push.steps + k) * push.grid.suns + s) * ROW_SLOTS * GROUPS;
}

struct TableRay {
  Real altitude_km;
  Real mu;
  Real weight;      // d mu
  bool down;
  Real length_km;
};

TableRay table_ray(int i, int j) {
  TableRay ray;
  ray.down = j >= push.up;
  Vec2 rule = ray.down ? gauss_node(push.down, j - push.up) : gauss_node(push.up, j);
  ray.altitude_km = altitude_of_node(push.grid, Real(i));
  ZenithNode node = zenith_node(ray.altitude_km, ray.down, rule.x, rule.y);
  ray.mu = node.mu;
  ray.weight = node.weight;
  ray.length_km = ray.down ? distance_to_ground(ray.altitude_km, ray.mu)
                           : distance_to_top(ray.altitude_km, ray.mu);
  return ray;
}

Real table_azimuth(int a) { return PI * (Real(a) + 0.5) / Real(AZIMUTHS); }

// What halves can't hold is none of their numbers. Where sin^m of the sun's zenith angle is next to nothing, high
// moments are divided by it; what they add there is nothing, but an infinity would spread.
CONSTANT Real MOST_RATIO = 65000.0;

uvec4 pack_pair(Vec4 first, Vec4 second) {
  first = clamp(first, Vec4(-MOST_RATIO), Vec4(MOST_RATIO));
  second = clamp(second, Vec4(-MOST_RATIO), Vec4(MOST_RATIO));
  return uvec4(packHalf2x16(first.xy), packHalf2x16(first.zw), packHalf2x16(second.xy), packHalf2x16(second.zw));
}
Vec4 first_of(uvec4 pair) { return Vec4(unpackHalf2x16(pair.x), unpackHalf2x16(pair.y)); }
Vec4 second_of(uvec4 pair) { return Vec4(unpackHalf2x16(pair.z), unpackHalf2x16(pair.w)); }
