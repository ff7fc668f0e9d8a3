// The camera.
#include "engine/optics/sun_position.h"
#include "engine/scene/members.h"

namespace cyanometer {
namespace {

bool has_field_of_view(const Camera& camera) {
  return camera.projection == Projection::perspective ||
         camera.projection == Projection::fisheye;
}

double usual_pitch_deg(const Camera& camera, const Reading&) {
  switch (camera.projection) {
    case Projection::perspective:
      return 10;
    case Projection::fisheye:
      return 90;
    default:
      return 0;
  }
}

double usual_fov_deg(const Camera& camera, const Reading&) {
  return camera.projection == Projection::fisheye ? 180 : 60;
}

}  // namespace

ObjectOf<Camera> camera_members() {
  return object<Camera>(
      Member("altitude_km", &Camera::altitude_km, number(0, 1e6), "Altitude",
             "Height of the camera above the ground.")
          .log_slider(0.001, 1e5),
      Member("latitude_deg", &Camera::latitude_deg, number(-90, 90), "Latitude",
             "Latitude of the point under the camera.")
          .otherwise("that of sun.place, else 0",
                     [](const Camera&, const Reading& read) {
                       return read.place ? read.place->latitude_deg : 0;
                     })
          .slider(-90, 90, 0.1),
      Member("longitude_deg", &Camera::longitude_deg, number(-360, 360), "Longitude",
             "Longitude of the point under the camera.")
          .otherwise("that of sun.place, else 0",
                     [](const Camera&, const Reading& read) {
                       return read.place ? read.place->longitude_deg : 0;
                     })
          .slider(-180, 180, 0.1),
      Member("sidereal_time_deg", &Camera::sidereal_time_deg, number(-360, 360),
             "Sidereal time",
             "How far the planet has turned under the stars, at longitude 0 (15 deg an hour).")
          .otherwise("that of sun.place, else 0",
                     [](const Camera&, const Reading& read) {
                       return read.place ? sidereal_time_deg(read.place->time) : 0;
                     })
          .slider(0, 360, 0.1),
      Member("projection", &Camera::projection,
             choice<Projection>({{"perspective", Projection::perspective},
                                 {"fisheye", Projection::fisheye},
                                 {"equirectangular", Projection::equirectangular},
                                 {"cubemap", Projection::cubemap}}),
             "Projection", "How directions become pixels."),
      Member("heading_deg", &Camera::heading_deg, number(-360, 360), "Heading",
             "Direction in which the camera looks, clockwise from north.")
          .slider(-180, 180, 1),
      Member("pitch_deg", &Camera::pitch_deg, number(-90, 90), "Pitch",
             "How far the camera looks up from the horizontal.")
          .otherwise("10 for perspective, 90 for fisheye, else 0", usual_pitch_deg)
          .slider(-90, 90, 0.5),
      Member("roll_deg", &Camera::roll_deg, number(-360, 360), "Roll",
             "Turns the camera clockwise, seen from behind it.")
          .slider(-180, 180, 1),
      Member("fov_deg", &Camera::fov_deg, number(1, 360), "Field of view",
             "Vertical for perspective, up to 179; the full circle for fisheye.")
          .otherwise("60 for perspective, 180 for fisheye", usual_fov_deg)
          .slider(5, 180, 1)
          .idle_unless(has_field_of_view),
      Rule<Camera>([](const Camera& camera, const At& at) {
        if (camera.projection == Projection::perspective && camera.fov_deg > 179)
          refuse(at / "fov_deg", camera.fov_deg, number(1, 179)->words(),
                 "the projection is perspective");
      }));
}

}  // namespace cyanometer
