#include "server/http/message.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <ctime>
#include <random>

#include "server/http/problem.h"

namespace cyanometer {
namespace {

bool is_token(std::string_view text) {
  constexpr std::string_view marks = "!#$%&'*+-.^_`|~";
  return !text.empty() && std::ranges::all_of(text, [&](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
           marks.find(c) != std::string_view::npos;
  });
}

bool is_visible(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c > 0x20 && c < 0x7f; });
}

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + ('a' - 'A'));
  }
  return out;
}

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::string decode(std::string_view text, bool plus_is_space) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '+' && plus_is_space) {
      out += ' ';
    } else if (text[i] != '%') {
      out += text[i];
    } else {
      const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
      const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
      if (high < 0 || low < 0) {
        throw HttpProblem(400,
                          "The address holds a '%' that two hexadecimal digits do not follow.");
      }
      out += static_cast<char>(high * 16 + low);
      i += 2;
    }
  }
  return out;
}

Fields decode_query(std::string_view query) {
  Fields out;
  while (!query.empty()) {
    const auto end = std::min(query.find('&'), query.size());
    const auto part = query.substr(0, end);
    query.remove_prefix(std::min(end + 1, query.size()));
    if (part.empty()) continue;
    const auto equals = std::min(part.find('='), part.size());
    const auto value = part.substr(std::min(equals + 1, part.size()));
    out.emplace_back(decode(part.substr(0, equals), true), decode(value, true));
  }
  return out;
}

std::string random_id() {
  thread_local std::mt19937_64 random{std::random_device{}()};
  std::array<char, 16> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), random(), 16).ptr;
  return {digits.data(), end};
}

/// The client's own id where it is harmless; anything else could forge log lines or headers.
std::string safe_id(const std::string& given) {
  const bool safe =
      !given.empty() && given.size() <= 64 && std::ranges::all_of(given, [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
               c == '-' || c == '_';
      });
  return safe ? given : random_id();
}

std::string join(const Fields& headers, std::string_view name) {
  std::string out;
  for (const auto& [key, value] : headers) {
    if (key != name) continue;
    if (!out.empty()) out += ", ";
    out += value;
  }
  return out;
}

std::size_t count(const Fields& headers, std::string_view name) {
  return static_cast<std::size_t>(
      std::ranges::count_if(headers, [&](const auto& field) { return field.first == name; }));
}

void parse_request_line(std::string_view line, Head& head) {
  const auto first = line.find(' ');
  const auto last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) {
    throw HttpProblem(400, "The request line is not 'METHOD target HTTP/1.1'.");
  }
  head.method = line.substr(0, first);
  head.target = line.substr(first + 1, last - first - 1);
  const auto version = line.substr(last + 1);
  if (!is_token(head.method) || head.target.empty() || !is_visible(head.target)) {
    throw HttpProblem(400, "The request line holds characters that do not belong there.");
  }
  if (version != "HTTP/1.1" && version != "HTTP/1.0") {
    if (version.starts_with("HTTP/"))
      throw HttpProblem(505, "HTTP/1.1 and HTTP/1.0 are spoken here.");
    throw HttpProblem(400, "The request line is not 'METHOD target HTTP/1.1'.");
  }
  head.minor_version = version.back() - '0';
}

std::pair<std::string, std::string> parse_field(std::string_view line) {
  const auto colon = line.find(':');
  if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) {
    throw HttpProblem(400, "A header line is not 'Name: value'.");
  }
  const auto value = trim(line.substr(colon + 1));
  for (const char c : value) {
    if ((c >= 0 && c < 0x20 && c != '\t') || c == 0x7f) {
      throw HttpProblem(400, "A header holds a control character.");
    }
  }
  return {lower(line.substr(0, colon)), std::string(value)};
}

std::size_t parse_length(const std::string& text) {
  std::size_t length = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) {
    if (error == std::errc::result_out_of_range)
      throw HttpProblem(413, "The body is too long.");
    throw HttpProblem(400, "Content-Length is not a decimal number.");
  }
  return length;
}

}  // namespace

std::string Request::header(std::string_view lower_case_name) const {
  return join(headers, lower_case_name);
}

Head parse_head(std::string_view bytes) {
  Head head;
  bool first = true;
  while (!bytes.empty()) {
    const auto end = bytes.find("\r\n");
    const auto line = bytes.substr(0, end);
    bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 2);
    if (line.empty()) break;
    if (first) {
      parse_request_line(line, head);
    } else {
      head.headers.push_back(parse_field(line));
    }
    first = false;
  }
  const auto hosts = count(head.headers, "host");
  if (hosts > 1 || (hosts == 0 && head.minor_version == 1)) {
    throw HttpProblem(400, "HTTP/1.1 wants one Host header.");
  }
  return head;
}

Framing frame_body(const Head& head, std::size_t most_body_bytes) {
  Framing framing;
  const auto& headers = head.headers;
  const bool coded = count(headers, "transfer-encoding") > 0;
  const auto lengths = count(headers, "content-length");
  if (lengths > 1 || (coded && lengths > 0)) {
    throw HttpProblem(400, "The body's length is given twice.");
  }
  if (coded) throw HttpProblem(411, "Send the body with a Content-Length, not in chunks.");
  if (lengths == 0 && head.method == "POST") {
    throw HttpProblem(411, "A body needs a Content-Length.");
  }
  const auto length = lengths == 0 ? 0 : parse_length(join(headers, "content-length"));
  if (length > most_body_bytes) {
    throw HttpProblem(413,
                      "The body is longer than " + std::to_string(most_body_bytes) + " bytes.");
  }
  const auto coding = lower(join(headers, "content-encoding"));
  if (!coding.empty() && coding != "identity") {
    throw HttpProblem(415, "A body is read as it is, without Content-Encoding.");
  }
  if (lower(join(headers, "content-type")).starts_with("multipart/")) {
    throw HttpProblem(415, "A body is one JSON document, not multipart.");
  }
  const auto expectation = lower(join(headers, "expect"));
  framing.expect_continue = expectation == "100-continue";
  if (!expectation.empty() && !framing.expect_continue) {
    throw HttpProblem(417, "Expect knows 100-continue alone.");
  }
  // A body that its method gives no meaning is not read: the connection ends with the answer,
  // so that its bytes are never taken for a request.
  framing.body_bytes = head.method == "POST" ? length : 0;
  const auto connection = lower(join(headers, "connection"));
  framing.close =
      (length > 0 && head.method != "POST") || connection.find("close") != std::string::npos ||
      (head.minor_version == 0 && connection.find("keep-alive") == std::string::npos);
  return framing;
}

Request make_request(const Head& head) {
  Request request;
  request.method = head.method;
  request.headers = head.headers;
  request.id = safe_id(join(head.headers, "x-request-id"));
  std::string_view target = head.target;
  if (target.starts_with("http://") || target.starts_with("https://")) {
    target.remove_prefix(std::min(target.find('/', target.find("//") + 2), target.size()));
  }
  target = target.substr(0, target.find('#'));
  const auto question = std::min(target.find('?'), target.size());
  request.path = decode(target.substr(0, question), false);
  if (request.path.empty()) request.path = "/";
  if (question < target.size()) request.query = decode_query(target.substr(question + 1));
  return request;
}

namespace {

bool is_bodyless(int status) { return status == 204 || status == 304; }

/// As "Sun, 06 Nov 1994 08:49:37 GMT" (RFC 9110, section 5.6.7).
std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  const auto size = std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &utc);
  return {text.data(), size};
}

}  // namespace

bool has_body(const Answer& answer, bool head_only) {
  return !head_only && !is_bodyless(answer.status);
}

std::string serialise_head(const Answer& answer, bool close) {
  std::string out = "HTTP/1.1 " + std::to_string(answer.status) + " ";
  out += status_phrase(answer.status);
  out += "\r\nDate: " + date_now() + "\r\n";
  // A proxy such as nginx would gather what is to be read while it is made.
  if (answer.stream) out += "X-Accel-Buffering: no\r\n";
  for (const auto& [name, value] : answer.headers) out += name + ": " + value + "\r\n";
  if (!is_bodyless(answer.status) && answer.length_known && !answer.stream) {
    out += "Content-Length: " + std::to_string(answer.content().size()) + "\r\n";
  }
  out += close ? "Connection: close\r\n\r\n" : "Connection: keep-alive\r\n\r\n";
  return out;
}

}  // namespace cyanometer
