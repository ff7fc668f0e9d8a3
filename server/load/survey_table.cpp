// A survey as a document.
#include <algorithm>
#include <sstream>

#include "server/load/survey_words.h"

namespace cyanometer {
namespace {

constexpr const char* what_is_measured = R"(
Clients ask one after another, each as soon as it has its answer, over one connection each on this same machine, whose
processors they share with the daemon. What varies goes to and fro as in an animation, some 120 frames each way, and no two frames
are equal, but where they are identical: those were kept. Plans and tables that a frame needs anew are made on the way.

The **floor** of a frame is measured just before its frames a second: the time of a pass of the device that only stores its pixels
(four bytes each where they are displayed, four of each channel where not), and the time that encoding a rendered frame of the scene
takes; one after the other. Several clients may come under the floor, for one's frame is
encoded while the device has another's. Identical frames need neither: their floor is the time from one answer of `/healthz` to the next, with as many
clients. **Over the floor** is the time from one frame to the next divided by that.
)";

constexpr const char* what_errors_are = R"(
Of each way to vary, one frame, two thirds of the way to its far end, asked for as it was timed, as EXR, and held against the converged
solution by `/v1/compare`. **Stated** is what the frame says: a bound that is to hold in 95 % of frames. Where two sizes get the same
method and options the smaller was measured for both. Formats do not change a method. Where the noise of the reference hides an error,
"<" stands before the most that it may be.
)";

constexpr const char* glance_head = R"(
## At a glance

Frames a second with as many clients as make most of them, how far over the floor, and the error, the median of presets.

| size | |)";

constexpr const char* shape_head = R"(
| | clients | frames a second | floor ms | over the floor | p50 ms | p99 ms | CPU ms a frame, daemon | who asks | error, stated | measured | |
|---|---|---|---|---|---|---|---|---|---|---|---|
)";

constexpr const char* error_class_head = R"(
| size | | frames | largest stated | median | worst | of |
|---|---|---|---|---|---|---|
)";

constexpr const char* error_head = R"(
| preset | | size | stated | measured | 95 % | method |
|---|---|---|---|---|---|---|
)";

std::string glance(const std::vector<const SurveyPoint*>& points) {
  if (points.empty()) return "";
  const SurveyPoint& best = best_of(points);
  return in_three_digits(best.frames_per_s) + " (" + in_three_digits(best.over_floor()) + " x)";
}

void write_glance(std::ostream& out, const Survey& survey) {
  const auto formats = surveyed_formats(survey);
  std::string rule = "|---|---|---|";
  out << glance_head;
  for (const std::string& format : formats) {
    out << " " << format << " |";
    rule += "---|";
  }
  out << " error |\n" << rule << "\n";
  for (const FrameSize& size : surveyed_sizes(survey)) {
    for (const std::string& vary : surveyed_ways(survey)) {
      out << "| " << words_of(size) << " | " << words_of_way(vary) << " |";
      for (const std::string& format : formats) {
        out << " " << glance(points_of(survey, size, format, vary)) << " |";
      }
      out << " " << measured_error(survey, size, vary) << " |\n";
    }
  }
}

void write_point(std::ostream& out, const Survey& survey, const SurveyPoint& point) {
  out << "| " << words_of_way(point.vary) << " | " << point.clients << " | "
      << in_three_digits(point.frames_per_s) << " | " << in_three_digits(point.floor_ms())
      << " | " << in_three_digits(point.over_floor()) << " | " << in_three_digits(point.p50_ms)
      << " | " << in_three_digits(point.p99_ms) << " | " << in_three_digits(1000 * point.cpu_s)
      << " | " << in_three_digits(1000 * point.generator_cpu_s) << " | "
      << in_percent(point.stated_error) << " | "
      << measured_error(survey, {point.width, point.height}, point.vary) << " | ";
  if (point.failed > 0) out << point.failed << " failed ";
  if (point.truncated > 0) out << point.truncated << " truncated ";
  out << "|\n";
}

void write_shape(std::ostream& out, const Survey& survey, const FrameSize& size,
                 const std::string& format) {
  out << "\n### " << words_of(size) << ", " << format << "\n" << shape_head;
  for (const std::string& vary : surveyed_ways(survey)) {
    for (const SurveyPoint* point : points_of(survey, size, format, vary)) {
      write_point(out, survey, *point);
    }
  }
}

std::string shown(const SurveyError& error) {
  return error.preset.empty() ? "the scene" : error.preset;
}

/// Class by class over all presets.
void write_error_classes(std::ostream& out, const Survey& survey) {
  out << error_class_head;
  for (const FrameSize& size : surveyed_sizes(survey)) {
    for (const std::string& vary : surveyed_ways(survey)) {
      const auto errors = errors_of(survey, size, vary);
      if (errors.empty()) continue;
      const auto stated = (*std::ranges::max_element(errors, {}, &SurveyError::stated))->stated;
      out << "| " << words_of(size) << " | " << words_of_way(vary) << " | " << errors.size()
          << " | " << in_percent(stated) << " | " << measured_error(survey, size, vary) << " | "
          << told_in_words(*errors.back()) << " | " << shown(*errors.back()) << " |\n";
    }
  }
}

void write_errors(std::ostream& out, const Survey& survey) {
  if (survey.errors.empty()) return;
  out << "\n## Errors\n" << what_errors_are;
  write_error_classes(out, survey);
  out << error_head;
  for (const SurveyError& error : survey.errors) {
    out << "| " << shown(error) << " | " << words_of_way(error.vary) << " | "
        << words_of({error.width, error.height}) << " | " << in_percent(error.stated) << " | "
        << told_in_words(error) << " | " << in_percent(error.low) << " to "
        << in_percent(error.high) << " | " << error.method << " |\n";
  }
}

}  // namespace

std::string survey_table(const Survey& survey, const SurveySettings& settings) {
  std::ostringstream out;
  out << "# Frames a second\n\n"
      << survey.device << ", version " << survey.version << ", "
      << in_three_digits(settings.seconds) << " s of each, of the scene `"
      << settings.scene.dump() << "`.\n\n![Frames a second](report.svg)\n"
      << what_is_measured;
  write_glance(out, survey);
  write_errors(out, survey);
  out << "\n## All that was measured\n";
  for (const FrameSize& size : surveyed_sizes(survey)) {
    for (const std::string& format : surveyed_formats(survey)) {
      write_shape(out, survey, size, format);
    }
  }
  return out.str();
}

}  // namespace cyanometer
