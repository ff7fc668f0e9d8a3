#include "server/routes/reading.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/engine.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// RFC 6901: a name as part of a pointer.
std::string escaped(const std::string& name) {
  std::string out;
  for (const char c : name) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

}  // namespace

[[noreturn]] void refuse(const std::string& pointer, const json& given,
                         const std::string& allowed) {
  std::string text = given.dump(-1, ' ', false, json::error_handler_t::replace);
  if (text.size() > 80) text = text.substr(0, 77) + "...";
  const std::string place = pointer.empty() ? "the document" : pointer;
  throw SceneError(pointer, text, allowed,
                   place + " must be " + allowed + ", not " + text + ".");
}

[[noreturn]] void miss(const std::string& pointer, const std::string& allowed) {
  throw SceneError(pointer, "", allowed, pointer + " is missing: it must be " + allowed + ".");
}

void check_members(const json& object, const std::string& pointer,
                   const std::vector<std::string>& known) {
  std::string allowed;
  for (const auto& name : known) allowed += (allowed.empty() ? "" : ", ") + name;
  if (!object.is_object()) refuse(pointer, object, "an object with " + allowed);
  for (const auto& [name, unused] : object.items()) {
    if (std::ranges::find(known, name) == known.end()) {
      const std::string at = pointer + "/" + escaped(name);
      throw SceneError(at, "", allowed, at + " is not a member; there are " + allowed + ".");
    }
  }
}

void within(const std::string& pointer, const std::function<void()>& read) {
  try {
    read();
  } catch (const SceneError& error) {
    const std::string what = error.what();
    throw SceneError(pointer + error.pointer, error.given, error.allowed,
                     what.starts_with('/') ? pointer + what : what);
  } catch (const OverLimit& limit) {
    throw OverLimit(pointer + limit.pointer, limit.what());
  }
}

}  // namespace cyanometer
