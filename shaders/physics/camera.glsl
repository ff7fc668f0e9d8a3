// The ray through the centre of a pixel; pixels are numbered row by row from the top left.

struct PixelRay {
  Vec3 direction;
  bool inside;      // false outside a fisheye's circle
};

Vec3 in_camera_frame(Real right, Real up, Real forward) {
  return Vec3(scene.camera_right.x, scene.camera_right.y, scene.camera_right.z) * right +
         Vec3(scene.camera_up.x, scene.camera_up.y, scene.camera_up.z) * up +
         Vec3(scene.camera_forward.x, scene.camera_forward.y, scene.camera_forward.z) * forward;
}

// Faces +X -X +Y -Y +Z -Z, each with the orientation that OpenGL gives its texels [OpenGL 4.6,
// table 8.19]: +X right, +Y up, -Z forward.
Vec3 cubemap_direction(int face, Real s, Real t) {
  if (face == 0) return in_camera_frame(1.0, -t, s);
  if (face == 1) return in_camera_frame(-1.0, -t, -s);
  if (face == 2) return in_camera_frame(s, 1.0, -t);
  if (face == 3) return in_camera_frame(s, -1.0, t);
  if (face == 4) return in_camera_frame(s, -t, -1.0);
  return in_camera_frame(-s, -t, 1.0);
}

PixelRay pixel_ray(int pixel) {
  PixelRay ray;
  ray.inside = true;
  if (PROJECTION == PROJECTION_LIST) {
    Vec4 direction = READ(directions, pixel);
    ray.direction = Vec3(direction.x, direction.y, direction.z);
    return ray;
  }
  int column = pixel % scene.width;
  int row = pixel / scene.width;
  Real width = Real(scene.width);
  Real height = Real(scene.height);
  // Offsets from the centre in half pixels, exact in float for any image.
  Real x = Real(2 * column + 1 - scene.width);
  Real y = Real(scene.height - 1 - 2 * row);
  if (PROJECTION == PROJECTION_PERSPECTIVE) {
    Real scale = scene.tan_half_fov / height;
    ray.direction = normalize(in_camera_frame(x * scale, y * scale, 1.0));
  }
  if (PROJECTION == PROJECTION_FISHEYE) {
    Real radius = length(Vec2(x, y));
    Real circle = min(width, height);
    Real theta = radius / circle * scene.half_fov_rad;
    Real sine = sin(theta) / max(radius, 1e-9);
    ray.direction = normalize(in_camera_frame(x * sine, y * sine, cos(theta)));
    ray.inside = radius <= circle;
  }
  if (PROJECTION == PROJECTION_EQUIRECTANGULAR) {
    Real azimuth = x / width * PI;
    Real elevation = y / height * (0.5 * PI);
    ray.direction = normalize(in_camera_frame(
        sin(azimuth) * cos(elevation), sin(elevation), cos(azimuth) * cos(elevation)));
  }
  if (PROJECTION == PROJECTION_CUBEMAP) {
    int face_row = row % scene.width;
    Real t = Real(2 * face_row + 1 - scene.width) / width;
    ray.direction = normalize(cubemap_direction(row / scene.width, x / width, t));
  }
  return ray;
}

// The angle that a pixel spans, radians, near the middle of the image.
Real pixel_angle() {
  if (PROJECTION == PROJECTION_PERSPECTIVE) {
    return 2.0 * scene.tan_half_fov / Real(scene.height);
  }
  if (PROJECTION == PROJECTION_FISHEYE) {
    return 2.0 * scene.half_fov_rad / Real(min(scene.width, scene.height));
  }
  if (PROJECTION == PROJECTION_EQUIRECTANGULAR) return PI / Real(scene.height);
  return 0.5 * PI / Real(scene.width);
}

// A ray that nothing stands in the way of ends here or farther, km.
CONSTANT Real ENDLESS = Real(1e30);

// Whether a path ends on the ground, also where that has heights, which end a ray like an object.
bool ends_on_ground(Path path) { return path.meets_ground || (path.cut && scene.surface != 0); }

// Where a ray of the frame ends, km from the camera.
Real end_of_ray(int ray) { return READ_REAL(ends_km, min(ray, scene.ends - 1)); }

// The part of a ray of the frame that lies in the air before its end; none outside a fisheye's circle. What
// stands at the end hides the ground.
Path path_of_ray(int ray, PixelRay pixel) {
  Path path = path_from_camera(pixel.direction);
  Vec3 camera = Vec3(0.0, 0.0, scene.planet_radius_km + scene.camera_altitude_km);
  Real end_km = end_of_ray(ray);
  path.cut = end_km < ENDLESS;
  path.length_km = min(path.length_km, max(end_km - length(path.start - camera), 0.0));
  if (!pixel.inside) path.length_km = 0.0;
  if (path.cut || !pixel.inside) path.meets_ground = false;
  return path;
}
