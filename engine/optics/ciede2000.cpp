#include "engine/optics/ciede2000.h"

#include <cmath>
#include <numbers>

namespace cyanometer {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double delta = 6.0 / 29;

Triple white() { return xyz_from_rec709() * Triple{1, 1, 1}; }

double lab_curve(double t) {
  return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}
double inverse_lab_curve(double f) {
  return f > delta ? f * f * f : 3 * delta * delta * (f - 4.0 / 29);
}

double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double seventh_root_share(double chroma) {
  const double c7 = std::pow(chroma, 7);
  return std::sqrt(c7 / (c7 + std::pow(25.0, 7)));
}

/// Degrees, 0 to 360; 0 of grey.
double hue(double a, double b) {
  const double angle = std::atan2(b, a) / degree;
  return angle < 0 ? angle + 360 : angle;
}

/// The shorter way from one hue to the other, and the hue in the middle of it.
struct Hues {
  double difference, mean;
  Hues(double h1, double h2, bool grey) {
    difference = h2 - h1;
    mean = (h1 + h2) / 2;
    if (grey) {
      difference = 0;
      mean = h1 + h2;
    } else if (std::abs(difference) > 180) {
      difference += difference > 0 ? -360 : 360;
      mean += h1 + h2 < 360 ? 180 : -180;
    }
  }
};

double cosine(double degrees) { return std::cos(degrees * degree); }
double square(double x) { return x * x; }

}  // namespace

Triple lab_from_xyz(const Triple& xyz) {
  static const Triple n = white();
  const double x = lab_curve(xyz[0] / n[0]), y = lab_curve(xyz[1] / n[1]),
               z = lab_curve(xyz[2] / n[2]);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Triple xyz_from_lab(const Triple& lab) {
  static const Triple n = white();
  const double y = (lab[0] + 16) / 116;
  return {n[0] * inverse_lab_curve(y + lab[1] / 500), n[1] * inverse_lab_curve(y),
          n[2] * inverse_lab_curve(y - lab[2] / 200)};
}

Triple lab_from_srgb(const Triple& encoded) {
  Triple linear;
  for (std::size_t c = 0; c < 3; ++c) linear[c] = linear_from_srgb(encoded[c]);
  return lab_from_xyz(xyz_from_rec709() * linear);
}

double ciede2000(const Triple& lab1, const Triple& lab2) {
  const double mean_chroma = (std::hypot(lab1[1], lab1[2]) + std::hypot(lab2[1], lab2[2])) / 2;
  const double stretch = 1 + 0.5 * (1 - seventh_root_share(mean_chroma));
  const double a1 = stretch * lab1[1], a2 = stretch * lab2[1];
  const double c1 = std::hypot(a1, lab1[2]), c2 = std::hypot(a2, lab2[2]);
  const Hues hues(hue(a1, lab1[2]), hue(a2, lab2[2]), c1 * c2 == 0);

  const double lightness = lab2[0] - lab1[0], chroma = c2 - c1;
  const double hue_distance = 2 * std::sqrt(c1 * c2) * std::sin(hues.difference / 2 * degree);

  const double l = (lab1[0] + lab2[0]) / 2, c = (c1 + c2) / 2, h = hues.mean;
  const double t = 1 - 0.17 * cosine(h - 30) + 0.24 * cosine(2 * h) + 0.32 * cosine(3 * h + 6) -
                   0.20 * cosine(4 * h - 63);
  const double rotation =
      -std::sin(60 * std::exp(-square((h - 275) / 25)) * degree) * 2 * seventh_root_share(c);
  const double in_l = lightness / (1 + 0.015 * square(l - 50) / std::sqrt(20 + square(l - 50)));
  const double in_c = chroma / (1 + 0.045 * c);
  const double in_h = hue_distance / (1 + 0.015 * c * t);
  return std::sqrt(square(in_l) + square(in_c) + square(in_h) + rotation * in_c * in_h);
}

}  // namespace cyanometer
