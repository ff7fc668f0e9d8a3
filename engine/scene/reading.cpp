#include "engine/scene/reading.h"

#include <array>
#include <charconv>
#include <cmath>

namespace cyanometer {
namespace {

constexpr std::size_t longest_quote = 80;

Json canonical_numbers(Json value) {
  if (value.is_number_float()) {
    const double number = value.get<double>();
    return std::isfinite(number) ? canonical_number(number) : Json("not finite");
  }
  if (value.is_structured())
    for (Json& item : value) item = canonical_numbers(item);
  return value;
}

std::string place_in_words(const std::string& pointer) {
  return pointer.empty() ? "The document" : pointer;
}

}  // namespace

std::string quote(const Json& given) {
  // ASCII, so that it may be cut anywhere.
  std::string text =
      canonical_numbers(given).dump(-1, ' ', true, Json::error_handler_t::replace);
  if (text.size() > longest_quote) text = text.substr(0, longest_quote - 3) + "...";
  return text;
}

SceneError::SceneError(std::string pointer_, std::string given_, std::string allowed_,
                       std::string what_is_wrong)
    : std::runtime_error(std::move(what_is_wrong)),
      pointer(std::move(pointer_)),
      given(std::move(given_)),
      allowed(std::move(allowed_)) {}

std::string pointer_to(std::string_view pointer, std::string_view member) {
  std::string result(pointer);
  result += '/';
  for (const char c : member) {
    if (c == '~')
      result += "~0";
    else if (c == '/')
      result += "~1";
    else
      result += c;
  }
  return result;
}

At At::operator/(std::string_view member) const {
  return {reading, pointer_to(pointer, member)};
}
At At::operator/(std::size_t index) const {
  return {reading, pointer + "/" + std::to_string(index)};
}

void refuse(const At& at, const Json& given, const std::string& allowed,
            const std::string& why) {
  const std::string quoted = quote(given);
  throw SceneError(at.pointer, quoted, allowed,
                   place_in_words(at.pointer) + " must be " + allowed + ", not " + quoted +
                       (why.empty() ? "" : ": " + why) + ".");
}

void refuse_missing(const At& at, const std::string& allowed) {
  throw SceneError(at.pointer, "", allowed,
                   place_in_words(at.pointer) + " is missing; it must be " + allowed + ".");
}

std::string in_words(double number) {
  std::array<char, 32> buffer;
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), number).ptr;
  std::string text(buffer.data(), end);
  if (const auto e = text.find('e'); e != std::string::npos) {
    std::string exponent = text.substr(e + 1);
    const bool negative = exponent.front() == '-';
    exponent.erase(0, exponent.find_first_not_of("+-0"));
    text = text.substr(0, e) + (negative ? "e-" : "e") + exponent;
  }
  return text;
}

std::string range_in_words(double minimum, double maximum) {
  return " from " + in_words(minimum) + " to " + in_words(maximum);
}

std::string in_words(const std::vector<std::string>& items, std::string_view last) {
  std::string text;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i > 0) text += i + 1 == items.size() ? std::string(last) : ", ";
    text += items[i];
  }
  return text;
}

Json canonical_number(double number) {
  constexpr double exact_integers = 9007199254740992;  // 2^53
  if (std::abs(number) <= exact_integers && number == std::trunc(number))
    return static_cast<std::int64_t>(number);
  return number;
}

const Json* given_member(const Json& object, std::string_view name) {
  const auto found = object.find(name);
  return found == object.end() || found->is_null() ? nullptr : &*found;
}

}  // namespace cyanometer
