// What the kernels that make the sky of a camera have in common: light that was scattered more than once, by
// elevation, for rays that miss the ground and then for those that meet it, and azimuth.
#include "methods/moments_view.glsl"

const int SENT = SERIES + 1;  // terms in azimuth, and the aureole's
const int SKY_POINTS = 8;     // at most, of an elevation

// From outside the air an elevation may see day and night: then every azimuth is looked at by itself.
layout(constant_id = 12) const bool EACH_AZIMUTH = false;

layout(push_constant) uniform Push {
  MomentGrid grid;
  int fine_altitudes, fine_suns;
  int elevations, azimuths;   // of the sky; the ground has as many
  int steps;
  int first, end;
  int stop;                   // of parts of rays (moments_parts.comp)
} push;

// For each elevation and node its (altitude, zenith cosine, distance, points); then for each point the terms
// of what is sent from there, and what the aureole's function multiplies.
layout(binding = OWN + 2, rgba32f) uniform restrict imageBuffer ray_data;

int place_at(int e, int k) { return e * push.steps + k; }
int sent_at(int e, int k, int point) {
  int places = 2 * push.elevations * push.steps;
  return places + (place_at(e, k) * SKY_POINTS + point) * SENT * GROUPS;
}

// All rays of an elevation, x the cosine of their azimuths from the axis.
struct SkyRay {
  Real altitude_km;   // where it enters the air, or of the camera
  Real mu;
  Real length_km;
  Vec2 axis;          // zenith cosine of the axis there: axis.x + axis.y x
  Vec2 nu;            // and its cosine with the ray
};

SkyRay sky_ray(int e) {
  bool ground = e >= push.elevations;
  Real share = Real(ground ? e - push.elevations : e) / Real(push.elevations - 1);
  Vec3 axis = sun_axis();
  // At the horizon itself and, from outside, at the edge of the air rounding doesn't decide what a ray meets.
  Real most = scene.camera_altitude_km > scene.thickness_km ? 1.0 - 2e-3 : 1.0;
  Path path =
      path_from_camera(direction_of_share(clamp(share, 2e-3, most), ground, 0.0, axis_forward(axis)));
  SkyRay ray;
  ray.altitude_km = path.altitude_km;
  ray.mu = path.mu;
  ray.length_km = ground ? distance_to_ground(path.altitude_km, path.mu)
                         : distance_to_top(path.altitude_km, path.mu);
  Real axis_sine = length(Vec2(axis.x, axis.y));
  Vec3 start = path.start / length(path.start);
  ray.axis = Vec2(start.z * axis.z, length(Vec2(start.x, start.y)) * axis_sine);
  ray.nu = Vec2(path.direction.z * axis.z, length(Vec2(path.direction.x, path.direction.y)) * axis_sine);
  return ray;
}

Real nu_at(SkyRay ray, Real x) { return ray.nu.x + ray.nu.y * x; }

Real axis_at(SkyRay ray, Real x, Real t_km, Real h) {
  return axis_after(ray.altitude_km, ray.axis.x + ray.axis.y * x, nu_at(ray, x), t_km, h);
}

// A node of a sky's ray.
struct SkyNode {
  Real altitude_km;
  Real mu;        // zenith cosine of the ray there
  Real t_km;      // from the ray's start
  Real width_km;
};

SkyNode sky_node(SkyRay ray, int k) {
  Vec2 rule = gauss_node(push.steps, k);
  RayNode node = ray_node(cuts_of(ray.altitude_km, ray.mu, ray.length_km), rule.x, rule.y);
  SkyNode place;
  place.altitude_km = altitude_after(ray.altitude_km, ray.mu, node.t_km);
  place.mu = mu_after(ray.altitude_km, ray.mu, node.t_km, place.altitude_km);
  place.t_km = node.t_km;
  place.width_km = node.width_km;
  return place;
}

AzimuthRecurrence azimuth_at(SkyRay ray, SkyNode node, Real x) {
  return azimuth_recurrence(node.mu, axis_at(ray, x, node.t_km, node.altitude_km), nu_at(ray, x));
}

Vec4 dimmed(ARRAY(Real, column, MEDIA_SIZE), int g) {
  Vec4 depth = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) depth = depth + READ(spectra, (2 + 3 * c) * GROUPS + g) * column[c];
  return exp(-depth);
}

// A value between four nodes of the table.
Vec4 between(int at, int to_sun, int to_altitude, Vec2 x) {
  return mix(mix(READ(moments, at), READ(moments, at + to_sun), x.x),
             mix(READ(moments, at + to_altitude), READ(moments, at + to_altitude + to_sun), x.x), x.y);
}

// What a node scatters of moments by their degree.
Vec4 scattered[SERIES];

// A node at the azimuth whose cosine is x.
struct Sender {
  int at;        // of the moments' table, at the next lower altitude and sun
  Vec2 share;    // of the next higher sun and altitude
  Real mu;
  Vec4 lowest;   // moment, as much of it as the ray's start sees
  Vec4 peaked;   // what it scatters into the aureole
};

int to_sun() { return SLOTS * GROUPS; }
int to_altitude() { return push.fine_suns * to_sun(); }

Sender sender_at(SkyRay ray, SkyNode node, Real x, int g) {
  Real h = node.altitude_km;
  Real column[MEDIA_SIZE];
  Real density[MEDIA_SIZE];
  columns_along(ray.altitude_km, ray.mu, node.t_km, column);
  densities(h, density);
  UNROLL for (int c = 0; c < MEDIA; ++c) column[c] *= share_of_extinction(c);
  Vec4 seen = dimmed(column, g) * node.width_km;

  Real altitude_node = node_of_altitude(push.grid, h) / Real(push.grid.altitudes - 1) *
                       Real(push.fine_altitudes - 1);
  Real sun_node = node_of_sun(push.grid, sun_range(push.grid, h), axis_at(ray, x, node.t_km, h)) /
                  Real(push.grid.suns - 1) * Real(push.fine_suns - 1);
  int i = min(int(altitude_node), push.fine_altitudes - 2);
  int s = min(int(sun_node), push.fine_suns - 2);
  Sender sender;
  sender.at = (i * push.fine_suns + s) * SLOTS * GROUPS + g;
  sender.share = Vec2(sun_node - Real(s), altitude_node - Real(i));
  sender.mu = node.mu;
  sender.lowest = exp(between(sender.at, to_sun(), to_altitude(), sender.share)) * seen;

  Vec4 coefficient[MEDIA_SIZE];
  sender.peaked = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    coefficient[c] = READ(spectra, (3 + 3 * c) * GROUPS + g) * density[c];
    if (medium(c).phase > PHASE_RAYLEIGH) sender.peaked = sender.peaked + coefficient[c];
  }
  ROLLED for (int l = 0; l <= DEGREE; ++l) {
    Vec4 of_all = Vec4(0.0);
    UNROLL for (int c = 0; c < MEDIA; ++c) of_all = of_all + coefficient[c] * scattered_share(c, l, g);
    scattered[l] = of_all;
  }
  return sender;
}

// A term of its series in azimuth. Rayleigh's function scatters moments of the degrees 0 and 2.
Vec4 term_of(Sender sender, int m) {
  Vec4 term = Vec4(0.0);
  Real before = 0.0;
  Real p = 1.0;
  ROLLED for (int l = m; l <= (PARTICLES ? DEGREE : min(DEGREE, 2)); ++l) {
    int n = moment_index(l, m);
    Vec4 ratio = between(sender.at + n * GROUPS, to_sun(), to_altitude(), sender.share);
    term = term + scattered[l] * (n > 0 ? ratio : Vec4(1.0)) * p;
    Real next = next_zenith_polynomial(sender.mu, l, m, p, before);
    before = p;
    p = next;
  }
  return term * sender.lowest;
}

// What the aureole's function multiplies.
Vec4 aureole_of(Sender sender) {
  if (!PARTICLES) return Vec4(0.0);
  Vec4 ratio = between(sender.at + AUREOLE * GROUPS, to_sun(), to_altitude(), sender.share);
  return sender.peaked * ratio * sender.lowest;
}

// What it sends but for that.
Vec4 smooth_light_of(Sender sender, AzimuthRecurrence azimuth) {
  Vec4 light = Vec4(0.0);
  Real before = 0.0;
  Real c = 1.0;
  ROLLED for (int m = 0; m <= DEGREE; ++m) {
    light = light + term_of(sender, m) * c;
    Real next = next_azimuth_term(azimuth, m, c, before);
    before = c;
    c = next;
  }
  return light;
}

// Points where so many spacings of the sun's nodes lie between the azimuths 0 and pi: more than the tables
// take, which only have to be right in the mean over azimuths.
int sky_points(Real spacings) { return clamp(1 + int(ceil(4.0 * spacings - 0.1)), 1, SKY_POINTS); }
