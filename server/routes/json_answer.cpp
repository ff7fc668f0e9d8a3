#include "server/routes/json_answer.h"

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace cyanometer {
namespace {

__extension__ using Hash = unsigned __int128;

/// Fowler, Noll and Vo's offset basis and prime for 128 bits (IETF draft-eastlake-fnv, section
/// 5).
constexpr Hash basis = (Hash{0x6c62272e07bb0142} << 64) | 0x62b821756295c58d;
constexpr Hash prime = (Hash{1} << 88) | 0x13b;

Hash fnv1a(std::string_view bytes, Hash hash) {
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * prime;
  return hash;
}

std::string hexadecimal(Hash hash) {
  std::string out;
  for (int shift = 124; shift >= 0; shift -= 4) {
    out += "0123456789abcdef"[static_cast<unsigned>(hash >> shift) & 15];
  }
  return out;
}

}  // namespace

Answer json_answer(const nlohmann::json& value) {
  Answer answer;
  answer.headers = {{"Content-Type", "application/json"}, {"Cache-Control", "no-cache"}};
  answer.body = value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
  return answer;
}

std::string entity_tag(std::initializer_list<std::string_view> parts) {
  Hash hash = basis;
  for (const auto part : parts) {
    hash = fnv1a(std::to_string(part.size()) + ":", hash);
    hash = fnv1a(part, hash);
  }
  return "\"" + hexadecimal(hash) + "\"";
}

bool matches(const Request& request, std::string_view tag) {
  const std::string wanted = request.header("if-none-match");
  if (wanted == "*") return true;
  // Our tags hold no comma and no quote, so finding the quoted text is finding the tag.
  return wanted.find(tag) != std::string::npos;
}

Answer with_tag(Answer answer, const Request& request, const std::string& tag) {
  answer.headers.emplace_back("ETag", tag);
  if (matches(request, tag)) {
    answer.status = 304;
    answer.body.clear();
  }
  return answer;
}

}  // namespace cyanometer
