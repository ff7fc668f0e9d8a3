// cyanometer health: a probe for containers.
#include <httplib.h>

#include <iostream>
#include <memory>

#include "server/commands/command.h"

namespace cyanometer {
namespace {

void probe(const std::string& url) {
  const auto path_start =
      url.find('/', url.find("://") == std::string::npos ? 0 : url.find("://") + 3);
  httplib::Client client(url.substr(0, path_start));
  if (!client.is_valid()) throw CommandError(exit_refused, url + " is not an http address");
  constexpr int patience_s = 5;
  client.set_connection_timeout(patience_s);
  client.set_read_timeout(patience_s);
  const bool has_path = path_start != std::string::npos && path_start + 1 < url.size();
  const auto answer = client.Get(has_path ? url.substr(path_start) : "/readyz");
  if (!answer) throw CommandError(exit_failed, url + ": " + httplib::to_string(answer.error()));
  std::cout << answer->status << " " << answer->body;
  if (answer->status != 200) throw CommandError(exit_failed, url + " is not well");
}

}  // namespace

void add_health(CLI::App& app) {
  auto* command = app.add_subcommand("health", "Ask a daemon whether it takes requests");
  const auto url = std::make_shared<std::string>("http://127.0.0.1:8080");
  command->add_option("url", *url, "Its address; without a path /readyz is asked")
      ->capture_default_str();
  command->footer("Example: cyanometer health http://127.0.0.1:8080/healthz");
  command->callback([url] { probe(*url); });
}

}  // namespace cyanometer
