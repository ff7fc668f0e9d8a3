// The image: its size, its file, and how radiance becomes what is shown.
#include "engine/image/encode.h"
#include "engine/scene/members.h"

namespace cyanometer {
namespace {

// A cube map's faces stand in a strip, six times as high as wide.
constexpr int widest = 16384;
constexpr int highest = 6 * widest;

int usual_height(const Image& image, const Reading& read) {
  switch (read.scene.camera.projection) {
    case Projection::fisheye:
      return image.width;
    case Projection::equirectangular:
      return image.width / 2;
    case Projection::cubemap:
      return 6 * image.width;
    default:
      return Image{}.height;
  }
}

void check_shape(const Image& image, const At& at) {
  const Projection projection = at.reading.scene.camera.projection;
  if (projection == Projection::equirectangular) {
    if (image.width % 2 != 0)
      refuse(at / "width", image.width, "even", "an equirectangular image is 2:1");
    if (image.width != 2 * image.height)
      refuse(at / "height", image.height, std::to_string(image.width / 2) + ", half the width",
             "an equirectangular image is 2:1");
  }
  if (projection == Projection::cubemap && image.height != 6 * image.width)
    refuse(at / "height", image.height,
           std::to_string(6 * image.width) + ", six times the width",
           "a cubemap is a strip of six faces");
}

void check_rows(const Image& image, const At& at) {
  const Encoding& file = encoding(image.format);
  if (image.height <= file.most_rows) return;
  refuse(at / "height", image.height, "at most " + std::to_string(file.most_rows),
         "a file of format " + std::string(file.name) + " has no more rows");
}

Spelled<ImageFormat> format() {
  std::vector<std::pair<std::string, ImageFormat>> names;
  for (const Encoding& one : encodings()) names.emplace_back(one.name, one.format);
  return choice(std::move(names));
}

bool is_displayed(const Image& image) { return encoding(image.format).displayed; }
bool may_have_layers(const Image& image) { return image.format == ImageFormat::exr; }
bool may_be_spectral(const Image& image) {
  return image.format == ImageFormat::exr || image.format == ImageFormat::npy;
}

/// "d65", "sun", or a temperature.
class White final : public Spelling<WhitePoint> {
 public:
  WhitePoint read(const Json& given, const At& at) const override {
    if (given.is_number()) return {WhitePoint::Kind::kelvin, kelvin_->read(given, at)};
    if (!given.is_string()) refuse(at, given, words());
    return {name_->read(given, at), WhitePoint{}.kelvin};
  }
  Json write(const WhitePoint& white) const override {
    return white.kind == WhitePoint::Kind::kelvin ? kelvin_->write(white.kelvin)
                                                  : name_->write(white.kind);
  }
  Json schema(const Surroundings& around) const override {
    return {{"anyOf", {name_->schema(around), kelvin_->schema(around)}}};
  }
  std::string words() const override {
    return name_->words() + ", or " + kelvin_->words() + " (kelvin)";
  }
  bool takes(const Json& given) const override {
    return given.is_number() || given.is_string();
  }

 private:
  Spelled<WhitePoint::Kind> name_ = choice<WhitePoint::Kind>(
      {{"d65", WhitePoint::Kind::d65}, {"sun", WhitePoint::Kind::sun}});
  Spelled<double> kelvin_ = number(1000, 25000);
};

}  // namespace

ObjectOf<Image> image_members() {
  return object<Image>(
      Member("width", &Image::width, integer(1, widest), "Width", "Pixels in a row.")
          .unit("px")
          .slider(64, 3840, 1),
      Member("height", &Image::height, integer(1, highest), "Height", "Rows of pixels.")
          .unit("px")
          .otherwise("720 for perspective, the width for fisheye, half of it for "
                     "equirectangular, six times it for cubemap",
                     usual_height)
          .slider(64, 2160, 1),
      Member("format", &Image::format, format(), "File format", "The kind of file."),
      Member("channels", &Image::channels,
             choice<Channels>({{"rgb", Channels::rgb}, {"spectral", Channels::spectral}}),
             "Channels", "For EXR and NPY: colour, or one channel for each wavelength.")
          .refused_unless(may_be_spectral,
                          "only EXR and NPY hold a channel for each wavelength"),
      Member("layers", &Image::layers,
             name_set<Layers>({{"transmittance", &Layers::transmittance},
                               {"inscatter", &Layers::inscatter},
                               {"ground", &Layers::ground},
                               {"sun", &Layers::sun}}),
             "Layers", "For EXR: what the frame is made of, as layers beside it.")
          .refused_unless(may_have_layers, "only EXR has layers"),
      Member("exposure_ev", &Image::exposure_ev,
             keyword_or("auto", optional(number(-100, 100))), "Exposure",
             "Stops; at 0 a white card that faces the sun outside the air is white.")
          .slider(-10, 20, 0.1)
          .idle_unless(is_displayed),
      Member("tone_map", &Image::tone_map,
             choice<ToneMap>({{"linear", ToneMap::linear},
                              {"reinhard", ToneMap::reinhard},
                              {"exponential", ToneMap::exponential},
                              {"aces", ToneMap::aces},
                              {"agx", ToneMap::agx}}),
             "Tone map", "How bright light is brought into the range of a screen.")
          .idle_unless(is_displayed),
      Member("white", &Image::white, Spelled<WhitePoint>(std::make_shared<White>()), "White",
             "The light that looks white: daylight as it is, the sun's, or a temperature in "
             "kelvin.")
          .slider(2000, 12000, 50)
          .idle_unless(is_displayed),
      Member("show", &Image::show,
             name_set<Show>({{"sun", &Show::sun},
                             {"stars", &Show::stars},
                             {"ground", &Show::ground},
                             {"clipped", &Show::clipped}}),
             "Show",
             "What is shown; clipped paints the pixels that are too bright to be shown."),
      Rule<Image>(check_shape), Rule<Image>(check_rows));
}

}  // namespace cyanometer
