#include "server/load/survey_words.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

namespace cyanometer {
namespace {

struct Way {
  const char *vary, *words;
};
constexpr std::array<Way, 6> ways{{{"camera", "camera moves"},
                                   {"sun", "sun moves"},
                                   {"atmosphere", "air changes"},
                                   {"everything", "all of these"},
                                   {"exposure", "exposure changes"},
                                   {"nothing", "identical"}}};

bool any_point(const Survey& survey, auto of) { return std::ranges::any_of(survey.points, of); }

}  // namespace

std::vector<FrameSize> surveyed_sizes(const Survey& survey) {
  std::set<FrameSize> sizes;
  for (const SurveyPoint& point : survey.points) sizes.emplace(point.width, point.height);
  return {sizes.begin(), sizes.end()};
}

std::vector<std::string> surveyed_formats(const Survey& survey) {
  std::vector<std::string> formats{"png", "jpeg", "exr", "hdr", "npy"};
  std::erase_if(formats, [&](const std::string& format) {
    return !any_point(survey, [&](const auto& point) { return point.format == format; });
  });
  return formats;
}

std::vector<std::string> surveyed_ways(const Survey& survey) {
  std::vector<std::string> found;
  for (const Way& way : ways) {
    if (any_point(survey, [&](const auto& point) { return point.vary == way.vary; }))
      found.push_back(way.vary);
  }
  return found;
}

std::vector<const SurveyPoint*> points_of(const Survey& survey, const FrameSize& size,
                                          const std::string& format, const std::string& vary) {
  std::vector<const SurveyPoint*> points;
  for (const SurveyPoint& point : survey.points) {
    if (FrameSize{point.width, point.height} == size && point.format == format &&
        point.vary == vary)
      points.push_back(&point);
  }
  std::ranges::sort(points, {}, &SurveyPoint::clients);
  return points;
}

const SurveyPoint& best_of(const std::vector<const SurveyPoint*>& points) {
  return **std::ranges::max_element(points, {}, &SurveyPoint::frames_per_s);
}

std::vector<const SurveyError*> errors_of(const Survey& survey, const FrameSize& size,
                                          const std::string& vary) {
  std::vector<const SurveyError*> errors;
  for (const SurveyError& error : survey.errors) {
    if (FrameSize{error.width, error.height} == size && error.vary == vary)
      errors.push_back(&error);
  }
  std::ranges::sort(errors, {}, &SurveyError::told);
  return errors;
}

std::string told_in_words(const SurveyError& error) {
  return (error.error > 0 ? "" : "< ") + in_percent(error.told());
}

std::string measured_error(const Survey& survey, const FrameSize& size,
                           const std::string& vary) {
  const auto errors = errors_of(survey, size, vary);
  return errors.empty() ? "" : told_in_words(*errors[errors.size() / 2]);
}

std::string words_of_way(const std::string& vary) {
  return std::ranges::find_if(ways, [&](const Way& way) { return vary == way.vary; })->words;
}

std::string words_of(const FrameSize& size) {
  return std::to_string(size.first) + " x " + std::to_string(size.second);
}

std::string in_three_digits(double value) {
  std::array<char, 32> text;
  const double size = std::fabs(value);
  const int decimals = size < 9.995 ? 2 : size < 99.95 ? 1 : 0;
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

std::string in_percent(double share) {
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%.2g %%", 100 * share);
  return text.data();
}

}  // namespace cyanometer
