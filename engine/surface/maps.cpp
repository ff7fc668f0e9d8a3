#include "engine/surface/maps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>
#include <list>
#include <mutex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "engine/scene/document.h"
#include "engine/surface/image_file.h"

namespace cyanometer {
namespace {

namespace fs = std::filesystem;

/// Larger files hold no image that is taken, or are not compressed at all.
constexpr std::uintmax_t most_file_bytes = std::uintmax_t{256} << 20;

struct Library {
  std::mutex mutex;
  fs::path folder;
  std::size_t most_bytes = std::size_t{64} << 20;
  std::list<std::shared_ptr<const SurfaceImages>> kept;  ///< used last first
};

Library& library() {
  static Library all;
  return all;
}

/// A file of the folder that a member names.
struct NamedFile {
  std::string pointer, name;
  fs::path path;

  [[noreturn]] void refuse(const std::string& why) const {
    throw SceneError(pointer, nlohmann::json(name).dump(),
                     "the name of a .png, .jpg or .exr image in the surfaces' folder", why);
  }
  std::string extension() const { return path.extension().string().substr(1); }
  std::string state() const {
    return name + " " + std::to_string(fs::file_size(path)) + " " +
           std::to_string(fs::last_write_time(path).time_since_epoch().count());
  }
  std::string bytes() const {
    std::ifstream file(path, std::ios::binary);
    std::string all(std::istreambuf_iterator<char>(file), {});
    if (!file) refuse("it cannot be read");
    return all;
  }
};

NamedFile file_of(const fs::path& folder, const char* member, const std::string& name) {
  NamedFile file{std::string("/planet/surface/") + member, name, {}};
  if (folder.empty()) file.refuse("this server has no folder of surfaces (--surfaces)");
  std::error_code failed;
  fs::path root = fs::canonical(folder, failed);
  if (failed) file.refuse("the folder of surfaces cannot be opened");
  file.path = fs::canonical(root / name, failed);
  // A link may lead within the folder, and nowhere else.
  if (failed || !fs::is_regular_file(file.path)) file.refuse("there is no such file");
  if (file.path.parent_path() != root) file.refuse("it leads out of the folder");
  if (fs::file_size(file.path) > most_file_bytes) file.refuse("the file is too large");
  return file;
}

/// The files of a map.
struct MapFiles {
  NamedFile colours;
  std::optional<NamedFile> heights;

  std::string key() const { return colours.state() + (heights ? " " + heights->state() : ""); }
};

MapFiles files_of(const fs::path& folder, const MapSurface& surface) {
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

void keep(Library& all, std::shared_ptr<const SurfaceImages> images) {
  all.kept.push_front(std::move(images));
  std::size_t bytes = 0;
  std::erase_if(all.kept, [&](const auto& each) {
    bytes += bytes_of(*each);
    return bytes > all.most_bytes;
  });
}

}  // namespace

void use_surfaces(const fs::path& folder, std::size_t most_bytes) {
  Library& all = library();
  std::lock_guard lock(all.mutex);
  all.folder = folder;
  all.most_bytes = most_bytes;
  all.kept.clear();
}

std::string surface_key(const MapSurface& surface) {
  Library& all = library();
  std::lock_guard lock(all.mutex);
  return files_of(all.folder, surface).key();
}

std::shared_ptr<const SurfaceImages> surface_images(const MapSurface& surface) {
  Library& all = library();
  std::unique_lock lock(all.mutex);
  MapFiles files = files_of(all.folder, surface);
  std::string key = files.key();
  auto known = [&]() -> std::shared_ptr<const SurfaceImages> {
    auto found = std::ranges::find(all.kept, key, [](const auto& each) { return each->key; });
    if (found == all.kept.end()) return nullptr;
    all.kept.splice(all.kept.begin(), all.kept, found);
    return all.kept.front();
  };
  if (auto images = known()) return images;
  // Reading gives way to shorter jobs on this thread, which may want a map too.
  lock.unlock();
  auto images = load(key, files);
  lock.lock();
  if (auto other = known()) return other;
  keep(all, images);
  return images;
}

}  // namespace cyanometer
