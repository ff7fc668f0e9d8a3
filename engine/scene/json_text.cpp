// Bytes to JSON, strictly: no duplicate keys, bounded depth and size, finite numbers.
#include "engine/scene/reading.h"

namespace cyanometer {
namespace {

constexpr std::size_t deepest_level = 32;

/// The parser quotes bytes that may be no UTF-8.
std::string printable(std::string text) {
  for (char& c : text)
    if (c < 0x20 || c > 0x7e) c = '?';
  return text;
}

/// Builds the document while it is parsed, so that nothing deeper than allowed is ever made.
class Builder {
 public:
  Json take() { return std::move(root_); }

  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(std::int64_t value) { return add(value); }
  bool number_unsigned(std::uint64_t value) { return add(value); }
  bool number_float(double value, const std::string&) { return add(value); }
  bool string(std::string& value) { return add(std::move(value)); }
  bool binary(Json::binary_t&) { return false; }  // never in text

  bool start_object(std::size_t) { return open(Json::object()); }
  bool start_array(std::size_t) { return open(Json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool key(std::string& name) {
    if (open_.back()->contains(name))
      throw SceneError(pointer_to(pointer(), name), "", "given once",
                       pointer_to(pointer(), name) + " is given twice.");
    key_ = name;
    return true;
  }
  bool parse_error(std::size_t position, const std::string& token,
                   const Json::exception& problem) {
    if (dynamic_cast<const Json::out_of_range*>(&problem))
      throw SceneError("", printable(token.substr(0, 80)), "finite numbers",
                       "The number that ends at byte " + std::to_string(position) +
                           " is too large to be finite.");
    throw SceneError("", "", "JSON in UTF-8",
                     "The document is not JSON: " + printable(problem.what()) + ".");
  }

 private:
  Json* place(Json&& value) {
    if (open_.empty()) return &(root_ = std::move(value));
    if (open_.back()->is_array()) return &open_.back()->emplace_back(std::move(value));
    return &((*open_.back())[key_] = std::move(value));
  }
  bool add(Json&& value) { return place(std::move(value)), true; }
  bool open(Json&& value) {
    if (open_.size() == deepest_level)
      throw SceneError("", "", "at most " + std::to_string(deepest_level) + " levels deep",
                       "The document is nested more than " + std::to_string(deepest_level) +
                           " levels deep.");
    if (!open_.empty())
      keys_.push_back(open_.back()->is_array() ? std::to_string(open_.back()->size()) : key_);
    open_.push_back(place(std::move(value)));
    return true;
  }
  bool close() {
    open_.pop_back();
    if (!keys_.empty()) keys_.pop_back();
    return true;
  }
  std::string pointer() const {
    std::string result;
    for (std::size_t i = 0; i + 1 < open_.size(); ++i) result = pointer_to(result, keys_[i]);
    return result;
  }

  Json root_;
  std::vector<Json*> open_;        ///< from the root down; stable, as only the last one grows
  std::vector<std::string> keys_;  ///< of all open ones but the root, in their parents
  std::string key_;                ///< of the next value, where it goes into an object
};

}  // namespace

Json parse_json(std::string_view bytes) {
  if (bytes.size() > most_json_bytes)
    throw SceneError("", "", "at most " + std::to_string(most_json_bytes) + " bytes",
                     "The document has " + std::to_string(bytes.size()) + " bytes, more than " +
                         std::to_string(most_json_bytes) + ".");
  Builder builder;
  Json::sax_parse(bytes, &builder);
  return builder.take();
}

}  // namespace cyanometer
