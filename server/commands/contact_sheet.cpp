// cyanometer contact-sheet: all presets as one picture.
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/image/encode.h"
#include "engine/image/font.h"
#include "engine/scene/document.h"
#include "server/commands/command.h"

namespace cyanometer {
namespace {

struct ContactSheetArguments {
  std::string output, device;
  int width = 1600, columns = 5;
  std::vector<std::string> presets;
};

/// Those that are asked for, in the order in which they are shown; all where none is.
std::vector<Preset> presets_of(const ContactSheetArguments& arguments) {
  std::vector<Preset> shown = presets();
  if (arguments.presets.empty()) return shown;
  std::erase_if(shown, [&](const Preset& preset) {
    return std::ranges::find(arguments.presets, preset.name) == arguments.presets.end();
  });
  return shown;
}

/// Pixels of the sheet, four bytes each.
struct Sheet {
  int width, height;
  std::vector<unsigned char> rgbx;

  Sheet(int width_, int height_)
      : width(width_), height(height_), rgbx(std::size_t(width_) * height_ * 4, 24) {}
  unsigned char* at(int x, int y) { return &rgbx[(std::size_t(y) * width + x) * 4]; }
  void paste(const Frame& frame, int x, int y) {
    for (int row = 0; row < frame.height; ++row) {
      std::copy_n(frame.rgbx + std::size_t(row) * frame.width * 4, std::size_t(frame.width) * 4,
                  at(x, y + row));
    }
  }
  void write(const std::string& text, int x, int y, int right) {
    draw_text(rgbx.data(), width, x, y, right, text, {220, 220, 220});
  }
};

constexpr int gap = 8;
constexpr int label = font_height + gap;

/// The preset's picture in the shape it asks for, as large as fits the cell.
Scene thumbnail(const Preset& preset, int cell_width, int cell_height) {
  const Image full = read_scene({{"preset", preset.name}}).image;
  const double scale =
      std::min(double(cell_width) / full.width, double(cell_height) / full.height);
  int width = std::max(2, static_cast<int>(std::lround(full.width * scale)));
  int height = std::max(1, static_cast<int>(std::lround(full.height * scale)));
  if (full.width == 2 * full.height) {
    height = width / 2;
    width = 2 * height;
  } else if (full.height == 6 * full.width) {
    height = 6 * width;
  }
  return read_scene({{"preset", preset.name},
                     {"image", {{"width", width}, {"height", height}, {"format", "png"}}}});
}

void contact_sheet(const ContactSheetArguments& arguments) {
  const int cell = (arguments.width - gap) / arguments.columns - gap;
  const int cell_height = cell * 9 / 16;
  const std::vector<Preset> shown = presets_of(arguments);
  const int count = static_cast<int>(shown.size());
  const int rows = (count + arguments.columns - 1) / arguments.columns;
  const int pitch = cell_height + label + gap;
  Sheet sheet(arguments.width, rows * pitch + gap);
  const Watch watch = command_watch();
  Engine engine = command_engine(arguments.device);
  for (int i = 0; i < count; ++i) {
    const Preset& preset = shown[static_cast<std::size_t>(i)];
    const int x = gap + i % arguments.columns * (cell + gap);
    const int y = gap + i / arguments.columns * pitch;
    const Frame frame = engine.render(thumbnail(preset, cell, cell_height), watch);
    sheet.paste(frame, x + (cell - frame.width) / 2, y + (cell_height - frame.height) / 2);
    sheet.write(preset.name, x, y + cell_height + gap / 2, x + cell);
  }
  end_progress();
  Frame whole;
  whole.width = sheet.width;
  whole.height = sheet.height;
  whole.rgbx = sheet.rgbx.data();
  whole.description = nlohmann::json{{"version", version()}}.dump();
  Scene as_png;
  as_png.image.width = sheet.width;
  as_png.image.height = sheet.height;
  write_file(arguments.output, encode(whole, as_png));
}

}  // namespace

void add_contact_sheet(CLI::App& app) {
  auto* command = app.add_subcommand("contact-sheet", "Render all presets as one picture");
  const auto arguments = std::make_shared<ContactSheetArguments>();
  command->add_option("-o,--output", arguments->output, "PNG file")->required();
  command->add_option("--width", arguments->width, "Pixels of the whole")
      ->check(CLI::Range(200, 16384))
      ->capture_default_str();
  command->add_option("--columns", arguments->columns, "Pictures in a row")
      ->check(CLI::Range(1, 10))
      ->capture_default_str();
  command->add_option("--preset", arguments->presets, "Only these; may be repeated")
      ->check(CLI::IsMember(preset_names()));
  command->add_option("--device", arguments->device, "Part of the Vulkan device's name");
  command->footer("Example: cyanometer contact-sheet -o presets.png --width 1600");
  command->callback([arguments] { contact_sheet(*arguments); });
}

}  // namespace cyanometer
