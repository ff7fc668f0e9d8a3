#include "server/batch/manifest.h"

#include <stdexcept>

#include "server/batch/whole_file.h"

namespace cyanometer {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Lines that are whole: one that was cut short is of a frame that will be made again.
std::vector<json> lines_of(const fs::path& path) {
  std::vector<json> lines;
  std::ifstream in(path, std::ios::binary);
  for (std::string text; std::getline(in, text);) {
    json line = json::parse(text, nullptr, false);
    const bool known = line.is_object() && line.contains("file") && line["file"].is_string() &&
                       line.contains("key") && line["key"].is_string() &&
                       line.contains("bytes") && line["bytes"].is_number_unsigned();
    if (known) lines.push_back(std::move(line));
  }
  return lines;
}

std::string identity(const std::string& file, const std::string& key, std::uintmax_t bytes) {
  return file + "\n" + key + "\n" + std::to_string(bytes);
}

std::string identity(const json& line) {
  return identity(line["file"], line["key"], line["bytes"]);
}

bool is_manifest(const fs::path& path, const std::string& stem) {
  const std::string name = path.filename().string();
  return name.starts_with(stem + ".") && name.ends_with(".jsonl");
}

}  // namespace

Manifest::Manifest(const fs::path& stem, const std::string& suffix)
    : path_(stem.string() + suffix + ".jsonl"), lock_(path_), own_(lines_of(path_)) {
  const fs::path folder = stem.has_parent_path() ? stem.parent_path() : ".";
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (!is_manifest(entry.path(), stem.filename().string())) continue;
    for (const json& line : lines_of(entry.path())) complete_.insert(identity(line));
  }
}

bool Manifest::complete(const fs::path& file, const std::string& key) const {
  std::error_code error;
  const auto bytes = fs::file_size(file, error);
  return !error && complete_.contains(identity(file.filename().string(), key, bytes));
}

void Manifest::begin(const std::set<std::string>& made_again) {
  std::string text;
  for (const json& line : own_) {
    if (!made_again.contains(line["file"])) text += line.dump() + "\n";
  }
  write_whole(path_, text);
  out_.open(path_, std::ios::binary | std::ios::app);
}

void Manifest::add(const json& line) {
  const std::lock_guard lock(mutex_);
  out_ << line.dump() + "\n" << std::flush;
  if (!out_) throw std::runtime_error("cannot write " + path_.string());
}

}  // namespace cyanometer
