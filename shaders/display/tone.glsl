// From linear Rec. 709 to what a display shows. 1.0 in is a white card facing the sun at exposure 0.

CONSTANT int TONE_LINEAR = 0;
CONSTANT int TONE_REINHARD = 1;
CONSTANT int TONE_EXPONENTIAL = 2;
CONSTANT int TONE_ACES = 3;
CONSTANT int TONE_AGX = 4;

// Rec. 709 luminance.
Real luminance(Vec3 rgb) { return dot(rgb, Vec3(0.2126, 0.7152, 0.0722)); }

// A colour outside the gamut moves towards grey of the same luminance until nothing is negative.
Vec3 into_gamut(Vec3 rgb) {
  Real y = luminance(rgb);
  Real least = min(rgb.x, min(rgb.y, rgb.z));
  if (y <= 0.0) return Vec3(0.0);
  if (least >= 0.0) return rgb;
  return max(Vec3(y) + (rgb - Vec3(y)) * (y / (y - least)), Vec3(0.0));
}

// Rows times a vector, so that a matrix reads as it is printed.
Vec3 by_rows(Vec3 row0, Vec3 row1, Vec3 row2, Vec3 v) {
  return Vec3(dot(row0, v), dot(row1, v), dot(row2, v));
}

// Stephen Hill's fit of the ACES reference rendering and sRGB output transforms.
Vec3 aces(Vec3 rgb) {
  rgb = min(rgb, Vec3(1e6));  // where it has long been white, and squares are far from a float's end
  Vec3 v = by_rows(Vec3(0.59719, 0.35458, 0.04823), Vec3(0.07600, 0.90834, 0.01566),
                   Vec3(0.02840, 0.13383, 0.83777), rgb);
  Vec3 a = v * (v + 0.0245786) - 0.000090537;
  Vec3 b = v * (0.983729 * v + 0.4329510) + 0.238081;
  return by_rows(Vec3(1.60475, -0.53108, -0.07367), Vec3(-0.10208, 1.10813, -0.00605),
                 Vec3(-0.00327, -0.07276, 1.07602), a / b);
}

// The range of AgX's curve.
CONSTANT Real AGX_LEAST_EV = -12.47393;
CONSTANT Real AGX_MOST_EV = 4.026069;

// What AgX's curve is laid over: colours nearer to grey.
Vec3 agx_inset(Vec3 rgb) {
  return by_rows(Vec3(0.842479062253094, 0.0784335999999992, 0.0792237451477643),
                 Vec3(0.0423282422610123, 0.878468636469772, 0.0791661274605434),
                 Vec3(0.0423756549057051, 0.0784336, 0.879142973793104), rgb);
}

// AgX (Troy Sobotka) with its "punchy" look, the base curve as a polynomial in the logarithm (Benjamin
// Wrensch's fit): the base look alone leaves a blue sky grey. The curve's output is encoded with an
// exponent of 2.2; linear light is returned.
Vec3 agx(Vec3 rgb) {
  Vec3 ev = log2(max(agx_inset(rgb), Vec3(1e-10)));
  Vec3 x = clamp((ev - AGX_LEAST_EV) / (AGX_MOST_EV - AGX_LEAST_EV), 0.0, 1.0);
  Vec3 curve = ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x -
                0.00232);
  Vec3 strong = pow(max(curve, Vec3(0.0)), Vec3(1.35));
  Vec3 look = Vec3(luminance(strong)) + 1.4 * (strong - Vec3(luminance(strong)));
  Vec3 encoded = by_rows(Vec3(1.19687900512017, -0.0980208811401368, -0.0990297440797205),
                         Vec3(-0.0528968517574562, 1.15190312990417, -0.0989611768448433),
                         Vec3(-0.0529716355144438, -0.0980434501171241, 1.15107367264116), look);
  return pow(max(encoded, Vec3(0.0)), Vec3(2.2));
}

Vec3 tone_mapped(int tone_map, Vec3 rgb) {
  if (tone_map == TONE_REINHARD) return rgb / (1.0 + luminance(rgb));
  if (tone_map == TONE_EXPONENTIAL) return 1.0 - exp(-rgb);
  if (tone_map == TONE_ACES) return max(aces(rgb), Vec3(0.0));
  if (tone_map == TONE_AGX) return agx(rgb);
  return rgb;
}

// [IEC 61966-2-1]
Real srgb_encoded(Real x) {
  return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}
