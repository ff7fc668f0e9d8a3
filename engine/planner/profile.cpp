#include "engine/planner/profile.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/fingerprint.h"

namespace cyanometer {
namespace {

using nlohmann::json;

std::filesystem::path file_of(const std::filesystem::path& folder, const std::string& device) {
  return folder / (fingerprint(device) + ".json");
}

}  // namespace

std::optional<DeviceProfile> load_profile(const std::filesystem::path& folder,
                                          const std::string& device) {
  std::ifstream in(file_of(folder, device), std::ios::binary);
  if (folder.empty() || !in) return std::nullopt;
  json kept = json::parse(in, nullptr, false);
  if (!kept.is_object() || kept.value("device", json()) != device) return std::nullopt;
  DeviceProfile profile;
  json paces = kept.value("evaluations_per_ms", json::object());
  for (const auto& [method, pace] : paces.items()) {
    if (!pace.is_number() || pace <= 0) return std::nullopt;
    profile.evaluations_per_ms[method] = pace;
  }
  return profile;
}

bool save_profile(const std::filesystem::path& folder, const std::string& device,
                  const DeviceProfile& profile) {
  if (folder.empty()) return false;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  std::filesystem::path file = file_of(folder, device), unfinished = file;
  unfinished += ".new";
  std::ofstream out(unfinished, std::ios::binary);
  out << json{{"device", device}, {"evaluations_per_ms", profile.evaluations_per_ms}}.dump(1)
      << "\n";
  out.close();
  if (!out) return false;
  std::filesystem::rename(unfinished, file, error);
  return !error;
}

}  // namespace cyanometer
