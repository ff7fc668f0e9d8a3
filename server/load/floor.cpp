#include "server/load/floor.h"

namespace cyanometer {

nlohmann::json unlit_scene(int width, int height, const std::string& format) {
  constexpr double far_km = 1e5, away_deg = 90;
  nlohmann::json scene{{"camera", {{"altitude_km", far_km}, {"pitch_deg", away_deg}}},
                       {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                       {"method", {{"name", "raymarch"}, {"scattering_orders", 0}}}};
  for (const char* constituent : {"air", "aerosol", "ozone"}) {
    scene["atmosphere"]["constituents"][constituent] = nullptr;
  }
  scene["image"] = {{"width", width},
                    {"height", height},
                    {"format", format},
                    {"tone_map", "linear"},
                    {"show", nlohmann::json::array()}};
  return scene;
}

}  // namespace cyanometer
