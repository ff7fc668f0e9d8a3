// Laws of the formulas in shaders/physics/, in double.
#include <gtest/gtest.h>

#include <numbers>

#include "engine/gauss_legendre.h"
#include "engine/physics/pack.h"
#include "engine/sky/pixel.h"

namespace cyanometer {
namespace {

using P = Physics<double>;
constexpr double pi = std::numbers::pi;

P earth_sized() {
  P p;
  p.scene.planet_radius_km = 6360;
  p.scene.thickness_km = 100;
  return p;
}

TEST(Sphere, AltitudeAlongARayIsThatOfLongArithmetic) {
  P p = earth_sized();
  for (double h : {0.0, 0.002, 1.0, 99.0}) {
    for (double mu : {-1.0, -0.3, -0.01, 0.0, 0.01, 0.7, 1.0}) {
      for (double t : {0.001, 1.0, 30.0, 500.0}) {
        long double r = 6360.0L + h,
                    exact = std::sqrt(r * r + 2 * r * mu * t + t * t) - 6360.0L;
        if (exact < 0) continue;
        EXPECT_NEAR(p.altitude_after(h, mu, t), static_cast<double>(exact), 1e-11);
      }
    }
  }
}

TEST(Sphere, DistancesToGroundAndTopEndThere) {
  P p = earth_sized();
  for (double h : {0.001, 0.5, 20.0, 99.9}) {
    for (double mu : {-1.0, -0.5, -0.2, 0.0, 0.3, 1.0}) {
      double to_top = p.distance_to_top(h, mu);
      EXPECT_NEAR(p.altitude_after(h, mu, to_top), 100, 1e-9);
      if (p.meets_ground(h, mu)) {
        EXPECT_NEAR(p.altitude_after(h, mu, p.distance_to_ground(h, mu)), 0, 1e-9);
      }
    }
  }
}

TEST(Sphere, TheHorizonOfAnEyeAtTwoMetresIsFiveKilometresAway) {
  P p = earth_sized();
  double h = 0.002, dip = std::acos(6360 / (6360 + h));
  EXPECT_TRUE(p.meets_ground(h, -std::sin(dip * 1.0001)));
  EXPECT_FALSE(p.meets_ground(h, -std::sin(dip * 0.9999)));
  EXPECT_NEAR(p.distance_to_ground(h, -std::sin(dip * 1.0000001)),
              std::sqrt(h * (2 * 6360 + h)), 0.01);
}

TEST(Sphere, ARayFromTheGroundDownwardsMeetsItAtOnce) {
  P p = earth_sized();
  EXPECT_TRUE(p.meets_ground(0, -0.1));
  EXPECT_EQ(p.distance_to_ground(0, -0.1), 0);
  EXPECT_FALSE(p.meets_ground(0, 0.1));
}

TEST(Sphere, ARayFromSpaceEntersAtTheTop) {
  P p = earth_sized();
  for (double altitude : {100.1, 400.0, 36000.0, 1e6}) {
    p.scene.camera_altitude_km = altitude;
    double edge = std::asin(6460 / (6360 + altitude));
    for (double share : {0.0, 0.5, 0.97, 0.999}) {
      double angle = edge * share;
      P::Path path = p.path_from_camera({std::sin(angle), 0, -std::cos(angle)});
      EXPECT_EQ(path.altitude_km, 100);
      EXPECT_NEAR(glm::length(path.start), 6460, 1e-6);
      EXPECT_NEAR(path.mu, glm::dot(path.start, path.direction) / 6460, 1e-9);
    }
    EXPECT_EQ(
        p.path_from_camera({std::sin(edge * 1.001), 0, -std::cos(edge * 1.001)}).length_km, 0);
  }
}

/// Integral over the sphere of a function of the scattering angle, by points gathered at both
/// peaks.
template <typename Function>
double over_sphere(P& p, Function f) {
  GaussRule rule = gauss_legendre(400);
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    double t = rule.nodes[i], s = t * t * t * (10 - 15 * t + 6 * t * t);
    double ds = 30 * t * t * (1 - t) * (1 - t), theta = pi * s;
    auto angle = p.scattering_angle({0, 0, 1}, {std::sin(theta), 0, std::cos(theta)});
    sum += rule.weights[i] * pi * ds * 2 * pi * std::sin(theta) * f(angle);
  }
  return sum;
}

TEST(Phase, FunctionsIntegrateToOneOverTheSphere) {
  P p;
  for (double g : {-0.999, -0.9, -0.3, 0.0, 0.5, 0.76, 0.95, 0.999}) {
    EXPECT_NEAR(over_sphere(p, [&](auto a) { return p.henyey_greenstein_phase(g, a); }), 1,
                1e-6);
    EXPECT_NEAR(over_sphere(p, [&](auto a) { return p.cornette_shanks_phase(g, a); }), 1, 1e-6);
  }
  for (double gamma : {0.0, 0.0143, 0.3}) {
    auto f = [&](auto a) { return p.rayleigh_phase(glm::dvec4(gamma), a.cosine).x; };
    EXPECT_NEAR(over_sphere(p, f), 1, 1e-10);
  }
}

TEST(Phase, MeanCosineOfHenyeyGreensteinIsG) {
  P p;
  for (double g : {-0.9, 0.0, 0.76, 0.99}) {
    auto f = [&](auto a) { return a.cosine * p.henyey_greenstein_phase(g, a); };
    EXPECT_NEAR(over_sphere(p, f), g, 1e-6);
  }
}

TEST(Phase, OfAForwardPeakIsBrightestTowardsTheSun) {
  P p;
  auto forward = p.scattering_angle({0, 0, 1}, {0, 0, 1});
  auto backward = p.scattering_angle({0, 0, 1}, {0, 0, -1});
  EXPECT_GT(p.cornette_shanks_phase(0.8, forward),
            100 * p.cornette_shanks_phase(0.8, backward));
  EXPECT_NEAR(p.angle_of(backward), pi, 1e-12);
}

TEST(Phase, RayleighWithoutDepolarisationIsTheClassicalOne) {
  P p;
  EXPECT_NEAR(p.rayleigh_phase(glm::dvec4(0), 0.6).x, 3 / (16 * pi) * 1.36, 1e-15);
}

Problem camera_problem(Projection projection, int width, int height) {
  Problem problem;
  problem.planet_radius_km = 6360;
  problem.thickness_km = 100;
  problem.wavelengths_nm = {550};
  problem.ground_albedo = problem.limb_darkening_exponent = {0};
  problem.sun_direction = {0, 0, 1};
  problem.camera.projection = projection;
  problem.camera.heading_deg = 33;
  problem.camera.pitch_deg = 21;
  problem.camera.roll_deg = -14;
  problem.camera.fov_deg = projection == Projection::fisheye ? 220 : 75;
  problem.width = width;
  problem.height = height;
  return problem;
}

/// A frame of square pixels a hundredth of a radian wide, and a sun so many of them wide.
P frame_with_sun(double pixels_wide, double exponent, glm::dvec3 direction = {0, 0, 1}) {
  Problem problem = camera_problem(Projection::perspective, 24, 24);
  problem.camera.altitude_km = 30;
  problem.camera.heading_deg = problem.camera.roll_deg = 0;
  problem.camera.pitch_deg = 90;
  problem.camera.fov_deg = 2 * glm::degrees(std::atan(0.12));
  problem.sun_direction = {direction.x, direction.y, direction.z};
  problem.sun_angular_radius_rad = std::asin(0.005 * pixels_wide);
  problem.limb_darkening_exponent = {exponent};
  return pack<double>(problem);
}

double disc_at(P& p, glm::dvec3 view) {
  glm::dvec3 camera(0, 0, p.scene.planet_radius_km + p.scene.camera_altitude_km);
  return p.disc_radiance(view, camera, p.limb_exponent(0), p.disc_scale(0), p.scene.pixel_rad)
      .x;
}

TEST(Sun, TheDrawnDiscsRadianceOverItsProjectedSolidAngleIsTheIrradiance) {
  for (double exponent : {0.0, 0.3, 0.8}) {
    for (double pixels_wide : {0.01, 0.3, 1.0, 3.0, 20.0, 150.0}) {
      P p = frame_with_sun(pixels_wide, exponent);
      constexpr int steps = 40000;
      double end = std::min(p.scene.sun_sin_radius + 0.02, 1.0), sum = 0;
      for (int i = 0; i < steps; ++i) {
        double sine = end * (i + 0.5) / steps;
        sum += disc_at(p, {sine, 0, std::sqrt(1 - sine * sine)}) * 2 * pi * sine * end / steps;
      }
      EXPECT_NEAR(sum, 1, 2e-4) << exponent << ", " << pixels_wide << " pixels";
    }
  }
}

TEST(Sun, AWideDiscsMeanRadianceIsTheIrradianceOverItsProjectedSolidAngle) {
  P p = frame_with_sun(150, 0.0);
  EXPECT_NEAR(disc_at(p, {0, 0, 1}) * pi * 0.75 * 0.75, 1, 1e-4);
  EXPECT_EQ(disc_at(p, {0.76, 0, std::sqrt(1 - 0.76 * 0.76)}), 0);
}

TEST(Sun, PixelsAddUpToItsIrradianceWhereverInAPixelItStands) {
  for (double pixels_wide : {0.01, 0.5, 1.0, 2.0, 5.0}) {
    double least = 10, most = 0, mean = 0;
    constexpr int side = 6;
    for (int place = 0; place < side * side; ++place) {
      double x = 0.01 * (place % side) / side, y = 0.01 * (place / side) / side;
      P p = frame_with_sun(pixels_wide, 0.5, glm::normalize(glm::dvec3(x, y, 1)));
      double sum = 0;
      for (int pixel = 0; pixel < 24 * 24; ++pixel) {
        sum += disc_at(p, p.pixel_ray(pixel).direction) * pixel_solid_angle(p, pixel);
      }
      least = std::min(least, sum);
      most = std::max(most, sum);
      mean += sum / (side * side);
    }
    EXPECT_NEAR(mean, 1, 0.01) << pixels_wide;
    EXPECT_GT(least, 0.8) << pixels_wide;
    EXPECT_LT(most, 1.25) << pixels_wide;
  }
}

TEST(Sun, PointsOfALargeDiscLightAPlaneThatFacesItAsOneDoes) {
  for (double distance_km : {0.0, 20000.0}) {
    Problem problem = camera_problem(Projection::perspective, 4, 4);
    problem.sun_distance_km = distance_km;
    problem.sun_angular_radius_rad = 0.6;
    problem.sun_disc_samples = 64;
    problem.limb_darkening_exponent = {0.4};
    P p = pack<double>(problem);
    const glm::dvec3 foot(0, 0, p.scene.planet_radius_km);
    const double alone = p.sun_ray(foot, glm::dvec3(0)).irradiance;
    double sum = 0, widest = 0;
    for (int k = 0; k < p.scene.disc_points; ++k) {
      P::SunRay ray = p.sun_ray(foot, p.sun_offset(k));
      sum += p.sun_weight(k, 0).x * ray.irradiance * ray.direction.z;
      widest = std::max(widest, std::acos(ray.direction.z));
    }
    EXPECT_NEAR(sum, alone, 1e-9 * alone);
    EXPECT_NEAR(widest, 0.6, 0.01);
  }
}

TEST(Camera, ThePixelOfAPixelsRayIsThatPixel) {
  for (auto [projection, width, height] :
       {std::tuple{Projection::perspective, 31, 17}, std::tuple{Projection::fisheye, 24, 30},
        std::tuple{Projection::equirectangular, 40, 20},
        std::tuple{Projection::cubemap, 9, 54}}) {
    P camera = pack<double>(camera_problem(projection, width, height));
    for (int pixel = 0; pixel < width * height; ++pixel) {
      P::PixelRay ray = camera.pixel_ray(pixel);
      EXPECT_NEAR(glm::length(ray.direction), 1, 1e-12);
      if (ray.inside) {
        EXPECT_EQ(pixel_of(camera, ray.direction), std::optional<int>(pixel));
      }
    }
  }
}

TEST(Camera, SolidAnglesOfAllPixelsOfAWholeSphereAddUpToIt) {
  for (auto [projection, width, height] : {std::tuple{Projection::equirectangular, 200, 100},
                                           std::tuple{Projection::cubemap, 64, 384}}) {
    P camera = pack<double>(camera_problem(projection, width, height));
    double sum = 0;
    for (int pixel = 0; pixel < width * height; ++pixel) {
      sum += pixel_solid_angle(camera, pixel);
    }
    EXPECT_NEAR(sum, 4 * pi, 1e-3);
  }
}

TEST(Camera, LooksWhereHeadingPitchAndRollSay) {
  Problem problem = camera_problem(Projection::perspective, 3, 3);
  problem.camera.heading_deg = 90;
  problem.camera.pitch_deg = 0;
  problem.camera.roll_deg = 0;
  P camera = pack<double>(problem);
  EXPECT_NEAR(camera.pixel_ray(4).direction.x, 1, 1e-12);  // the centre looks east
  EXPECT_GT(camera.pixel_ray(1).direction.z, 0.1);         // the top row looks up
  EXPECT_LT(camera.pixel_ray(5).direction.y, -0.1);        // the right column looks south
  problem.camera.roll_deg = 90;                            // clockwise: what was right is down
  EXPECT_LT(pack<double>(problem).pixel_ray(5).direction.z, -0.1);
}

TEST(Camera, PanoramasHaveTheirHeadingInTheMiddleAndAzimuthGrowingToTheRight) {
  Problem problem = camera_problem(Projection::equirectangular, 361, 181);
  problem.camera.heading_deg = problem.camera.pitch_deg = problem.camera.roll_deg = 0;
  P camera = pack<double>(problem);
  glm::dvec3 middle = camera.pixel_ray(90 * 361 + 180).direction;
  EXPECT_NEAR(middle.y, 1, 1e-12);
  EXPECT_GT(camera.pixel_ray(90 * 361 + 200).direction.x, 0.1);
  EXPECT_GT(camera.pixel_ray(180).direction.z, 0.99);
}

TEST(Camera, CubeFacesAreInOpenGlsOrder) {
  Problem problem = camera_problem(Projection::cubemap, 1, 6);
  problem.camera.heading_deg = problem.camera.pitch_deg = problem.camera.roll_deg = 0;
  P camera = pack<double>(problem);
  // +X east, +Y up, -Z north; so -X west, -Y down, +Z south.
  std::array<glm::dvec3, 6> faces{
      {{1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {0, 1, 0}}};
  for (int face = 0; face < 6; ++face) {
    EXPECT_NEAR(glm::distance(camera.pixel_ray(face).direction, faces[face]), 0, 1e-12) << face;
  }
}

TEST(GaussLegendre, IntegratesPolynomialsOfDegreeTwoNMinusOneExactly) {
  GaussRule rule = gauss_legendre(7);
  double sum = 0;
  for (std::size_t i = 0; i < 7; ++i) sum += rule.weights[i] * std::pow(rule.nodes[i], 13);
  EXPECT_NEAR(sum, 1.0 / 14, 1e-15);
}

}  // namespace
}  // namespace cyanometer
