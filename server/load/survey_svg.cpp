// A survey as a picture: a panel for each size and format, a bar for each way to vary.
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/accuracy/svg.h"
#include "server/load/survey_words.h"

namespace cyanometer {
namespace {

constexpr double survey_margin = 20, survey_heading = 92, survey_panel_width = 400,
                 names_width = 104, figures_width = 150, figure_width = 46, bar_pitch = 24,
                 bar_height = 14, panel_top = 36, panel_axis = 34;

constexpr const char* survey_style = R"(.bar { opacity: .8 } .small { font-size: 11px }
.camera { fill: #0072b2 } .sun { fill: #e69f00 } .atmosphere { fill: #56b4e9 }
.everything { fill: #d55e00 } .exposure { fill: #cc79a7 } .nothing { fill: #009e73 }
.clients { stroke: #fff; stroke-width: 1 } .floor { stroke: #222; stroke-width: 3 }
@media (prefers-color-scheme: dark) { .floor { stroke: #eee } .clients { stroke: #16181c } }
)";

double floor_rate(const SurveyPoint& point) {
  return point.floor_ms() > 0 ? 1000 / point.floor_ms() : 0;
}

LogAxis rates_axis(const Survey& survey) {
  double least = 1e30, most = 0;
  for (const SurveyPoint& point : survey.points) {
    for (const double rate : {point.frames_per_s, floor_rate(point)}) {
      if (rate > 0) least = std::min(least, rate), most = std::max(most, rate);
    }
  }
  if (most == 0) least = 1, most = 10;
  return axis_over(least, most, names_width, survey_panel_width - figures_width);
}

/// 1, 10, 100, 1k, 10k.
std::string short_decade(double power) {
  return power < 3 ? decade(power, "") : decade(power - 3, "k");
}

std::string rates_in_words(const std::vector<const SurveyPoint*>& points) {
  std::string words = words_of_way(points.front()->vary);
  for (const SurveyPoint* point : points) {
    words += "\n" + std::to_string(point->clients) +
             (point->clients == 1 ? " client: " : " clients: ") +
             in_three_digits(point->frames_per_s) + " a second, floor " +
             in_three_digits(floor_rate(*point)) + ", p50 " + in_three_digits(point->p50_ms) +
             " ms, p99 " + in_three_digits(point->p99_ms) + " ms";
  }
  return words;
}

class SurveyDrawing {
 public:
  explicit SurveyDrawing(const Survey& survey)
      : survey_(survey),
        ways_(surveyed_ways(survey)),
        sizes_(surveyed_sizes(survey)),
        formats_(surveyed_formats(survey)),
        rate_(rates_axis(survey)),
        svg_(2 * survey_margin +
                 survey_panel_width * std::max<double>(3, static_cast<double>(formats_.size())),
             survey_heading + panel_height() * static_cast<double>(sizes_.size()),
             "Frames a second by size, format and what varies", survey_style) {}

  std::string draw() {
    legend();
    double y = survey_heading;
    for (const FrameSize& size : sizes_) {
      double x = survey_margin;
      for (const std::string& format : formats_) {
        svg_.out() << "<g transform=\"translate(" << x << " " << y << ")\">\n";
        panel(size, format);
        svg_.out() << "</g>\n";
        x += survey_panel_width;
      }
      y += panel_height();
    }
    return svg_.finish();
  }

 private:
  double panel_height() const {
    return panel_top + bar_pitch * static_cast<double>(ways_.size()) + panel_axis;
  }

  void legend() {
    svg_.text(survey_margin, 28, "Frames a second", "title");
    svg_.text(
        survey_margin, 48,
        "By size, format and what varies from frame to frame, with as many clients as make "
        "most; how many times the floor's time a frame takes; and its error, the median of "
        "presets.",
        "faint");
    svg_.text(survey_margin, 64, survey_.device + ", version " + survey_.version + ".",
              "faint");
    svg_.line(survey_margin + 2, 72, survey_margin + 2, 86, "floor");
    svg_.text(survey_margin + 10, 84,
              "the floor: pixels stored, a picture encoded; of identical frames, an answer "
              "without any. Notches: fewer or more clients",
              "small");
  }

  void panel(const FrameSize& size, const std::string& format) {
    svg_.text(names_width, 16, words_of(size) + ", " + format, "name");
    figures({"a second", "floor", "error"}, panel_top - 8, "faint small");
    const double bottom = panel_top + bar_pitch * static_cast<double>(ways_.size());
    for (double power = rate_.first; power <= rate_.last; ++power) {
      const double x = rate_(std::pow(10, power));
      svg_.line(x, panel_top - 6, x, bottom, "grid");
      svg_.text(x, bottom + 14, short_decade(power), "faint small", "middle");
    }
    double y = panel_top;
    for (const std::string& vary : ways_) {
      if (const auto points = points_of(survey_, size, format, vary); !points.empty()) {
        bar(points, y);
      }
      y += bar_pitch;
    }
  }

  void bar(const std::vector<const SurveyPoint*>& points, double y) {
    const SurveyPoint& best = best_of(points);
    svg_.out() << "<g><title>" << escaped(rates_in_words(points)) << "</title>\n";
    svg_.text(names_width - 6, y + 11, words_of_way(best.vary), "small", "end");
    if (best.frames_per_s > 0) {
      svg_.out() << "<rect class=\"bar " << best.vary << "\" x=\"" << rate_.from << "\" y=\""
                 << y << "\" width=\"" << rate_(best.frames_per_s) - rate_.from
                 << "\" height=\"" << bar_height << "\"/>\n";
    }
    for (const SurveyPoint* point : points) {
      const double x = rate_(point->frames_per_s);
      if (point != &best) svg_.line(x, y + 3, x, y + bar_height - 3, "clients");
    }
    const double floor = rate_(floor_rate(best));
    svg_.line(floor, y - 2, floor, y + bar_height + 2, "floor");
    figures({in_three_digits(best.frames_per_s), in_three_digits(best.over_floor()) + " x",
             measured_error(survey_, {best.width, best.height}, best.vary)},
            y + 11, "small");
    svg_.out() << "</g>\n";
  }

  /// Side by side, right of the bars.
  void figures(const std::array<std::string, 3>& words, double y, const char* style_class) {
    double x = survey_panel_width - figures_width + figure_width;
    for (const std::string& each : words) {
      svg_.text(x, y, each, style_class, "end");
      x += figure_width;
    }
  }

  const Survey& survey_;
  std::vector<std::string> ways_;
  std::vector<FrameSize> sizes_;
  std::vector<std::string> formats_;
  LogAxis rate_;
  Svg svg_;
};

}  // namespace

std::string survey_svg(const Survey& survey) { return SurveyDrawing(survey).draw(); }

}  // namespace cyanometer
