// The findings as a picture.
#include <algorithm>
#include <cmath>

#include "engine/accuracy/svg.h"
#include "engine/stability/figures.h"
#include "engine/stability/report.h"

namespace cyanometer {
namespace {

constexpr double margin = 16, names = 250, cell_width = 118, cell_height = 46, heading = 96,
                 panel_width = 360, panel_height = 250, panel_left = 48, panel_bottom = 36;

constexpr const char* style = R"(.small { font-size: 10px } .strong { font-weight: 600 }
.bound { stroke: #888; stroke-dasharray: 2 2 } .curve { fill: none; stroke: currentColor; stroke-width: 1.4 }
.holds { fill: #009e73; opacity: .16 } .degrades { fill: #e69f00; opacity: .3 }
.breaks { fill: #d55e00; opacity: .55 } .other { fill: #888; opacity: .12 }
)";

/// Points in the order of the row's sweep.
std::vector<const StabilityPoint*> points_of(const StabilityReport& report,
                                             const StabilityRow& row,
                                             const std::string& method) {
  std::vector<const StabilityPoint*> points;
  for (double trigger : row.sweep) {
    for (const StabilityPoint& point : report.points) {
      if (point.row == row.number && point.method == method && point.trigger == trigger &&
          (row.number > 0 || point.note == row.name))
        points.push_back(&point);
    }
  }
  return points;
}

class Drawing {
 public:
  explicit Drawing(const StabilityReport& report)
      : report_(report), svg_(width(), height(), "Where methods fail", style) {}

  std::string draw() {
    svg_.text(margin, 28, "Where methods fail", "title");
    svg_.text(margin, 48,
              "Each cell: the row's quantity over its bound (dashed) along the trigger, from a "
              "hundredth to a hundred times. " +
                  report_.device + ", version " + report_.version + ".",
              "faint");
    double x = margin + names;
    for (const std::string& method : stability_subjects()) {
      svg_.text(x + cell_width / 2, heading - 12, method, "name", "middle");
      x += cell_width;
    }
    double y = heading;
    for (const StabilityRow& row : stability_rows()) {
      line_of(row, y);
      y += cell_height;
    }
    curves(y + 40);
    return svg_.finish();
  }

 private:
  static double width() {
    return 2 * margin + names + cell_width * static_cast<double>(stability_subjects().size());
  }
  static double grid_height() {
    return heading + cell_height * static_cast<double>(stability_rows().size());
  }
  static double height() { return grid_height() + 60 + 2 * panel_height; }

  void line_of(const StabilityRow& row, double y) {
    svg_.line(margin, y, width() - margin, y, "grid");
    svg_.out() << "<g><title>" << escaped(row.quantity + "\nover " + row.trigger)
               << "</title>\n";
    svg_.text(margin, y + 20, std::to_string(row.number) + "  " + row.name, "name");
    svg_.text(margin, y + 36,
              row.bound > 0 ? "at most " + figure(row.bound) : "not finite or negative: none",
              "faint small");
    svg_.out() << "</g>\n";
    double x = margin + names;
    for (const std::string& method : stability_subjects()) {
      cell(row, method, x, y);
      x += cell_width;
    }
  }

  void cell(const StabilityRow& row, const std::string& method, double x, double y) {
    StabilityCell found = cell_of(report_, row.number, method);
    if (found.points == 0) return;
    bool judged = found.outcome == Outcome::holds || found.outcome == Outcome::degrades ||
                  found.outcome == Outcome::breaks;
    const bool hidden = found.outcome == Outcome::holds && found.noise > 0;
    svg_.out() << "<g class=\"" << method << "\"><title>"
               << escaped(method + ", " + row.name + ": " + cell_words(found) +
                          (found.note.empty() ? "" : "\n" + found.note))
               << "</title>\n<rect class=\""
               << (judged && !hidden ? name_of(found.outcome) : "other") << "\" x=\"" << x + 2
               << "\" y=\"" << y + 2 << "\" width=\"" << cell_width - 4 << "\" height=\""
               << cell_height - 4 << "\" rx=\"3\"/>\n";
    svg_.text(x + 7, y + 14, cell_words(found), found.failed > 0 ? "small strong" : "small");
    if (judged && row.bound > 0) spark(row, method, x + 8, y + 18);
    svg_.out() << "</g>\n";
  }

  void spark(const StabilityRow& row, const std::string& method, double x, double y) {
    constexpr double wide = cell_width - 16, high = cell_height - 24;
    LogAxis over{-2, 2, y + high, y};
    svg_.line(x, over(1), x + wide, over(1), "bound");
    std::string path;
    double count = static_cast<double>(row.sweep.size());
    for (std::size_t i = 0; const StabilityPoint* point : points_of(report_, row, method)) {
      double px = x + wide * (count > 1 ? static_cast<double>(i) / (count - 1) : 0.5);
      ++i;
      if (point->outcome != Outcome::holds && point->outcome != Outcome::degrades) continue;
      if (tells_nothing(*point)) continue;
      double py = over(point->value / row.bound);
      path += (path.empty() ? "M" : "L") + number(px) + " " + number(py);
      svg_.out() << "<circle class=\"mark\" cx=\"" << px << "\" cy=\"" << py
                 << "\" r=\"1.8\"/>\n";
    }
    if (!path.empty()) svg_.out() << "<path class=\"curve\" d=\"" << path << "\"/>\n";
  }

  void curves(double y) {
    svg_.text(margin, y, "Errors along one quantity of the scene", "title");
    double x = margin + 400;
    for (const std::string& method : stability_subjects()) {
      svg_.out() << "<g class=\"" << method << "\">";
      svg_.mark(method, x, y - 4, 0.8);
      svg_.out() << "</g>\n";
      svg_.text(x + 9, y, method);
      x += 82;
    }
    for (std::size_t i = 0; i < stability_curves().size(); ++i) {
      svg_.out() << "<g transform=\"translate("
                 << margin + static_cast<double>(i % 3) * panel_width << " "
                 << y + 14 + static_cast<double>(i / 3) * panel_height << ")\">\n";
      panel(stability_curves()[i]);
      svg_.out() << "</g>\n";
    }
  }

  /// The sweep's values evenly spaced: they are few, and not all of them positive.
  void panel(const StabilityRow& curve) {
    LogAxis error{-4, 0, panel_height - panel_bottom, 14};
    double right = panel_width - 24;
    for (double power = error.first; power <= error.last; ++power) {
      double y = error(std::pow(10, power));
      svg_.line(panel_left, y, right, y, "grid");
      svg_.text(panel_left - 5, y + 4, decade(power + 2, " %"), "faint", "end");
    }
    double count = static_cast<double>(curve.sweep.size());
    auto at = [&](std::size_t i) {
      return panel_left + 8 + (right - panel_left - 16) * static_cast<double>(i) / (count - 1);
    };
    for (std::size_t i = 0; i < curve.sweep.size(); ++i)
      svg_.text(at(i), error.from + 14, number(curve.sweep[i]), "faint small", "middle");
    svg_.text((panel_left + right) / 2, error.from + 30, curve.trigger, "faint", "middle");
    for (const std::string& method : stability_subjects()) {
      std::string path;
      svg_.out() << "<g class=\"" << method << "\">";
      for (const StabilityPoint* point : points_of(report_, curve, method)) {
        if (point->outcome != Outcome::holds) continue;
        auto place = std::ranges::find(curve.sweep, point->trigger) - curve.sweep.begin();
        double x = at(static_cast<std::size_t>(place)), y = error(point->value);
        path += (path.empty() ? "M" : "L") + number(x) + " " + number(y);
        svg_.mark(method, x, y, 0.7);
      }
      if (!path.empty()) svg_.out() << "<path class=\"curve\" d=\"" << path << "\"/>";
      svg_.out() << "</g>\n";
    }
  }

  const StabilityReport& report_;
  Svg svg_;
};

}  // namespace

std::string stability_svg(const StabilityReport& report) { return Drawing(report).draw(); }

}  // namespace cyanometer
