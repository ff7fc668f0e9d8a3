// A request and its answer as values; the routes know nothing else of HTTP.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cyanometer {

using Fields = std::vector<std::pair<std::string, std::string>>;

struct Request {
  std::string method;  ///< as sent; any token
  std::string path;    ///< decoded, without the query
  Fields query;        ///< decoded, in the order given
  Fields headers;      ///< names in lower case
  std::string body;
  std::string id;    ///< safe to echo and to log
  std::string peer;  ///< the client's address: that of who connects, or whom a proxy names
  /// True once the client has closed the connection; may be called from any thread.
  std::function<bool()> gone = [] { return false; };

  /// The header's value; several of that name joined by ", " as in RFC 9110; empty where
  /// absent.
  std::string header(std::string_view lower_case_name) const;
};

/// Takes the next bytes of a stream; false when the client does not.
using Write = std::function<bool(std::string_view)>;

struct Answer {
  int status = 200;
  Fields headers = {};
  std::string body = {};
  std::shared_ptr<const std::string> shared_body = {};  ///< instead of `body`, where not null
  std::shared_ptr<void> held = {};                      ///< until the answer is sent
  /// Instead of both: writes the body while it is made, until the connection's end. It must not
  /// throw.
  std::function<void(const Write&)> stream = {};
  /// False for the answer to a HEAD whose body's length only rendering would tell.
  bool length_known = true;

  std::string_view content() const { return shared_body ? *shared_body : body; }
};

/// The head of a request, from its first line to the empty line.
struct Head {
  std::string method;
  std::string target;
  int minor_version = 1;  ///< of HTTP/1.x
  Fields headers;
};

/// Strict RFC 9112: CRLF line ends, token names, no folding, no control characters, one Host.
/// @throws HttpProblem 400, 505
Head parse_head(std::string_view bytes);

/// What follows the head, and what must become of the connection.
struct Framing {
  std::size_t body_bytes = 0;
  bool close = false;            ///< after the answer
  bool expect_continue = false;  ///< the client waits for 100 before it sends the body
};

/// Refuses every framing that two parsers could read differently.
/// @throws HttpProblem 400, 411, 413, 415, 417
Framing frame_body(const Head& head, std::size_t most_body_bytes);

/// Path and query out of the head's target, headers and a safe id; the body is not read yet.
/// @throws HttpProblem 400 where an escape is not one
Request make_request(const Head& head);

/// Whether the answer's body is to be sent.
bool has_body(const Answer& answer, bool head_only);

/// Status line and headers, with the empty line that ends them.
std::string serialise_head(const Answer& answer, bool close);

}  // namespace cyanometer
