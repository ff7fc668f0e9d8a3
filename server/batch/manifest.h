// What is known of the frames in a folder, a line of JSON each. Several processes may work in
// one folder: each writes a manifest of its own, while it alone does, and reads all.
#pragma once

#include <filesystem>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "server/batch/lock_file.h"

namespace cyanometer {

class Manifest {
 public:
  /// @param stem    of the folder's manifests: "out/sky-manifest"
  /// @param suffix  of this one: out/sky-manifest.3-of-16.jsonl
  /// @throws std::runtime_error where another process writes that one
  Manifest(const std::filesystem::path& stem, const std::string& suffix);

  /// True where the file is there as it was written, from what has this key.
  bool complete(const std::filesystem::path& file, const std::string& key) const;

  /// Writes the manifest anew, without the lines of files that are made again.
  void begin(const std::set<std::string>& made_again);
  /// May be called from any thread. The line names its `file`, in the manifest's folder, its
  /// `key` and its `bytes`. @throws std::runtime_error
  void add(const nlohmann::json& line);

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  LockFile lock_;  ///< before anything is read
  std::vector<nlohmann::json> own_;
  std::set<std::string> complete_;  ///< file, key and bytes of all lines
  std::mutex mutex_;
  std::ofstream out_;
};

}  // namespace cyanometer
