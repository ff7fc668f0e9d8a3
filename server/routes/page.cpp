// GET /: the page, out of the binary alone.
#include "server/routes/page.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/embedded.h"
#include "server/http/problem.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/route.h"

namespace cyanometer {
namespace {

using nlohmann::json;

std::string_view media_type(std::string_view path) {
  static const std::map<std::string_view, std::string_view> types{
      {"html", "text/html; charset=utf-8"},
      {"css", "text/css; charset=utf-8"},
      {"js", "text/javascript; charset=utf-8"},
      {"json", "application/json"},
      {"svg", "image/svg+xml"},
      {"png", "image/png"},
      {"ico", "image/vnd.microsoft.icon"},
      {"webmanifest", "application/manifest+json"},
      {"txt", "text/plain; charset=utf-8"},
      {"woff2", "font/woff2"}};
  const auto found = types.find(path.substr(path.rfind('.') + 1));
  return found == types.end() ? "application/octet-stream" : found->second;
}

const EmbeddedFile* find(std::string_view path) {
  const std::string_view name = path == "/" ? "index.html" : path.substr(1);
  const auto found = std::ranges::find(web_files(), name, &EmbeddedFile::path);
  return found == web_files().end() ? nullptr : &*found;
}

/// The page runs its own modules, talks to its own server, and shows what it made (blob:).
constexpr std::string_view policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A picture that is opened by itself has its style within.
constexpr std::string_view policy_of_pictures =
    "default-src 'none'; style-src 'unsafe-inline'; frame-ancestors 'none'";

Answer file(const Request& request, Service&) {
  const EmbeddedFile* found = find(request.path);
  if (found == nullptr) throw HttpProblem(404, "This build has no page.");
  const std::string type(media_type(found->path));
  Answer answer;
  answer.headers = {{"Content-Type", type},
                    {"Cache-Control", "no-cache"},
                    {"Content-Security-Policy",
                     std::string(type == "image/svg+xml" ? policy_of_pictures : policy)},
                    {"Cross-Origin-Opener-Policy", "same-origin"},
                    {"Referrer-Policy", "no-referrer"}};
  answer.body = found->bytes;
  return with_tag(answer, request, entity_tag({found->bytes}));
}

}  // namespace

bool is_page_file(std::string_view path) { return path.starts_with('/') && find(path); }

Route page() {
  return {"GET", "/", "The page",
          [] {
            const json content{{"text/html", {{"schema", {{"type", "string"}}}}}};
            return json{{"responses", openapi::responses(content, {})}};
          },
          file};
}

}  // namespace cyanometer
