#include "server/http/accept.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "server/http/problem.h"

namespace cyanometer {
namespace {

struct MediaRange {
  std::string type;  ///< "image/png", "image/*", "*/*"
  double quality = 1;
};

std::string compact_lower(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == ' ' || c == '\t') continue;
    out += c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c;
  }
  return out;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> out;
  for (std::size_t start = 0; start <= text.size();) {
    const auto end = std::min(text.find(separator, start), text.size());
    out.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  return out;
}

std::vector<MediaRange> parse(std::string_view accept) {
  std::vector<MediaRange> out;
  for (const auto& element : split(compact_lower(accept), ',')) {
    const auto parts = split(element, ';');
    if (parts[0].empty()) continue;
    MediaRange range{parts[0]};
    for (const auto& parameter : parts) {
      if (parameter.starts_with("q=")) {
        range.quality = std::clamp(std::strtod(parameter.c_str() + 2, nullptr), 0.0, 1.0);
      }
    }
    out.push_back(range);
  }
  return out;
}

/// 2 for the type itself, 1 for its family, 0 for anything, -1 for no match.
int specificity(const std::string& range, std::string_view type) {
  if (range == type) return 2;
  if (range == std::string(type.substr(0, type.find('/'))) + "/*") return 1;
  return range == "*/*" ? 0 : -1;
}

double quality_of(std::string_view type, const std::vector<MediaRange>& ranges) {
  int closest = -1;
  double quality = 0;
  for (const auto& range : ranges) {
    const int how = specificity(range.type, type);
    if (how > closest) {
      closest = how;
      quality = range.quality;
    }
  }
  return quality;
}

}  // namespace

std::optional<std::size_t> preferred(std::string_view accept,
                                     const std::vector<std::string_view>& types) {
  const auto ranges = parse(accept);
  std::optional<std::size_t> best;
  double best_quality = 0;
  for (std::size_t i = 0; i < types.size(); ++i) {
    const double quality = quality_of(types[i], ranges);
    if (quality > best_quality) {
      best_quality = quality;
      best = i;
    }
  }
  return best;
}

std::size_t negotiated(const std::string& accept, const std::vector<std::string_view>& types) {
  if (accept.empty()) return 0;
  if (const auto best = preferred(accept, types)) return *best;
  HttpProblem problem(406, "None of the media types that Accept names can be made here.");
  problem.given = accept;
  for (const auto type : types)
    problem.allowed += (problem.allowed.empty() ? "" : ", ") + std::string(type);
  throw problem;
}

}  // namespace cyanometer
