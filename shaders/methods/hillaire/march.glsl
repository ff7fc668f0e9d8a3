// The march along a ray through sunlit air.

// A ray in the shell and the sun over it, as cosines: of the zenith angles of ray and sun at its start, and
// of the angle between the two.
struct SunlitRay {
  Real altitude_km;
  Real mu;
  Real mu_sun;
  Real nu;
  Real length_km;
  bool meets_ground;
};

SunlitRay sunlit_ray(Real h, Real mu, bool meets_ground, Real mu_sun, Real nu) {
  SunlitRay ray;
  ray.altitude_km = h;
  ray.mu = mu;
  ray.mu_sun = mu_sun;
  ray.nu = nu;
  ray.meets_ground = meets_ground;
  ray.length_km = meets_ground ? distance_to_ground(h, mu) : distance_to_top(h, mu);
  return ray;
}

// Cosine of the sun's zenith angle at the distance t, where the altitude is h.
Real sun_cosine_after(SunlitRay ray, Real h, Real t) {
  Real along = (scene.planet_radius_km + ray.altitude_km) * ray.mu_sun + t * ray.nu;
  return clamp(along / (scene.planet_radius_km + h), -1.0, 1.0);
}

// The part of a ray that lies in the planet's shadow under parallel light. In the frame whose x axis is the
// sun's horizontal part: where either is vertical, any azimuth is right.
Shadow shadow_over(SunlitRay ray) {
  Real sine = sqrt(max(1.0 - ray.mu * ray.mu, 0.0));
  Real sine_sun = sqrt(max(1.0 - ray.mu_sun * ray.mu_sun, 0.0));
  Real across = sine_sun > 0.0 ? (ray.nu - ray.mu * ray.mu_sun) / sine_sun : sine;
  across = clamp(across, -sine, sine);
  Path path;
  path.start = Vec3(0.0, 0.0, scene.planet_radius_km + ray.altitude_km);
  path.direction = Vec3(across, sqrt(max(sine * sine - across * across, 0.0)), ray.mu);
  path.altitude_km = ray.altitude_km;
  path.mu = ray.mu;
  path.length_km = ray.length_km;
  path.meets_ground = ray.meets_ground;
  Light light;
  light.direction = Vec3(sine_sun, 0.0, ray.mu_sun);
  light.inverse_km = 0.0;
  return shadow_on(path, light, 0.0);
}

// The built-in functions are made from exponentials and lose all digits of small arguments, which short rays
// have.
Vec4 precise_asinh(Vec4 x) {
  Vec4 small = clamp(x, Vec4(-0.2), Vec4(0.2));  // powers of more might not be finite
  Vec4 square = small * small;
  Vec4 series = small * (1.0 - square * (1.0 / 6.0 - square * (3.0 / 40.0 - square * (15.0 / 336.0))));
  return mix(asinh(x), series, step(abs(x), Vec4(0.2)));
}

Vec4 precise_sinh(Vec4 x) {
  Vec4 small = clamp(x, Vec4(-0.5), Vec4(0.5));
  Vec4 square = small * small;
  Vec4 series = small * (1.0 + square * (1.0 / 6.0 + square * (1.0 / 120.0 + square / 5040.0)));
  return mix(sinh(x), series, step(abs(x), Vec4(0.5)));
}

// Nodes along a ray: Gauss-Legendre in u, four a panel, distance = bend sinh(u) from its centre: the lowest
// point, or the start where the air there lets nothing through that lies scale heights away. So nodes are
// even within a scale height or a mean free path of it, and farther apart in proportion to the distance
// beyond: thin layers, thick hazes and long rays have theirs alike. The ray is cut at the edges of the
// shadow. Eight panels are exact to 1e-4 in a haze of optical depth 1.
struct Panels {
  Real centre_km;
  Real bend_km;
  Vec4 edges;    // u of the start, the shadow's two edges, the end
  Vec3 size;     // of a panel in u, before, in and behind the shadow
  int before;    // numbers of panels
  int in_shadow;
  int behind;
};

int share_of(int samples, Real part, Real whole) {
  if (part <= 0.0) return 0;
  return max(1, int(0.25 * Real(samples) * part / whole + 0.5));
}

// bend = 2 min(H / mu, sqrt(2 H r)), mu the zenith cosine at the low end; at most 4 mean free paths at the
// start.
Panels panels_along(SunlitRay ray, Shadow shadow, int samples, Real scale_height_km) {
  Panels panels;
  Real along = (scene.planet_radius_km + ray.altitude_km) * ray.mu;
  panels.centre_km = clamp(-along, 0.0, ray.length_km);
  Real low_h = altitude_after(ray.altitude_km, ray.mu, panels.centre_km);
  Real low_radius = scene.planet_radius_km + low_h;
  Real low_mu = abs(along + panels.centre_km) / low_radius;
  Real bend_km = 2.0 * sqrt(2.0 * scale_height_km * low_radius);
  if (bend_km * low_mu > 2.0 * scale_height_km) bend_km = 2.0 * scale_height_km / low_mu;
  Real opacity = largest_extinction(ray.altitude_km);
  if (bend_km * opacity > 4.0) {
    bend_km = 4.0 / opacity;
    panels.centre_km = 0.0;
  }
  panels.bend_km = bend_km;
  Vec4 distances = Vec4(0.0, shadow.enter_km, shadow.leave_km, ray.length_km) - panels.centre_km;
  panels.edges = precise_asinh(distances / bend_km);
  Vec3 parts = Vec3(panels.edges.y - panels.edges.x, panels.edges.z - panels.edges.y,
                    panels.edges.w - panels.edges.z);
  // What is lit has all of the samples, however short it is: there light changes fastest.
  panels.before = share_of(samples, parts.x, parts.x + parts.z);
  panels.in_shadow = share_of(samples, parts.y, parts.x + 2.0 * parts.y + parts.z);
  panels.behind = share_of(samples, parts.z, parts.x + parts.z);
  panels.size = parts / max(Vec3(Real(panels.before), Real(panels.in_shadow), Real(panels.behind)),
                            Vec3(1.0));
  return panels;
}

int number_of(Panels panels) { return panels.before + panels.in_shadow + panels.behind; }

struct Panel {
  Real first_km;     // distance at which it begins
  Vec4 distance_km;  // of its four nodes
  Vec4 stretch_km;   // kilometres to the panel's share of 1, there
  bool lit;
};

Panel panel_of(Panels panels, int i) {
  Panel panel;
  int into_shadow = i - panels.before;
  int behind = into_shadow - panels.in_shadow;
  Real edge = panels.edges.x + Real(i) * panels.size.x;
  Real size = panels.size.x;
  if (into_shadow >= 0) {
    size = panels.size.y;
    edge = panels.edges.y + Real(into_shadow) * size;
  }
  if (behind >= 0) {
    size = panels.size.z;
    edge = panels.edges.z + Real(behind) * size;
  }
  Vec4 nodes = Vec4(gauss4_node(0), gauss4_node(1), gauss4_node(2), gauss4_node(3));
  Vec4 u = edge + size * nodes;
  panel.first_km = max(panels.centre_km + panels.bend_km * precise_sinh(Vec4(edge)).x, Real(0.0));
  panel.distance_km = max(panels.centre_km + panels.bend_km * precise_sinh(u), Vec4(0.0));
  panel.stretch_km = (panels.bend_km * size) * cosh(u);
  panel.lit = into_shadow < 0 || behind >= 0;
  return panel;
}

Vec4 gauss4_weights() {
  return Vec4(gauss4_weight(0), gauss4_weight(1), gauss4_weight(2), gauss4_weight(3));
}

// The integrals from 0 to each node of the cubic through the values at the four nodes; of values that vary
// by decades between them it may be off, and even below 0.
Vec4 integral_to_nodes(Vec4 values) {
  return Vec4(
      dot(values, Vec4(0.0869637112843634, -0.0266041800849988,
                       0.0126274626894047, -0.0035551496857957)),
      dot(values, Vec4(0.1881181174998680, 0.1630362887156365,
                       -0.0278804286024709, 0.0067355005945382)),
      dot(values, Vec4(0.1671919219741886, 0.3539530060337440,
                       0.1630362887156362, -0.0141906949311412)),
      dot(values, Vec4(0.1774825722545227, 0.3134451147418686,
                       0.3526767575162709, 0.0869637112843633)));
}

// What the integrals are at the least, of a density that goes one way from node to node: where nodes are far
// apart, as in air of which a hair's breadth hides the rest, the cubic may leave a node in the light.
Vec4 least_to_nodes(Panel panel, Vec4 density) {
  Vec4 t = panel.distance_km;
  Vec4 least;
  least.x = (t.x - panel.first_km) * density.x;
  least.y = least.x + (t.y - t.x) * min(density.x, density.y);
  least.z = least.y + (t.z - t.y) * min(density.y, density.z);
  least.w = least.z + (t.w - t.z) * min(density.z, density.w);
  return least;
}

// Goes through a panel: densities of every constituent at its nodes, and its columns from the ray's start
// to them; `column` goes on to the panel's end.
void pass_panel(SunlitRay ray, Panel panel, INOUT_ARRAY(Real, column, MEDIA_SIZE),
                OUT_ARRAY(Vec4, density, MEDIA_SIZE), OUT_ARRAY(Vec4, column_to, MEDIA_SIZE)) {
  UNROLL for (int node = 0; node < 4; ++node) {
    Real h = altitude_after(ray.altitude_km, ray.mu, panel.distance_km[node]);
    UNROLL for (int c = 0; c < MEDIA; ++c) density[c][node] = relative_density(h, c);
  }
  UNROLL for (int c = 0; c < MEDIA; ++c) {
    Vec4 rate_km = density[c] * panel.stretch_km;
    column_to[c] = column[c] + max(integral_to_nodes(rate_km), least_to_nodes(panel, density[c]));
    column[c] += dot(rate_km, gauss4_weights());
  }
}

// One node of a panel.
struct Node {
  Real distance_km;
  Real altitude_km;
  Real width_km;  // the length that it stands for
  Real mu_sun;
};

Node node_of(SunlitRay ray, Panel panel, int i) {
  Node node;
  node.distance_km = panel.distance_km[i];
  node.altitude_km = altitude_after(ray.altitude_km, ray.mu, node.distance_km);
  node.width_km = panel.stretch_km[i] * gauss4_weights()[i];
  node.mu_sun = sun_cosine_after(ray, node.altitude_km, node.distance_km);
  return node;
}

// What the air before a node leaves of its light, times the node's width.
Vec4 seen_width(Node node, ARRAY(Vec4, column_to, MEDIA_SIZE), int i, int group) {
  Vec4 depth = Vec4(0.0);
  UNROLL for (int c = 0; c < MEDIA; ++c) depth = depth + extinction(c, group) * column_to[c][i];
  return exp(-depth) * node.width_km;
}

// What is true of the share of light that a ray loses, as nodes find it: nodes too far apart for the air may
// find more than there is. `lost`: their sum of extinction times seen width.
Vec4 kept_of_found(Vec4 lost, Vec4 transmittance) {
  return min((1.0 - transmittance) / max(lost, Vec4(1e-30)), Vec4(1.0));
}

// From a point that the ground does not hide from the sun.
void transmittance_to_sun(Real h, Real mu_sun, OUT_ARRAY(Vec4, light, GROUPS_SIZE)) {
  OpticalDepthPosition position = optical_depth_position(h, mu_sun);
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    light[group] = exp(-tabulated_optical_depth(position, group));
  }
}
