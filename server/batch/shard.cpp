#include "server/batch/shard.h"

#include <charconv>
#include <cstdlib>
#include <optional>
#include <stdexcept>

namespace cyanometer {
namespace {

std::optional<int> number(const std::string& text) {
  int value = 0;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  if (error != std::errc{} || end != last) return std::nullopt;
  return value;
}

std::string index_of_job() {
  const char* index = std::getenv("JOB_COMPLETION_INDEX");
  return index ? index : "";
}

}  // namespace

std::string Shard::suffix() const {
  return count == 1 ? "" : "." + std::to_string(index) + "-of-" + std::to_string(count);
}

Shard read_shard(const std::string& text) {
  const auto slash = text.find('/');
  const bool has_index = slash != 0;
  const std::string first = has_index ? text.substr(0, slash) : index_of_job();
  const auto index = number(first);
  const auto count = slash == std::string::npos ? std::nullopt : number(text.substr(slash + 1));
  if (index && count && *index >= 0 && *index < *count) return {*index, *count};
  throw std::invalid_argument(
      "the shard " + (has_index ? text : first + text) +
      " is none: I/N with whole numbers, 0 <= I < N, or /N with I in JOB_COMPLETION_INDEX");
}

}  // namespace cyanometer
