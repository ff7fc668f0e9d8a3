#include "server/routes/composite_scene.h"

#include <nlohmann/json.hpp>

#include "engine/image/picture.h"
#include "server/routes/reading.h"

namespace cyanometer {
namespace {

using nlohmann::json;

void set_extent(json& image, const char* name, std::int64_t pixels) {
  if (image.contains(name) && !image[name].is_null() && image[name] != pixels) {
    refuse(std::string("/image/") + name, image[name],
           std::to_string(pixels) + ", as the picture has, or absent");
  }
  image[name] = pixels;
}

}  // namespace

json sized_as(json document, std::string_view picture) {
  const ExrSize size = exr_size(picture);
  if (!document.is_object()) return document;  // refused with the document
  json& image = document["image"];
  if (!image.is_null() && !image.is_object()) return document;
  set_extent(image, "width", size.width);
  set_extent(image, "height", size.height);
  return document;
}

void check_composite(const Scene& scene) {
  if (scene.image.channels != Channels::spectral) return;
  refuse("/image/channels", "spectral", "rgb: a picture of R, G and B has no spectra");
}

}  // namespace cyanometer
