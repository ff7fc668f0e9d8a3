// How fast a device is, as plans reckon: measured once, kept on disk, so that equal requests
// have equal answers whatever else the machine is doing.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace cyanometer {

struct DeviceProfile {
  /// By method, of the evaluations that it reckons with (Method::evaluations); and of what is
  /// done with every pixel, whatever it shows.
  std::map<std::string, double> evaluations_per_ms;
  static constexpr const char* frame = "frame";
  /// For which a pixel counts there that is traced; one that lies between those that are; and
  /// that there are some.
  static constexpr double evaluations_per_pixel = 40, evaluations_between = 2,
                          evaluations_of_lattice = 2e6;

  /// Of a software device on two cores, where nothing is known of a method.
  static constexpr double nominal = 4e5;
  double pace(const std::string& method) const {
    auto known = evaluations_per_ms.find(method);
    return known == evaluations_per_ms.end() ? nominal : known->second;
  }
};

/// The profile that `folder` keeps of a device of this identity (its name, driver and version),
/// or nothing where there is none that can be read.
std::optional<DeviceProfile> load_profile(const std::filesystem::path& folder,
                                          const std::string& device);
/// @returns false where it cannot be written
bool save_profile(const std::filesystem::path& folder, const std::string& device,
                  const DeviceProfile& profile);

}  // namespace cyanometer
