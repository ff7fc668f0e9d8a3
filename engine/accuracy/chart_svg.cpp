#include "engine/accuracy/chart_svg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

#include "engine/accuracy/svg.h"

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

/// What a logarithmic axis can show of it.
double drawn_error(const ChartScene& scene, const ChartPoint& point) {
  return std::max(told_error(scene, point), 1e-6);
}

/// All scenes share their axes, so that panels can be compared.
std::pair<LogAxis, LogAxis> axes_of(const Chart& chart) {
  double least_ms = 1e30, most_ms = 0, least_error = 1e30, most_error = 0;
  for (const ChartScene& scene : chart.scenes) {
    for (const ChartPoint& point : scene.points) {
      if (!point.failure.empty()) continue;
      least_ms = std::min(least_ms, point.fastest_ms);
      most_ms = std::max({most_ms, point.slowest_ms, point.cost_ms(1)});
      least_error = std::min(least_error, drawn_error(scene, point));
      most_error = std::max(most_error, drawn_error(scene, point));
    }
  }
  if (most_ms == 0) least_ms = least_error = 1e-3, most_ms = most_error = 1;
  return {axis_over(std::max(least_ms, 1e-4), most_ms, left, panel_width - right),
          axis_over(least_error, most_error, panel_height - bottom, top)};
}

constexpr const char* style = R"(.noise { fill: #888; opacity: .18 }
.first { fill: none; stroke: currentColor }
.spread { stroke: currentColor; stroke-width: 1; opacity: .6 }
.tables { stroke: currentColor; stroke-width: .7; stroke-dasharray: 1 3 }
.front { fill: none; stroke: #444; stroke-width: 1.3 } .one { stroke-dasharray: 2 3 }
.ten { stroke-dasharray: 7 4 }
@media (prefers-color-scheme: dark) { .front { stroke: #bbb } }
)";

class Drawing {
 public:
  explicit Drawing(const Chart& chart)
      : chart_(chart),
        columns_(std::clamp<int>(static_cast<int>(chart.scenes.size()), 1, 3)),
        svg_(std::max(columns_ * panel_width, 800.0),
             heading + (static_cast<int>(chart.scenes.size()) + columns_ - 1) / columns_ *
                           panel_height,
             "Speed against accuracy", style) {
    std::tie(x_, y_) = axes_of(chart);
  }

  std::string draw() {
    legend();
    for (std::size_t i = 0; i < chart_.scenes.size(); ++i) {
      int column = static_cast<int>(i) % columns_, row = static_cast<int>(i) / columns_;
      svg_.out() << "<g transform=\"translate(" << column * panel_width << " "
                 << heading + row * panel_height << ")\">\n";
      panel(chart_.scenes[i]);
      svg_.out() << "</g>\n";
    }
    return svg_.finish();
  }

 private:
  void legend() {
    svg_.text(left, 28, "Speed against accuracy", "title");
    svg_.text(left, 48,
              "Error in the frame against the time that it takes, by method and setting. " +
                  chart_.device + ", version " + chart_.version + ".",
              "faint");
    double x = left;
    for (const MethodDescription& method : methods()) {
      svg_.out() << "<g class=\"" << method.name << "\">";
      svg_.mark(method.name, x + 5, 70);
      svg_.out() << "</g>\n";
      svg_.text(x + 15, 74, method.name);
      x += 95;
    }
    x = left;
    for (const Fronts& front : fronts) {
      svg_.out() << "<path class=\"front " << front.style << "\" d=\"M" << x << " 94h28\"/>\n";
      svg_.text(x + 34, 98, front.label);
      x += 34 + 7.0 * static_cast<double>(std::char_traits<char>::length(front.label)) + 16;
    }
    svg_.out() << "<circle class=\"first\" cx=\"" << left + 5 << "\" cy=\"116\" r=\"2.5\"/>\n";
    svg_.text(left + 34, 120, "the first frame, with its tables");
    svg_.out() << "<rect class=\"noise\" x=\"" << left + 260
               << "\" y=\"109\" width=\"22\" height=\"13\"/>\n";
    svg_.text(left + 290, 120, "noise of the reference: what is below it is drawn at its edge");
  }

  void grid() {
    for (double power = x_.first; power <= x_.last; ++power) {
      double x = x_(std::pow(10, power));
      svg_.line(x, y_.from, x, y_.to, "grid");
      svg_.text(x, y_.from + 15, decade(power, ""), "faint", "middle");
    }
    for (double power = y_.first; power <= y_.last; ++power) {
      double y = y_(std::pow(10, power));
      svg_.line(x_.from, y, x_.to, y, "grid");
      svg_.text(x_.from - 5, y + 4, decade(power + 2, " %"), "faint", "end");
    }
    svg_.text((x_.from + x_.to) / 2, y_.from + 31, "ms a frame", "faint", "middle");
  }

  void panel(const ChartScene& scene) {
    svg_.text(left, top - 10, scene.name, "name");
    double noise = y_(scene.noise);
    svg_.out() << "<rect class=\"noise\" x=\"" << x_.from << "\" y=\"" << noise << "\" width=\""
               << x_.to - x_.from << "\" height=\"" << y_.from - noise << "\"/>\n";
    grid();
    for (const Fronts& front : fronts) this->front(scene, front);
    for (const ChartPoint& each : scene.points) {
      if (each.failure.empty()) point(scene, each);
    }
  }

  /// As steps: up to the next point nothing better is to be had.
  void front(const ChartScene& scene, const Fronts& front) {
    std::ostringstream path;
    for (std::size_t i : pareto_front(scene, front.frames)) {
      const ChartPoint& point = scene.points[i];
      double x = x_(point.cost_ms(front.frames)), y = y_(drawn_error(scene, point));
      if (path.tellp() == 0) {
        path << "M" << x << " " << y;
      } else {
        path << "H" << x << "V" << y;
      }
    }
    if (path.tellp() == 0) return;
    svg_.out() << "<path class=\"front " << front.style << "\" d=\"" << path.str() << "\"/>\n";
  }

  void point(const ChartScene& scene, const ChartPoint& point) {
    double x = x_(point.frame_ms), y = y_(drawn_error(scene, point)),
           first = x_(point.cost_ms(1));
    svg_.out() << "<g class=\"" << point.method << "\"><title>" << escaped(in_words(point))
               << "</title>\n";
    svg_.line(x, y_(std::max(point.error.low, 1e-6)), x, y_(std::max(point.error.high, 1e-6)),
              "spread");
    svg_.line(x_(point.fastest_ms), y, x_(point.slowest_ms), y, "spread");
    if (first > x + 1) {
      svg_.line(x, y, first, y, "tables");
      svg_.out() << "<circle class=\"first\" cx=\"" << first << "\" cy=\"" << y
                 << "\" r=\"2.5\"/>\n";
    }
    svg_.mark(point.method, x, y);
    svg_.out() << "</g>\n";
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
  int columns_;
  Svg svg_;
  LogAxis x_, y_;
};

}  // namespace

std::string chart_svg(const Chart& chart) { return Drawing(chart).draw(); }

}  // namespace cyanometer
