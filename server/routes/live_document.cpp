#include "server/routes/live_document.h"

#include <atomic>
#include <chrono>
#include <future>
#include <nlohmann/json.hpp>

#include "server/current_problem.h"
#include "server/http/accept.h"
#include "server/routes/json_answer.h"
#include "server/routes/openapi.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

using nlohmann::json;

json worked_out(const Request& request, Service& service, const Scene& scene,
                const SceneWork& work, const Watch& watch) {
  json document;
  service.queue.run(
      {.client = request.peer, .watch = watch, .work = [&](Engine& engine, const Watch& w) {
         document = work(engine, scene, w);
       }});
  return document;
}

constexpr std::chrono::milliseconds pace{200};  // of lines while it works

/// A document while it is made: the queue's thread works, the connection's own tells how far it
/// is, so that a slow reader never holds the device.
class LiveDocument {
 public:
  LiveDocument(Request request, Service& service, std::string member, Scene scene,
               SceneWork work)
      : request_(std::move(request)),
        member_(std::move(member)),
        scene_(std::move(scene)),
        work_(std::move(work)) {
    document_ = std::async(std::launch::async, [this, &service] {
      Watch watch = service.watch(request_);
      watch.progress = [this](double share) { share_ = share; };
      return worked_out(request_, service, scene_, work_, watch);
    });
  }

  /// Until it works. What hinders it before is answered as everywhere.
  void start() const {
    while (!done() && share_ == 0) continue;
    if (done()) document_.get();
  }

  void send(const Write& write) const {
    const auto line = [&](const json& value) { return write(value.dump() + "\n"); };
    try {
      do {
        if (!line({{"progress", share_.load()}})) return;
      } while (!done());
      line({{"progress", 1}, {member_, document_.get()}});
    } catch (...) {
      line(json::parse(problem_json(current_problem(), request_.id)));
    }
  }

 private:
  bool done() const { return document_.wait_for(pace) == std::future_status::ready; }

  Request request_;
  std::string member_;
  Scene scene_;
  SceneWork work_;
  std::atomic<double> share_ = 0;
  std::shared_future<json> document_;  ///< last: its end is waited for before the rest goes
};

}  // namespace

Answer live_document(const Request& request, Service& service, const std::string& member,
                     SceneWork work) {
  const bool live =
      negotiated(request.header("accept"), {"application/json", "application/x-ndjson"}) == 1;
  service.admission.check(request);
  const auto asked = scene_request(body_document(request));
  check_frame(asked.scene, service.config);
  if (!live) {
    return json_answer(worked_out(request, service, asked.scene, work, service.watch(request)));
  }
  const auto document =
      std::make_shared<LiveDocument>(request, service, member, asked.scene, std::move(work));
  document->start();
  return {.headers = {{"Content-Type", "application/x-ndjson"}, {"Cache-Control", "no-store"}},
          .stream = [document](const Write& write) { document->send(write); }};
}

json live_document_operation(const std::string& member, const json& answer) {
  const json line{{"type", "object"},
                  {"description",
                   "A line while it works; the last has the " + member + ", or is a problem."},
                  {"properties",
                   {{"progress", {{"type", "number"}, {"description", "Share done, 0 to 1."}}},
                    {member, answer}}}};
  json content = openapi::json_content(answer);
  content["application/x-ndjson"] = {{"schema", line}};
  return {{"requestBody", openapi::json_body(openapi::scene_schema_reference())},
          {"responses", openapi::responses(content, {406, 411, 422, 429, 504})}};
}

}  // namespace cyanometer
