// POST /v1/chart: speed against accuracy of every method on a scene, point by point.
#include "engine/accuracy/chart.h"

#include <nlohmann/json.hpp>
#include <set>

#include "engine/scene/document.h"
#include "server/current_problem.h"
#include "server/routes/openapi.h"
#include "server/routes/patience.h"
#include "server/routes/route.h"
#include "server/routes/scene_request.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// Of somebody who waits for it: a few seconds for the reference, and some for all points.
ChartSettings live_settings() {
  ChartSettings settings;
  settings.reference = {.rays = 128, .noise = 0.01, .most_walks = 2048};
  settings.pixels = 320 * 180;
  settings.longest_ms = 1000;
  settings.keep_tables = true;
  return settings;
}

struct Setting {
  std::string method;
  std::map<std::string, double> options;
};

/// The first setting of each method, the second of each, and so on: a picture of all soon.
std::vector<Setting> settings_in_turn() {
  std::vector<Setting> out;
  for (std::size_t round = 0, before = 1; out.size() != before; ++round) {
    before = out.size();
    for (const MethodDescription& method : methods()) {
      const auto settings = chart_settings(method);
      if (round < settings.size()) out.push_back({method.name, settings[round]});
    }
  }
  return out;
}

json line_of(const ChartPoint& point) {
  json line = point_document(point);
  line.erase("tables_mib");  // all that the daemon keeps
  return line;
}

/// A chart while it is sent, on its connection's own thread: a job a point, so that frames of
/// others come in between.
class LiveChart {
 public:
  LiveChart(Request request, Service& service, const Scene& scene)
      : request_(std::move(request)),
        service_(service),
        scene_(charted(scene, settings_.pixels)) {}

  /// What hinders the reference is answered as everywhere.
  void start(const Watch& watch) {
    run(watch, [&](Engine& engine, const Watch& w) {
      reference_ = make_reference(engine, scene_, settings_.reference, {}, w);
    });
  }

  void send(const Write& write) const {
    const auto line = [&](const json& value) { return write(value.dump() + "\n"); };
    try {
      send_points(line);
    } catch (...) {
      line(json::parse(problem_json(current_problem(), request_.id)));
    }
  }

 private:
  template <class Work>
  void run(const Watch& watch, const Work& work) const {
    service_.queue.run({.client = request_.peer, .watch = watch, .work = work});
  }

  void send_points(const std::function<bool(const json&)>& line) const {
    const auto all = settings_in_turn();
    if (!line({{"width", scene_.image.width},
               {"height", scene_.image.height},
               {"wavelengths_nm", scene_.spectrum.wavelengths_nm},
               {"reference_walks", reference_.walks},
               {"reference_noise", reference_.noise},
               {"points", all.size()}})) {
      return;
    }
    std::set<std::string> slow;
    for (const Setting& setting : all) {
      if (slow.contains(setting.method)) continue;
      const ChartPoint point = measure(setting);
      if (point.frame_ms > settings_.longest_ms) slow.insert(setting.method);
      if (!line(line_of(point))) return;
    }
  }

  ChartPoint measure(const Setting& setting) const {
    const Watch watch = service_.watch(request_);
    return patiently(watch, [&] {
      ChartPoint point;
      run(watch, [&](Engine& engine, const Watch& w) {
        point = measure_point(engine, scene_, reference_, setting.method, setting.options,
                              settings_, w);
      });
      return point;
    });
  }

  Request request_;
  Service& service_;
  ChartSettings settings_ = live_settings();
  Scene scene_;
  Reference reference_;
};

Answer chart(const Request& request, Service& service) {
  const Watch watch = service.watch(request);
  service.admission.check(request);
  const auto asked = scene_request(body_document(request));
  check_frame(asked.scene, service.config);
  const auto live = std::make_shared<LiveChart>(request, service, asked.scene);
  live->start(watch);
  return {.headers = {{"Content-Type", "application/x-ndjson"}, {"Cache-Control", "no-store"}},
          .stream = [live](const Write& write) { live->send(write); }};
}

json chart_operation() {
  const json number{{"type", "number"}}, whole{{"type", "integer"}};
  const json list{{"type", "array"}, {"items", number}};
  const json first{
      {"type", "object"},
      {"description", "The first line: what was charted."},
      {"properties",
       {{"width", whole},
        {"height", whole},
        {"wavelengths_nm", list},
        {"reference_walks", whole},
        {"reference_noise", number},
        {"points", {{"type", "integer"}, {"description", "At most so many follow."}}}}}};
  const json point{
      {"type", "object"},
      {"description", "Each other line: a setting of a method."},
      {"properties",
       {{"method", {{"type", "string"}}},
        {"options", {{"type", "object"}, {"additionalProperties", number}}},
        {"error", number},
        {"error_95", list},
        {"bias", number},
        {"p99", number},
        {"max", number},
        {"frame_ms", number},
        {"fastest_ms", number},
        {"slowest_ms", number},
        {"tables_ms",
         {{"type", "number"}, {"description", "Of tables that were not there yet."}}},
        {"failure", {{"type", "string"}}}}}};
  json responses =
      openapi::responses({{"application/x-ndjson", {{"schema", {{"oneOf", {first, point}}}}}}},
                         {411, 422, 429, 504});
  responses["200"]["description"] =
      "Lines of JSON, as the points are measured; a problem ends them. Times are of small "
      "frames "
      "on the device. Closing the connection cancels the work.";
  return {{"requestBody", openapi::json_body(openapi::scene_schema_reference())},
          {"responses", responses}};
}

}  // namespace

Route chart_post() {
  return {"POST", "/v1/chart", "Speed against accuracy of every method on a scene",
          chart_operation, chart};
}

}  // namespace cyanometer
