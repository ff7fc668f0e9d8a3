// A walk carries its altitude and a frame that turns with the local vertical (z up), so that no position
// is ever the difference of two planetary radii.

struct Walk {
  Real altitude_km;
  Vec3 direction;   // unit, away from the camera
  Vec3 sun;         // to the sun: unit for parallel light, in km for a near one
  Real strength;    // throughput behind the first vertex, which roulette compares with
  int vertices;     // so far
  // Two axes of the frame at the camera's foot point, as the walk's frame has them: where it is. Idle on ground
  // that is the same everywhere.
  Vec3 foot_east;
  Vec3 foot_up;
};

struct Turn {
  Vec2 towards;  // horizontal, unit
  Real cosine;   // of the angle at the planet's centre
  Real sine;
};

Turn turn_along(Real h, Vec3 direction, Real distance_km, Real new_h) {
  Turn turn;
  Vec2 horizontal = Vec2(direction.x, direction.y);
  Real sine = length(horizontal);
  turn.towards = sine > 0.0 ? horizontal / sine : Vec2(1.0, 0.0);
  Real new_radius = scene.planet_radius_km + new_h;
  turn.sine = distance_km * sine / new_radius;
  turn.cosine = (scene.planet_radius_km + h + distance_km * direction.z) / new_radius;
  return turn;
}

Vec3 turned(Turn turn, Vec3 v) {
  Real along = v.x * turn.towards.x + v.y * turn.towards.y;
  Real shift = along * turn.cosine - v.z * turn.sine - along;
  return Vec3(v.x + turn.towards.x * shift, v.y + turn.towards.y * shift,
              along * turn.sine + v.z * turn.cosine);
}

// `v` as seen in a frame whose z axis is `axis` [Duff et al. 2017, JCGT 6(1)].
Vec3 about_axis(Vec3 axis, Vec3 v) {
  Real side = axis.z < 0.0 ? -1.0 : 1.0;
  Real a = -1.0 / (side + axis.z);
  Real b = axis.x * axis.y * a;
  Vec3 across = Vec3(1.0 + side * axis.x * axis.x * a, side * b, -side * axis.x);
  Vec3 other = Vec3(b, side + axis.y * axis.y * a, -axis.y);
  return normalize(across * v.x + other * v.y + axis * v.z);
}

// Unit vector at the angle with 1 - cos = deflection from the z axis.
Vec3 deflected(Real deflection, Real turn) {
  Real sine = sqrt(max(deflection * (2.0 - deflection), 0.0));
  return Vec3(sine * cos(2.0 * PI * turn), sine * sin(2.0 * PI * turn), 1.0 - deflection);
}

SunRay sun_from(Walk walk) {
  SunRay ray;
  ray.direction = walk.sun;
  ray.irradiance = 1.0;
  ray.distance_km = 0.0;
  if (NEAR_SUN) {
    ray.distance_km = length(walk.sun);
    ray.direction = walk.sun / ray.distance_km;
    Real ratio = scene.sun_distance_km / ray.distance_km;
    ray.irradiance = ratio * ratio;
  }
  return ray;
}

// Of the walk, from the planet's centre, in the frame of the camera's foot point.
Vec3 place_of(Walk walk) {
  Vec3 foot_north = cross(walk.foot_up, walk.foot_east);
  return normalize(Vec3(walk.foot_east.z, foot_north.z, walk.foot_up.z));
}

// At the start of a path, under one point of the sun.
Walk walk_from(Path path, Vec3 sun_point) {
  Walk walk;
  walk.altitude_km = path.altitude_km;
  walk.strength = 0.0;
  walk.vertices = 0;
  // From the frame at the camera's foot to that at the start.
  Turn turn;
  Vec2 horizontal = Vec2(path.start.x, path.start.y);
  Real offset = length(horizontal);
  turn.towards = offset > 0.0 ? horizontal / offset : Vec2(1.0, 0.0);
  turn.sine = offset / length(path.start);
  turn.cosine = path.start.z / length(path.start);
  Vec3 direction = turned(turn, path.direction);
  Real level = length(Vec2(direction.x, direction.y));
  // The zenith cosine as the path knows it: rays to the limb need all of its digits.
  Real scale = level > 0.0 ? sqrt(max((1.0 - path.mu) * (1.0 + path.mu), 0.0)) / level : 0.0;
  walk.direction = Vec3(direction.x * scale, direction.y * scale, path.mu);
  SunRay sun = sun_ray(path.start, sun_point);
  walk.foot_east = turned(turn, Vec3(1.0, 0.0, 0.0));
  walk.foot_up = turned(turn, Vec3(0.0, 0.0, 1.0));
  walk.sun = turned(turn, NEAR_SUN ? sun.direction * sun.distance_km : sun.direction);
  return walk;
}

// The walk `stream.path` of a ray, and what it carries at first: the light of one point of the disc
// stands for all of them.
Walk start_walk(Path path, Stream stream, OUT_ARRAY(Vec4, throughput, GROUPS_SIZE)) {
  int point = 0;
  if (MANY_SUNS) {
    Real u = uniform_numbers(stream, -1).x;
    point = min(int(u * Real(scene.disc_points)), scene.disc_points - 1);
  }
  UNROLL for (int group = 0; group < GROUPS; ++group) {
    throughput[group] = MANY_SUNS ? sun_weight(point, group) * Real(scene.disc_points) : Vec4(1.0);
  }
  return walk_from(path, MANY_SUNS ? sun_offset(point) : Vec3(0.0));
}
