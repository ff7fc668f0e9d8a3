// A surface from images: equirectangular, longitude 0 in the middle, north at the top, each with all its halvings
// behind it, so that what is looked at is no finer than a footprint. A texel of heights is a float's bits; of
// albedo, the square roots of red, green and blue in 10 bits each.

// As surface_values has it.
struct MapImage {
  int width;
  int height;
  int levels;  // 0: there is none
  int first;   // texel
};

MapImage map_image(int value) {
  Vec4 v = READ(surface_values, value);
  MapImage image;
  image.width = int(v.x);
  image.height = int(v.y);
  image.levels = int(v.z);
  image.first = int(v.w);
  return image;
}

Vec4 map_value(bool colour, int texel) {
  Uint bits = surface_texel(texel);
  if (!colour) return Vec4(Real(uintBitsToFloat(bits)));
  Vec4 root = Vec4(Real(bits & 1023u), Real((bits >> 10) & 1023u), Real((bits >> 20) & 1023u), 0.0) /
              Real(1023.0);
  return root * root;
}

// Bilinear, at a place in [0, 1)^2 of a level.
Vec4 map_at_level(MapImage image, int level, Vec2 place, bool colour) {
  int width = image.width;
  int height = image.height;
  int first = image.first;
  for (int i = 0; i < level; ++i) {
    first += width * height;
    width = max(width / 2, 1);
    height = max(height / 2, 1);
  }
  Real x = place.x * Real(width) - 0.5;
  Real y = clamp(place.y * Real(height) - 0.5, 0.0, Real(height - 1));
  int left = int(floor(x));
  int top = min(int(y), max(height - 2, 0));
  Real right_share = x - Real(left);
  Real bottom_share = clamp(y - Real(top), 0.0, 1.0);
  int right = (left + 1) % width;
  left = (left + width) % width;
  int bottom = min(top + 1, height - 1);
  return mix(mix(map_value(colour, first + top * width + left),
                 map_value(colour, first + top * width + right), right_share),
             mix(map_value(colour, first + bottom * width + left),
                 map_value(colour, first + bottom * width + right), right_share), bottom_share);
}

// Between the two levels whose texels are next to a footprint.
Vec4 map_at(MapImage image, Vec3 n, Real footprint_km, bool colour) {
  Real longitude = atan(n.y, n.x);
  Real latitude = atan(n.z, length(Vec2(n.x, n.y)));
  Vec2 place = Vec2(0.5 + longitude / (2.0 * PI), 0.5 - latitude / PI);
  Real texel_km = 2.0 * PI * scene.planet_radius_km / Real(image.width) *
                  sqrt(max(sqrt(max(1.0 - n.z * n.z, 0.0)), 0.01));
  Real level = clamp(log2(max(footprint_km / texel_km, 1.0)), 0.0, Real(image.levels - 1));
  int finer = min(int(level), max(image.levels - 2, 0));
  return mix(map_at_level(image, finer, place, colour),
             map_at_level(image, min(finer + 1, image.levels - 1), place, colour),
             clamp(level - Real(finer), 0.0, 1.0));
}

// Heights as a share of the relief.
Real map_height(Vec3 n, Real footprint_km) {
  MapImage image = map_image(SURFACE_HEIGHTS);
  return image.levels > 0 ? clamp(map_at(image, n, footprint_km, false).x, 0.0, 1.0) : 0.0;
}

void map_matter(Vec3 n, Real footprint_km, OUT_ARRAY(Real, share, MATTERS)) {
  Vec4 rgb = map_at(map_image(SURFACE_COLOURS), n, footprint_km, true);
  UNROLL for (int m = 0; m < MATTERS; ++m) share[m] = 0.0;
  share[RED] = rgb.x;
  share[GREEN] = rgb.y;
  share[BLUE] = rgb.z;
}
