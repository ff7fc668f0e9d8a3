// What the pictures of measurements are drawn with.
#pragma once

#include <sstream>
#include <string>

namespace cyanometer {

/// Text between tags or in an attribute.
std::string escaped(const std::string& text);

/// A logarithmic axis over whole decades.
struct LogAxis {
  double first = 0, last = 1;  ///< powers of ten
  double from = 0, to = 1;     ///< px

  /// What lies outside is drawn at the edge.
  double operator()(double value) const;
};
/// Over the decades that hold both values.
LogAxis axis_over(double least, double most, double from, double to);

/// A self-contained SVG, light or dark as its reader's screen is.
class Svg {
 public:
  /// @param title  what it shows, for those who do not see it
  /// @param style  CSS beside the usual classes: title, name, faint, paper, grid, and one a
  /// method, whose colour is `currentColor`
  Svg(double width, double height, const std::string& title, const std::string& style);

  std::ostringstream& out() { return out_; }
  void text(double x, double y, const std::string& words, const char* style_class = "",
            const char* anchor = "start");
  void line(double x1, double y1, double x2, double y2, const char* style_class);
  /// A shape of its own for each method, where colours are not seen.
  void mark(const std::string& method, double x, double y, double scale = 1);
  /// The document, after which nothing is drawn.
  std::string finish();

 private:
  std::ostringstream out_;
};

/// 0.01, 1 %, 100 ms: a power of ten with its unit.
std::string decade(double power, const char* unit);

}  // namespace cyanometer
