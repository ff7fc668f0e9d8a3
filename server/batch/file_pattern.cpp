#include "server/batch/file_pattern.h"

#include <regex>
#include <stdexcept>

namespace cyanometer {

FilePattern::FilePattern(const std::string& text)
    : folder_(std::filesystem::path(text).parent_path()) {
  static const std::regex form("([^%]*)%(?:0([1-9]))?d([^%]*)");
  const std::string name = std::filesystem::path(text).filename().string();
  std::smatch parts;
  if (!std::regex_match(name, parts, form)) {
    throw std::invalid_argument(
        text + " names no frames: it wants the frame's number once, as %d or %05d");
  }
  before_ = parts[1];
  digits_ = parts[2].matched ? std::stoi(parts[2]) : 0;
  after_ = parts[3];
}

std::filesystem::path FilePattern::file(int number) const {
  std::string digits = std::to_string(number);
  const auto wanted = static_cast<std::size_t>(digits_);
  if (digits.size() < wanted) digits.insert(0, wanted - digits.size(), '0');
  return folder_ / (before_ + digits + after_);
}

std::filesystem::path FilePattern::manifest_stem() const {
  return folder_ / (before_ + "manifest");
}

}  // namespace cyanometer
