// Names of the files of a sequence: "sky-%05d.exr", as ffmpeg reads it back.
#pragma once

#include <filesystem>
#include <string>

namespace cyanometer {

class FilePattern {
 public:
  /// @throws std::invalid_argument where the file's name has not exactly one %d or %0Nd
  explicit FilePattern(const std::string& text);

  std::filesystem::path file(int number) const;
  /// "sky-manifest" in the same folder.
  std::filesystem::path manifest_stem() const;

 private:
  std::filesystem::path folder_;
  std::string before_, after_;
  int digits_ = 0;
};

}  // namespace cyanometer
