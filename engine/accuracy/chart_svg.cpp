#include "engine/accuracy/chart_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

namespace cyanometer {
namespace {

constexpr double panel_width = 400, panel_height = 300, left = 52, right = 14, top = 30,
                 bottom = 38, heading = 140;

struct Fronts {
  double frames;
  const char *style, *label;
};
constexpr std::array<Fronts, 3> fronts{{{1, "one", "1 frame an atmosphere"},
                                        {10, "ten", "10 frames"},
                                        {1e9, "many", "many frames"}}};

std::string escaped(const std::string& text) {
  std::string out;
  for (char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

/// A logarithmic axis over whole decades.
struct Axis {
  double first = 0, last = 1;  ///< powers of ten
  double from = 0, to = 1;     ///< px

  double operator()(double value) const {
    double power = std::clamp(std::log10(std::max(value, 1e-30)), first, last);
    return from + (power - first) / (last - first) * (to - from);
  }
};

Axis axis_over(double least, double most, double from, double to) {
  Axis axis{std::floor(std::log10(least)), std::ceil(std::log10(most)), from, to};
  if (axis.last <= axis.first) axis.last = axis.first + 1;
  return axis;
}

/// The value that a point is drawn at: where its error is below what the reference can tell,
/// the upper end of what it may be.
double drawn_error(const ChartPoint& point) {
  return std::max(point.error.measure.error, 1e-6);
}

/// All scenes share their axes, so that panels can be compared.
std::pair<Axis, Axis> axes_of(const Chart& chart) {
  double least_ms = 1e30, most_ms = 0, least_error = 1e30, most_error = 0;
  for (const ChartScene& scene : chart.scenes) {
    for (const ChartPoint& point : scene.points) {
      if (!point.failure.empty()) continue;
      least_ms = std::min(least_ms, point.fastest_ms);
      most_ms = std::max({most_ms, point.slowest_ms, point.cost_ms(1)});
      least_error = std::min(least_error, drawn_error(point));
      most_error = std::max(most_error, drawn_error(point));
    }
  }
  if (most_ms == 0) least_ms = least_error = 1e-3, most_ms = most_error = 1;
  return {axis_over(std::max(least_ms, 1e-4), most_ms, left, panel_width - right),
          axis_over(least_error, most_error, panel_height - bottom, top)};
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart) : chart_(chart) { std::tie(x_, y_) = axes_of(chart); }

  std::string svg() {
    int columns = std::min<int>(3, std::max<int>(1, static_cast<int>(chart_.scenes.size())));
    int rows = (static_cast<int>(chart_.scenes.size()) + columns - 1) / columns;
    double width = std::max(columns * panel_width, 800.0),
           height = heading + rows * panel_height;
    out_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width << " " << height
         << "\" role=\"img\" aria-label=\"Speed against accuracy\">\n";
    style();
    out_ << "<rect class=\"paper\" width=\"" << width << "\" height=\"" << height << "\"/>\n";
    legend();
    for (std::size_t i = 0; i < chart_.scenes.size(); ++i) {
      int column = static_cast<int>(i) % columns, row = static_cast<int>(i) / columns;
      out_ << "<g transform=\"translate(" << column * panel_width << " "
           << heading + row * panel_height << ")\">\n";
      panel(chart_.scenes[i]);
      out_ << "</g>\n";
    }
    out_ << "</svg>\n";
    return out_.str();
  }

 private:
  /// Colours of Okabe and Ito (2008), which people see apart whose eyes lack a cone.
  void style() {
    out_ << R"(<style>
text { font: 12px system-ui, sans-serif; fill: #222 }
.title { font-size: 17px; font-weight: 600 } .name { font-weight: 600 } .faint { fill: #666 }
.paper { fill: #fff } .grid { stroke: #ddd; stroke-width: 1 } .noise { fill: #888; opacity: .18 }
.nishita { color: #56b4e9 } .raymarch { color: #0072b2 } .hillaire { color: #e69f00 }
.bruneton { color: #009e73 } .moments { color: #d55e00 } .path { color: #cc79a7 }
.mark { fill: currentColor; stroke: none } .first { fill: none; stroke: currentColor }
.spread { stroke: currentColor; stroke-width: 1; opacity: .6 }
.tables { stroke: currentColor; stroke-width: .7; stroke-dasharray: 1 3 }
.front { fill: none; stroke: #444; stroke-width: 1.3 } .one { stroke-dasharray: 2 3 }
.ten { stroke-dasharray: 7 4 }
@media (prefers-color-scheme: dark) {
  text { fill: #ddd } .faint { fill: #999 } .paper { fill: #16181c } .grid { stroke: #333 }
  .front { stroke: #bbb }
}
</style>
)";
  }

  void text(double x, double y, const std::string& words, const char* style_class = "",
            const char* anchor = "start") {
    out_ << "<text x=\"" << x << "\" y=\"" << y << "\" class=\"" << style_class
         << "\" text-anchor=\"" << anchor << "\">" << escaped(words) << "</text>\n";
  }

  void line(double x1, double y1, double x2, double y2, const char* style_class) {
    out_ << "<line x1=\"" << x1 << "\" y1=\"" << y1 << "\" x2=\"" << x2 << "\" y2=\"" << y2
         << "\" class=\"" << style_class << "\"/>\n";
  }

  void legend() {
    text(left, 28, "Speed against accuracy", "title");
    text(left, 48,
         "Error in the frame against the time that it takes, by method and setting. " +
             chart_.device + ", version " + chart_.version + ".",
         "faint");
    double x = left;
    for (const MethodDescription& method : methods()) {
      out_ << "<g class=\"" << method.name << "\">";
      mark(method.name, x + 5, 70);
      out_ << "</g>\n";
      text(x + 15, 74, method.name);
      x += 95;
    }
    x = left;
    for (const Fronts& front : fronts) {
      out_ << "<path class=\"front " << front.style << "\" d=\"M" << x << " 94h28\"/>\n";
      text(x + 34, 98, front.label);
      x += 34 + 7.0 * static_cast<double>(std::char_traits<char>::length(front.label)) + 16;
    }
    out_ << "<circle class=\"first\" cx=\"" << left + 5 << "\" cy=\"116\" r=\"2.5\"/>\n";
    text(left + 34, 120, "the first frame, with its tables");
    out_ << "<rect class=\"noise\" x=\"" << left + 260
         << "\" y=\"109\" width=\"22\" height=\"13\"/>\n";
    text(left + 290, 120, "below the noise of the reference");
  }

  /// A shape of its own for each method, where colours are not seen.
  void mark(const std::string& method, double x, double y) {
    static const std::map<std::string, const char*> shapes{
        {"nishita", "M-4-4h8v8h-8z"},
        {"raymarch", "M0-5L4.6 3.5H-4.6z"},
        {"hillaire", "M0-5.3L5.3 0 0 5.3-5.3 0z"},
        {"bruneton", "M-4.6-3.5H4.6L0 5z"},
        {"path", "M-5-1.6h3.4V-5h3.2v3.4H5v3.2H1.6V5h-3.2V1.6H-5z"}};
    auto shape = shapes.find(method);
    if (shape == shapes.end()) {
      out_ << "<circle class=\"mark\" cx=\"" << x << "\" cy=\"" << y << "\" r=\"4.5\"/>";
    } else {
      out_ << "<path class=\"mark\" transform=\"translate(" << x << " " << y << ")\" d=\""
           << shape->second << "\"/>";
    }
  }

  void grid() {
    for (double power = x_.first; power <= x_.last; ++power) {
      double x = x_(std::pow(10, power));
      line(x, y_.from, x, y_.to, "grid");
      text(x, y_.from + 15, decade(power, ""), "faint", "middle");
    }
    for (double power = y_.first; power <= y_.last; ++power) {
      double y = y_(std::pow(10, power));
      line(x_.from, y, x_.to, y, "grid");
      text(x_.from - 5, y + 4, decade(power + 2, " %"), "faint", "end");
    }
    text((x_.from + x_.to) / 2, y_.from + 31, "ms a frame", "faint", "middle");
  }

  static std::string decade(double power, const char* unit) {
    std::ostringstream words;
    words << std::pow(10, power) << unit;
    return words.str();
  }

  void panel(const ChartScene& scene) {
    text(left, top - 10, scene.name, "name");
    double noise = y_(scene.noise);
    out_ << "<rect class=\"noise\" x=\"" << x_.from << "\" y=\"" << noise << "\" width=\""
         << x_.to - x_.from << "\" height=\"" << y_.from - noise << "\"/>\n";
    grid();
    for (const Fronts& front : fronts) this->front(scene, front);
    for (const ChartPoint& each : scene.points) {
      if (each.failure.empty()) point(each);
    }
  }

  /// As steps: up to the next point nothing better is to be had.
  void front(const ChartScene& scene, const Fronts& front) {
    std::ostringstream path;
    for (std::size_t i : pareto_front(scene.points, front.frames)) {
      const ChartPoint& point = scene.points[i];
      double x = x_(point.cost_ms(front.frames)), y = y_(drawn_error(point));
      if (path.tellp() == 0) {
        path << "M" << x << " " << y;
      } else {
        path << "H" << x << "V" << y;
      }
    }
    if (path.tellp() == 0) return;
    out_ << "<path class=\"front " << front.style << "\" d=\"" << path.str() << "\"/>\n";
  }

  void point(const ChartPoint& point) {
    double x = x_(point.frame_ms), y = y_(drawn_error(point)), first = x_(point.cost_ms(1));
    out_ << "<g class=\"" << point.method << "\"><title>" << escaped(in_words(point))
         << "</title>\n";
    line(x, y_(std::max(point.error.low, 1e-6)), x, y_(std::max(point.error.high, 1e-6)),
         "spread");
    line(x_(point.fastest_ms), y, x_(point.slowest_ms), y, "spread");
    if (first > x + 1) {
      line(x, y, first, y, "tables");
      out_ << "<circle class=\"first\" cx=\"" << first << "\" cy=\"" << y << "\" r=\"2.5\"/>\n";
    }
    mark(point.method, x, y);
    out_ << "</g>\n";
  }

  static std::string in_words(const ChartPoint& point) {
    std::ostringstream words;
    words.precision(3);
    words << point.method << ": error " << 100 * point.error.measure.error << " % ("
          << 100 * point.error.low << " to " << 100 * point.error.high << "), frame "
          << point.frame_ms << " ms, tables " << point.tables_ms << " ms, " << point.tables_mib
          << " MiB";
    for (const auto& [name, value] : point.options) words << "\n" << name << " " << value;
    return words.str();
  }

  const Chart& chart_;
  Axis x_, y_;
  std::ostringstream out_;
};

}  // namespace

std::string chart_svg(const Chart& chart) { return Drawing(chart).svg(); }

}  // namespace cyanometer
