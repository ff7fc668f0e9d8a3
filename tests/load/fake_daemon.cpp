// See fake_daemon.h.
#include "tests/load/fake_daemon.h"

namespace cyanometer::testing {

FakeDaemon::FakeDaemon() {
  const auto say = [](const char* text) {
    return [text](const httplib::Request&, httplib::Response& answer) {
      answer.set_content(text, "text/plain");
    };
  };
  server_.set_tcp_nodelay(true);
  server_.set_keep_alive_max_count(1000000);
  server_.Get("/readyz", say("ready"));
  server_.Get("/healthz", say("ok"));
  server_.Get("/metrics", [this](const httplib::Request& request, httplib::Response& answer) {
    if (refused(request, answer)) return;
    const double seconds = 5 + cpu_s_a_frame * static_cast<double>(frames);
    answer.set_content(
        "# HELP process_cpu_seconds_total a word\nother 3\n" +
            (cpu_s_a_frame > 0 ? "process_cpu_seconds_total " + std::to_string(seconds) + "\n"
                               : std::string()),
        "text/plain");
  });
  server_.Post("/v1/render",
               [this](const httplib::Request& request, httplib::Response& answer) {
                 if (!refused(request, answer)) render(request, answer);
               });
  server_.Post("/v1/compare", [this](const httplib::Request&, httplib::Response& answer) {
    ++judged;
    answer.set_content(R"({"error": 0.004, "error_95": [0.003, 0.005]})", "application/json");
  });
  port_ = server_.bind_to_any_port("127.0.0.1");
  thread_ = std::thread([this] { server_.listen_after_bind(); });
}

FakeDaemon::~FakeDaemon() {
  while (!server_.is_running()) std::this_thread::yield();
  server_.stop();
  thread_.join();
}

std::vector<nlohmann::json> FakeDaemon::scenes() const {
  const std::lock_guard lock(mutex_);
  return scenes_;
}

bool FakeDaemon::refused(const httplib::Request& request, httplib::Response& answer) const {
  if (token.empty() || request.get_header_value("Authorization") == "Bearer " + token)
    return false;
  answer.status = 401;
  return true;
}

void FakeDaemon::render(const httplib::Request& request, httplib::Response& answer) {
  const std::size_t number = frames++;
  if (number >= fail_after) {
    answer.status = 503;
    answer.set_header("Retry-After", "1");
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    scenes_.push_back(nlohmann::json::parse(request.body));
  }
  answer.set_header("Cyanometer-Method", "fake");
  answer.set_header("Cyanometer-Options", "grain=3");
  answer.set_header("Cyanometer-Error",
                    std::to_string(error * (1 + 0.01 * static_cast<double>(number))));
  answer.set_header("Cyanometer-Met", number % 2 == 0 ? "true" : "false");
  answer.set_header("Cache-Status", number == 0 ? "cyanometer; hit" : "cyanometer; fwd=miss");
  answer.set_header("Server-Timing",
                    "queue;dur=0.5, prepare;dur=0, render;dur=3, encode;dur=1");
  answer.set_content(number == 1 ? "cut" : "\xff\xd8\xff\xd9", "image/jpeg");
}

}  // namespace cyanometer::testing
