// Answers that are JSON, and the ETags of those that do not change.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace cyanometer {

Answer json_answer(const nlohmann::json& value);

/// A strong entity tag over the parts: FNV-1a with 128 bits, in quotes. Parts cannot run
/// together.
std::string entity_tag(std::initializer_list<std::string_view> parts);

/// Whether If-None-Match names the tag (RFC 9110, section 13.1.2).
bool matches(const Request& request, std::string_view tag);

/// The answer with its tag, or 304 where the client has it already.
Answer with_tag(Answer answer, const Request& request, const std::string& tag);

}  // namespace cyanometer
