#include "engine/surface/maps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <list>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/attention.h"
#include "engine/engine.h"
#include "engine/scene/document.h"
#include "engine/surface/image_file.h"

namespace cyanometer {
namespace {

namespace fs = std::filesystem;

/// Larger files hold no image that is taken, or are not compressed at all.
constexpr std::uintmax_t most_file_bytes = std::uintmax_t{256} << 20;

struct Library {
  /// Of what follows; not held while a file is read.
  std::mutex mutex;
  fs::path folder;
  std::size_t most_bytes = std::size_t{64} << 20;
  std::list<std::shared_ptr<const SurfaceImages>> kept;              ///< used last first
  std::map<std::string, std::weak_ptr<const SurfaceImages>> living;  ///< by key, kept or not
  std::map<std::string, std::array<double, 3>> mean_rgb;             ///< by state of a file
  /// Held by the one who reads: what is decoded takes hundreds of MiB meanwhile.
  std::mutex reading;
};

Library& library() {
  static Library all;
  return all;
}

/// A file of the folder that a member names.
struct NamedFile {
  std::string pointer, name;
  fs::path path;
  std::string state;  ///< name, size and time when it was found

  [[noreturn]] void refuse(const std::string& why) const {
    throw SceneError(pointer, nlohmann::json(name).dump(),
                     "the name of a .png, .jpg or .exr image in the surfaces' folder", why);
  }
  /// Of the name: a link leads where it likes.
  std::string extension() const { return name.substr(name.rfind('.') + 1); }
  std::string bytes() const {
    std::ifstream file(path, std::ios::binary);
    std::string all(std::istreambuf_iterator<char>(file), {});
    if (!file) refuse("it cannot be read");
    return all;
  }
};

bool is_within(const fs::path& path, const fs::path& root) {
  return std::ranges::mismatch(root, path).in1 == root.end();
}

NamedFile file_of(const fs::path& folder, const char* member, const std::string& name) {
  NamedFile file{std::string("/planet/surface/") + member, name, {}, {}};
  if (folder.empty()) file.refuse("this server has no folder of surfaces (--surfaces)");
  std::error_code failed;
  fs::path root = fs::canonical(folder, failed);
  if (failed) file.refuse("the folder of surfaces cannot be opened");
  file.path = fs::canonical(root / name, failed);
  // A link may lead within the folder, and nowhere else.
  if (failed || !fs::is_regular_file(file.path)) file.refuse("there is no such file");
  if (!is_within(file.path, root)) file.refuse("it leads out of the folder");
  const std::uintmax_t size = fs::file_size(file.path);
  if (size > most_file_bytes) file.refuse("the file is too large");
  file.state = name + " " + std::to_string(size) + " " +
               std::to_string(fs::last_write_time(file.path).time_since_epoch().count());
  return file;
}

/// The files of a map.
struct MapFiles {
  NamedFile colours;
  std::optional<NamedFile> heights;

  std::string key() const { return colours.state + (heights ? " " + heights->state : ""); }
};

MapFiles files_of(const MapSurface& surface) {
  const fs::path folder = [] {
    const std::lock_guard lock(library().mutex);
    return library().folder;
  }();
  MapFiles files{file_of(folder, "albedo", surface.albedo), {}};
  if (!surface.height.empty()) files.heights = file_of(folder, "height", surface.height);
  return files;
}

// ---- Texels

using Planes = std::vector<std::vector<float>>;

/// Means over two by two; of an odd last row or column that of its own.
MapPixels halved(const MapPixels& from) {
  MapPixels to{std::max(from.width / 2, 1), std::max(from.height / 2, 1), {}};
  for (const std::vector<float>& plane : from.planes) {
    auto at = [&](int x, int y) {
      return plane[static_cast<std::size_t>(std::min(y, from.height - 1)) * from.width +
                   std::min(x, from.width - 1)];
    };
    std::vector<float>& half = to.planes.emplace_back();
    for (int y = 0; y < to.height; ++y) {
      for (int x = 0; x < to.width; ++x) {
        half.push_back((at(2 * x, 2 * y) + at(2 * x + 1, 2 * y) + at(2 * x, 2 * y + 1) +
                        at(2 * x + 1, 2 * y + 1)) /
                       4);
      }
    }
  }
  return to;
}

std::uint32_t root_in_10_bits(float v) {
  return static_cast<std::uint32_t>(std::lround(1023 * std::sqrt(std::clamp(v, 0.f, 1.f))));
}

/// Appends an image with all its halvings.
SurfaceImages::Place append(std::vector<std::uint32_t>& texels, MapPixels pixels) {
  SurfaceImages::Place place{pixels.width, pixels.height, 0, static_cast<int>(texels.size())};
  while (true) {
    const Planes& p = pixels.planes;
    for (std::size_t i = 0; i < p[0].size(); ++i) {
      texels.push_back(p.size() == 1
                           ? std::bit_cast<std::uint32_t>(p[0][i])
                           : root_in_10_bits(p[0][i]) | root_in_10_bits(p[1][i]) << 10 |
                                 root_in_10_bits(p[2][i]) << 20);
    }
    ++place.levels;
    if (pixels.width == 1 && pixels.height == 1) return place;
    pixels = halved(pixels);
  }
}

std::array<double, 3> mean_by_area(const MapPixels& pixels) {
  std::array<double, 3> sum{};
  double area = 0;
  for (int y = 0; y < pixels.height; ++y) {
    double weight = std::sin(std::numbers::pi * (y + 0.5) / pixels.height);
    area += weight * pixels.width;
    for (std::size_t c = 0; c < 3; ++c) {
      auto row = pixels.planes[c].begin() + std::ptrdiff_t{y} * pixels.width;
      for (int x = 0; x < pixels.width; ++x) sum[c] += weight * row[x];
    }
  }
  for (double& mean : sum) mean /= area;
  return sum;
}

template <class Read>
MapPixels read_or_refuse(const NamedFile& file, Read read) {
  try {
    return read(file.bytes(), file.extension());
  } catch (const ImageError& error) {
    file.refuse(error.what());
  }
}

std::shared_ptr<const SurfaceImages> load(const std::string& key, const MapFiles& files) {
  // Others wait for it: it gives way to no job, which might wait for them.
  const Watch nobody;
  const Attention undisturbed(nobody);
  auto images = std::make_shared<SurfaceImages>();
  std::vector<std::uint32_t> texels;
  images->key = key;
  MapPixels rgb = read_or_refuse(files.colours, read_colours);
  images->mean_rgb = mean_by_area(rgb);
  images->colours = append(texels, std::move(rgb));
  if (files.heights)
    images->heights = append(texels, read_or_refuse(*files.heights, read_heights));
  images->texels = std::make_shared<const std::vector<std::uint32_t>>(std::move(texels));
  return images;
}

std::size_t bytes_of(const SurfaceImages& images) { return 4 * images.texels->size(); }

/// These first; then what there is room for. A map too large for it is kept until another is
/// used: one frame asks for its own many times over.
void keep(Library& all, const std::shared_ptr<const SurfaceImages>& images) {
  all.kept.remove(images);
  all.kept.push_front(images);
  std::size_t bytes = 0;
  std::erase_if(all.kept, [&](const auto& each) {
    bytes += bytes_of(*each);
    return each != images && bytes > all.most_bytes;
  });
}

std::shared_ptr<const SurfaceImages> known(Library& all, const std::string& key) {
  const std::lock_guard lock(all.mutex);
  auto found = all.living.find(key);
  auto images = found == all.living.end() ? nullptr : found->second.lock();
  if (images) keep(all, images);
  return images;
}

void remember(Library& all, const MapFiles& files,
              const std::shared_ptr<const SurfaceImages>& images) {
  constexpr std::size_t most_means = 4096;
  const std::lock_guard lock(all.mutex);
  std::erase_if(all.living, [](const auto& each) { return each.second.expired(); });
  all.living[images->key] = images;
  if (all.mean_rgb.size() >= most_means) all.mean_rgb.clear();
  all.mean_rgb[files.colours.state] = images->mean_rgb;
  keep(all, images);
}

}  // namespace

void use_surfaces(const fs::path& folder, std::size_t most_bytes) {
  Library& all = library();
  const std::lock_guard lock(all.mutex);
  all.folder = folder;
  all.most_bytes = most_bytes;
  all.kept.clear();
  all.living.clear();
  all.mean_rgb.clear();
}

std::string surface_key(const MapSurface& surface) { return files_of(surface).key(); }

std::array<double, 3> surface_mean_rgb(const MapSurface& surface) {
  Library& all = library();
  const std::string state = files_of(surface).colours.state;
  {
    const std::lock_guard lock(all.mutex);
    auto found = all.mean_rgb.find(state);
    if (found != all.mean_rgb.end()) return found->second;
  }
  return surface_images(surface)->mean_rgb;
}

std::shared_ptr<const SurfaceImages> surface_images(const MapSurface& surface) {
  Library& all = library();
  const MapFiles files = files_of(surface);
  const std::string key = files.key();
  if (auto images = known(all, key)) return images;
  const std::lock_guard one_at_a_time(all.reading);
  if (auto images = known(all, key)) return images;  // another has read it meanwhile
  auto images = load(key, files);
  remember(all, files, images);
  return images;
}

}  // namespace cyanometer
