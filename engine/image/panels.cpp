#include "engine/image/panels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "engine/image/font.h"

namespace cyanometer {
namespace {

using Pixel = std::array<unsigned char, 3>;

constexpr Pixel paper{32, 34, 38}, ink{220, 220, 220};
constexpr double decades = 6;  ///< from black to white
constexpr int gap = 8, line = font_height + 6;
constexpr int most_columns = 8, most_rows = 6;
constexpr int small_panel = 104, large_panel = 512, strip = 64;  ///< pixels aimed at

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Some of `count` nodes, evenly chosen.
std::vector<int> chosen(int count, int most) {
  std::vector<int> nodes;
  int shown = std::min(count, most);
  for (int i = 0; i < shown; ++i) {
    nodes.push_back(
        shown == 1 ? 0 : static_cast<int>(std::lround(1.0 * i * (count - 1) / (shown - 1))));
  }
  return nodes;
}

/// Where everything lies on the page.
struct Page {
  explicit Page(const Panels& panels)
      : rows(chosen(panels.rows.nodes, most_rows)),
        columns(chosen(panels.columns.nodes, most_columns)) {
    int aim = rows.size() * columns.size() > 1 ? small_panel : large_panel;
    across = std::max(1, aim / panels.across.nodes);
    down = std::max(1, (panels.down.nodes > 1 ? aim : strip) / panels.down.nodes);
    panel_width = across * panels.across.nodes;
    panel_height = down * panels.down.nodes;
    for (const Panels::Axis* axis : {&panels.rows, &panels.down}) {
      for (const std::string& label : axis->labels) {
        left = std::max(left, text_width(label) + 2 * gap);
      }
    }
  }
  int x(std::size_t column) const {
    return left + static_cast<int>(column) * (panel_width + gap);
  }
  int y(std::size_t row) const { return top + static_cast<int>(row) * (panel_height + gap); }

  std::vector<int> rows, columns;  ///< of panels, that are shown
  int across, down;                ///< pixels of a node
  int panel_width, panel_height;
  int left = gap, top = 0;  ///< of the first panel
};

struct Canvas {
  Canvas(int width_, int height_) : width(width_), height(height_) {
    for (int i = 0; i < width * height; ++i) {
      rgbx.insert(rgbx.end(), {paper[0], paper[1], paper[2], 255});
    }
  }
  void fill(int x, int y, int columns, int rows, const Pixel& colour) {
    for (int j = y; j < y + rows; ++j) {
      for (int i = x; i < x + columns; ++i) {
        std::ranges::copy(colour, &rgbx[(std::size_t{1} * j * width + i) * 4]);
      }
    }
  }
  void write(const std::string& text, int x, int y) {
    draw_text(rgbx.data(), width, x, y, width, text, ink);
  }

  int width, height;
  std::vector<unsigned char> rgbx;
};

float brightest(const Panels& panels) {
  float most = 1e-30F;
  for (const auto& plane : panels.values)
    most = std::max(most, *std::ranges::max_element(plane));
  return most;
}

unsigned char level(double share) {
  double depth = std::log10(std::max(share, 1e-30)) / decades;
  return static_cast<unsigned char>(std::lround(255 * std::clamp(1 + depth, 0.0, 1.0)));
}

std::array<std::size_t, 3> shown_wavelengths(const Panels& panels) {
  std::size_t last = panels.values.size() - 1;
  return {0, last / 2, last};
}

Pixel colour_of(const Panels& panels, std::size_t node, float most) {
  Pixel colour;
  std::ranges::transform(shown_wavelengths(panels), colour.begin(),
                         [&](std::size_t w) { return level(panels.values[w][node] / most); });
  return colour;
}

void draw_panel(const Panels& panels, const Page& page, std::size_t row, std::size_t column,
                float most, Canvas& canvas) {
  std::size_t panel =
      std::size_t{1} * page.rows[row] * panels.columns.nodes + page.columns[column];
  std::size_t node = panel * panels.down.nodes * panels.across.nodes;
  for (int j = 0; j < panels.down.nodes; ++j) {
    for (int i = 0; i < panels.across.nodes; ++i, ++node) {
      canvas.fill(page.x(column) + i * page.across, page.y(row) + j * page.down, page.across,
                  page.down, colour_of(panels, node, most));
    }
  }
}

/// The first, the middle and the last label of a panel's axis along a stretch of pixels, each
/// `size(label)` pixels long.
template <class Size, class Write>
void label_ends(const Panels::Axis& axis, int length, Size size, Write write) {
  for (std::size_t i = 0; i < axis.labels.size(); ++i) {
    int room = length - size(axis.labels[i]);
    write(axis.labels[i], static_cast<int>(i) * room / 2);
  }
}

void label_panels(const Panels& panels, const Page& page, Canvas& canvas) {
  for (std::size_t c = 0; c < page.columns.size() && !panels.columns.labels.empty(); ++c) {
    canvas.write(panels.columns.labels[page.columns[c]], page.x(c), page.top - line);
  }
  for (std::size_t r = 0; r < page.rows.size() && !panels.rows.labels.empty(); ++r) {
    canvas.write(panels.rows.labels[page.rows[r]], gap, page.y(r) + page.panel_height / 4);
  }
  label_ends(
      panels.down, page.panel_height, [](const std::string&) { return font_height; },
      [&](const std::string& label, int y) {
        canvas.write(label, page.left - gap / 2 - text_width(label), page.y(0) + y);
      });
  label_ends(panels.across, page.panel_width, text_width, [&](const std::string& label, int x) {
    canvas.write(label, page.left + x, page.y(page.rows.size()) - gap / 2);
  });
}

std::vector<std::string> captions(const Panels& panels) {
  std::vector<std::string> lines{panels.title};
  auto explain = [&](const std::string& where, const Panels::Axis& axis) {
    if (axis.nodes > 1) lines.push_back(where + axis.quantity);
  };
  explain("panels across - ", panels.columns);
  explain("panels down - ", panels.rows);
  explain("across - ", panels.across);
  explain("down - ", panels.down);
  auto [red, green, blue] = shown_wavelengths(panels);
  auto nm = [&](std::size_t w) { return number(panels.wavelengths_nm[w]); };
  lines.push_back(red == blue ? nm(red) + " nm"
                              : "red " + nm(red) + "  green " + nm(green) + "  blue " +
                                    nm(blue) + " nm");
  return lines;
}

/// A ramp from black to white with the values at its decades.
void draw_key(float most, int x, int y, int width, Canvas& canvas) {
  for (int i = 0; i < width; ++i) {
    unsigned char grey = level(std::pow(10, decades * (1.0 * i / (width - 1) - 1)));
    canvas.fill(x + i, y, 1, line, {grey, grey, grey});
  }
  for (int d = 0; d <= decades; d += 2) {
    std::string label = number(most * std::pow(10, d - decades));
    int room = width - text_width(label);
    canvas.write(label, x + static_cast<int>(room * d / decades), y + line + 3);
  }
}

}  // namespace

void append_wavelengths(const Panels& more, Panels& panels) {
  panels.wavelengths_nm.insert(panels.wavelengths_nm.end(), more.wavelengths_nm.begin(),
                               more.wavelengths_nm.end());
  panels.values.insert(panels.values.end(), more.values.begin(), more.values.end());
}

Frame picture_of(const Panels& panels) {
  const std::vector<std::string> lines = captions(panels);
  Page page(panels);
  page.top = gap + static_cast<int>(lines.size() + 1) * line;
  int key_width = 320, widest = key_width + page.left;
  for (const std::string& text : lines) widest = std::max(widest, gap + text_width(text));
  int key_y = page.y(page.rows.size()) + line;
  auto canvas = std::make_shared<Canvas>(std::max(widest, page.x(page.columns.size())) + gap,
                                         key_y + 2 * line + gap);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    canvas->write(lines[i], gap, gap + static_cast<int>(i) * line);
  }
  float most = brightest(panels);
  for (std::size_t r = 0; r < page.rows.size(); ++r) {
    for (std::size_t c = 0; c < page.columns.size(); ++c) {
      draw_panel(panels, page, r, c, most, *canvas);
    }
  }
  label_panels(panels, page, *canvas);
  draw_key(most, page.left, key_y, key_width, *canvas);
  Frame frame;
  frame.width = canvas->width;
  frame.height = canvas->height;
  frame.rgbx = canvas->rgbx.data();
  frame.storage = canvas;
  return frame;
}

}  // namespace cyanometer
