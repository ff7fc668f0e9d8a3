#include "engine/accuracy/svg.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace cyanometer {
namespace {

/// Colours of Okabe and Ito (2008), which people see apart whose eyes lack a cone.
constexpr const char* usual_style = R"(
text { font: 12px system-ui, sans-serif; fill: #222 }
.title { font-size: 17px; font-weight: 600 } .name { font-weight: 600 } .faint { fill: #666 }
.paper { fill: #fff } .grid { stroke: #ddd; stroke-width: 1 }
.nishita { color: #56b4e9 } .raymarch { color: #0072b2 } .hillaire { color: #e69f00 }
.bruneton { color: #009e73 } .moments { color: #d55e00 } .path { color: #cc79a7 }
.auto { color: #444 } .mark { fill: currentColor; stroke: none }
@media (prefers-color-scheme: dark) {
  text { fill: #ddd } .faint { fill: #999 } .paper { fill: #16181c } .grid { stroke: #333 }
  .auto { color: #bbb }
}
)";

}  // namespace

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

double LogAxis::operator()(double value) const {
  double power = std::clamp(std::log10(std::max(value, 1e-30)), first, last);
  return from + (power - first) / (last - first) * (to - from);
}

LogAxis axis_over(double least, double most, double from, double to) {
  LogAxis axis{std::floor(std::log10(least)), std::ceil(std::log10(most)), from, to};
  if (axis.last <= axis.first) axis.last = axis.first + 1;
  return axis;
}

std::string decade(double power, const char* unit) {
  std::ostringstream words;
  words << std::pow(10, power) << unit;
  return words.str();
}

Svg::Svg(double width, double height, const std::string& title, const std::string& style) {
  out_ << "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " << width << " " << height
       << "\" role=\"img\" aria-label=\"" << escaped(title) << "\">\n<style>" << usual_style
       << style << "</style>\n<rect class=\"paper\" width=\"" << width << "\" height=\""
       << height << "\"/>\n";
}

void Svg::text(double x, double y, const std::string& words, const char* style_class,
               const char* anchor) {
  out_ << "<text x=\"" << x << "\" y=\"" << y << "\" class=\"" << style_class
       << "\" text-anchor=\"" << anchor << "\">" << escaped(words) << "</text>\n";
}

void Svg::line(double x1, double y1, double x2, double y2, const char* style_class) {
  out_ << "<line x1=\"" << x1 << "\" y1=\"" << y1 << "\" x2=\"" << x2 << "\" y2=\"" << y2
       << "\" class=\"" << style_class << "\"/>\n";
}

void Svg::mark(const std::string& method, double x, double y, double scale) {
  static const std::map<std::string, const char*> shapes{
      {"nishita", "M-4-4h8v8h-8z"},
      {"raymarch", "M0-5L4.6 3.5H-4.6z"},
      {"hillaire", "M0-5.3L5.3 0 0 5.3-5.3 0z"},
      {"bruneton", "M-4.6-3.5H4.6L0 5z"},
      {"path", "M-5-1.6h3.4V-5h3.2v3.4H5v3.2H1.6V5h-3.2V1.6H-5z"}};
  auto shape = shapes.find(method);
  if (shape == shapes.end()) {
    out_ << "<circle class=\"mark\" cx=\"" << x << "\" cy=\"" << y << "\" r=\"" << 4.5 * scale
         << "\"/>";
    return;
  }
  out_ << "<path class=\"mark\" transform=\"translate(" << x << " " << y << ") scale(" << scale
       << ")\" d=\"" << shape->second << "\"/>";
}

std::string Svg::finish() {
  out_ << "</svg>\n";
  return out_.str();
}

}  // namespace cyanometer
