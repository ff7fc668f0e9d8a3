// What the table and the picture of a survey have in common: classes in their order, and words.
#pragma once

#include <string>
#include <vector>

#include "server/load/survey.h"

namespace cyanometer {

using FrameSize = std::pair<int, int>;

/// Those of which there are points, smallest first; formats and ways to vary as they are told.
std::vector<FrameSize> surveyed_sizes(const Survey& survey);
std::vector<std::string> surveyed_formats(const Survey& survey);
std::vector<std::string> surveyed_ways(const Survey& survey);

/// All points of a class, fewest clients first.
std::vector<const SurveyPoint*> points_of(const Survey& survey, const FrameSize& size,
                                          const std::string& format, const std::string& vary);
/// The one with most frames a second. @pre there is one
const SurveyPoint& best_of(const std::vector<const SurveyPoint*>& points);

/// Errors that were measured of frames that vary so, least first.
std::vector<const SurveyError*> errors_of(const Survey& survey, const FrameSize& size,
                                          const std::string& vary);
/// "1.2 %", or "< 1.2 %" where noise hides it.
std::string told_in_words(const SurveyError& error);
/// Their median in words; none where none was measured.
std::string measured_error(const Survey& survey, const FrameSize& size,
                           const std::string& vary);

/// "camera moves".
std::string words_of_way(const std::string& vary);
std::string words_of(const FrameSize& size);
/// 1.23, 12.3, 123, 1230: three digits that count.
std::string in_three_digits(double value);
std::string in_percent(double share);

}  // namespace cyanometer
