// Frames a second of every class, each measured just after its floor.
#include <algorithm>
#include <tuple>

#include "engine/scene/document.h"
#include "server/load/floor.h"
#include "server/load/load.h"
#include "server/load/survey.h"

namespace cyanometer {
namespace {

using nlohmann::json;

class RateSurvey {
 public:
  RateSurvey(const SurveyedDaemon& daemon, const SurveySettings& settings, const Watch& watch)
      : settings_(settings), watch_(watch), store_ms_(daemon.store_ms) {
    load_.origin = daemon.origin;
    load_.daemon = daemon.process;
  }

  Floor floor(const SurveyPoint& of) {
    const auto stage = [](const LoadReport& report, const char* name) {
      const auto found = report.stage_ms.find(name);
      return found == report.stage_ms.end() ? 0 : quantile(found->second, 0.5);
    };
    const double stored_ms = store_ms_(read_scene(scene(of)).image);
    const LoadReport encoded = load(scene(of), Variation::exposure, 1);
    load_.get = "/healthz";
    const LoadReport answered = load({}, Variation::nothing, of.clients);
    load_.get.clear();
    return {stored_ms, stage(encoded, "encode"), 1000 / answered.frames_per_s()};
  }

  void measure(SurveyPoint& point) {
    const LoadReport report = load(scene(point), variation_of(point.vary), point.clients);
    const auto frames = static_cast<double>(report.frame_ms.size());
    const auto a_frame = [&](double whole) { return frames > 0 ? whole / frames : 0; };
    point.frames_per_s = report.frames_per_s();
    point.p50_ms = quantile(report.frame_ms, 0.5);
    point.p99_ms = quantile(report.frame_ms, 0.99);
    point.cpu_s = a_frame(report.daemon_cpu_s.value_or(0));
    point.generator_cpu_s = a_frame(report.cpu_s);
    point.stated_error = report.stated_error;
    point.methods = {report.methods.begin(), report.methods.end()};
    point.failed = report.sent() - report.frame_ms.size();
    point.truncated = report.truncated;
  }

 private:
  json scene(const SurveyPoint& of) const {
    const json image{{"width", of.width}, {"height", of.height}, {"format", of.format}};
    return merge(settings_.scene, {{"image", image}});
  }

  /// Of frames that no load before had, after some of one client that make plans, tables and
  /// kernels.
  LoadReport load(json scene, Variation vary, int clients) {
    load_.scene = std::move(scene);
    load_.vary = vary;
    run(1, settings_.seconds / 4);
    return run(clients, settings_.seconds);
  }

  LoadReport run(int clients, double seconds) {
    watch_.check();
    load_.clients = clients;
    load_.seconds = seconds;
    const LoadReport report = run_load(load_);
    load_.first += report.sent();
    return report;
  }

  const SurveySettings& settings_;
  const Watch& watch_;
  const std::function<double(const Image&)>& store_ms_;
  LoadSettings load_;
};

auto shape_of(const SurveyPoint& point) {
  return std::tie(point.clients, point.width, point.height, point.format);
}

}  // namespace

double SurveyPoint::over_floor() const {
  return frames_per_s > 0 && floor_ms() > 0 ? 1000 / frames_per_s / floor_ms() : 0;
}

std::vector<SurveyPoint> missing_points(const SurveySettings& settings, const Survey& survey) {
  std::vector<SurveyPoint> missing;
  for (const int clients : settings.clients) {
    for (const auto& [width, height] : settings.sizes) {
      for (const std::string& format : settings.formats) {
        for (const std::string& vary : settings.vary) {
          missing.push_back({width, height, format, vary, clients});
        }
      }
    }
  }
  std::erase_if(missing, [&](const SurveyPoint& wanted) {
    return std::ranges::any_of(survey.points, [&](const SurveyPoint& known) {
      return shape_of(known) == shape_of(wanted) && known.vary == wanted.vary;
    });
  });
  return missing;
}

void measure_rates(const SurveyedDaemon& daemon, const SurveySettings& settings,
                   const Watch& watch, const std::function<void(const SurveyPoint&)>& done,
                   Survey& survey) {
  RateSurvey rates(daemon, settings, watch);
  SurveyPoint before;
  Floor floor;
  for (SurveyPoint& point : missing_points(settings, survey)) {
    if (shape_of(point) != shape_of(before)) floor = rates.floor(point);
    before = point;
    point.floor = floor;
    rates.measure(point);
    survey.points.push_back(point);
    done(survey.points.back());
  }
}

}  // namespace cyanometer
