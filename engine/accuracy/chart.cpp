#include "engine/accuracy/chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>

#include "engine/accuracy/finest.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// The smallest even shape of the projection's proportions with at least about so many pixels.
void resize(Image& image, Projection projection, int pixels) {
  auto shape = [&](double width_over_height, int least_height) {
    double height = std::sqrt(pixels / width_over_height);
    image.height = std::max(2 * static_cast<int>(std::lround(height / 2)), least_height);
    image.width = static_cast<int>(std::lround(image.height * width_over_height));
  };
  switch (projection) {
    case Projection::fisheye:
      return shape(1, 2);
    case Projection::equirectangular:
      return shape(2, 2);
    case Projection::cubemap:
      image.width = std::max(1, static_cast<int>(std::lround(std::sqrt(pixels / 6.0))));
      image.height = 6 * image.width;
      return;
    case Projection::perspective:
      return shape(static_cast<double>(image.width) / image.height, 2);
  }
}

Plan plan_for(const Scene& scene, const std::string& method,
              const std::map<std::string, double>& options) {
  Plan plan;
  plan.method = method;
  plan.options = options;
  plan.wavelengths_nm = scene.spectrum.wavelengths_nm;
  return plan;
}

/// Once for the pipelines, once with tables to be made, then as often as is worth it.
/// @param made_ms  spent on tables before this point
void measure_time(Engine& engine, const Scene& scene, const Plan& plan,
                  const ChartSettings& settings, double made_ms, const Watch& watch,
                  ChartPoint& point) {
  constexpr int frames = 5;
  Scene timed = scene;
  timed.image.format = ImageFormat::npy;  // without display
  engine.render(timed, plan, watch);
  if (!settings.keep_tables) {
    engine.forget_tables();
    made_ms = engine.tables().making_ms;
  }
  std::vector<double> times;
  do {
    times.push_back(engine.render(timed, plan, watch).render_ms);
  } while (times.size() < frames && times.front() < settings.longest_ms / frames);
  point.tables_ms = engine.tables().making_ms - made_ms;
  point.tables_mib = static_cast<double>(engine.tables().bytes) / (1 << 20);
  std::ranges::sort(times);
  point.frame_ms = times[times.size() / 2];
  point.fastest_ms = times.front();
  point.slowest_ms = times.back();
}

const ChartPoint* find(const ChartScene& scene, const std::string& method,
                       const std::map<std::string, double>& options) {
  auto found = std::ranges::find_if(scene.points, [&](const ChartPoint& point) {
    return point.method == method && point.options == options;
  });
  return found == scene.points.end() ? nullptr : &*found;
}

ChartPoint point_from(const json& document) {
  ChartPoint point;
  point.method = document.at("method");
  point.options = document.at("options");
  point.failure = document.value("failure", "");
  if (!point.failure.empty()) return point;
  ErrorMeasure& measure = point.error.measure;
  measure = {document.at("error"), document.at("bias"), document.at("p99"), document.at("max")};
  point.error.low = document.at("error_95").at(0);
  point.error.high = document.at("error_95").at(1);
  point.frame_ms = document.at("frame_ms");
  point.fastest_ms = document.at("fastest_ms");
  point.slowest_ms = document.at("slowest_ms");
  point.tables_ms = document.at("tables_ms");
  point.tables_mib = document.at("tables_mib");
  return point;
}

std::string quoted(std::string text) {
  for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) {
    text.insert(at, 1, '"');
  }
  return "\"" + text + "\"";
}

/// In the order of the table's columns; of a point that failed none of them says anything.
std::array<double, 11> figures_of(const ChartPoint& point) {
  const EstimatedError& error = point.error;
  const ErrorMeasure& m = error.measure;
  return {m.error,         error.low,      error.high,       m.bias,           m.p99,
          m.max,           point.frame_ms, point.fastest_ms, point.slowest_ms, point.tables_ms,
          point.tables_mib};
}

}  // namespace

json point_document(const ChartPoint& point) {
  const ErrorMeasure& measure = point.error.measure;
  json document{{"method", point.method}, {"options", point.options}};
  if (!point.failure.empty()) {
    document["failure"] = point.failure;
    return document;
  }
  document.update({{"error", measure.error},
                   {"error_95", {point.error.low, point.error.high}},
                   {"bias", measure.bias},
                   {"p99", measure.p99},
                   {"max", measure.max},
                   {"frame_ms", point.frame_ms},
                   {"fastest_ms", point.fastest_ms},
                   {"slowest_ms", point.slowest_ms},
                   {"tables_ms", point.tables_ms},
                   {"tables_mib", point.tables_mib}});
  return document;
}

ChartPoint measure_point(Engine& engine, const Scene& scene, const Reference& reference,
                         const std::string& method,
                         const std::map<std::string, double>& options,
                         const ChartSettings& settings, const Watch& watch) {
  const Plan plan = plan_for(scene, method, options);
  const double made_ms = engine.tables().making_ms;
  const RayColours colours(scene, plan.wavelengths_nm);
  ChartPoint point;
  point.method = method;
  point.options = options;
  try {
    auto values = engine.radiance(scene, reference.directions, false, plan, watch).relative;
    point.error = measure_error(colours.error_channels(values),
                                colours.error_channels(reference.halves[0]),
                                colours.error_channels(reference.halves[1]));
    measure_time(engine, scene, plan, settings, made_ms, watch, point);
  } catch (const OverLimit& limit) {
    point.failure = limit.what();
  }
  if (!settings.keep_tables) engine.forget_tables();
  return point;
}

Scene charted(const Scene& scene, int pixels) {
  Scene result = scene;
  if (scene.spectrum.wavelengths_nm.empty()) {
    result.spectrum = {{680, 550, 440}, Colour::channels};
  }
  resize(result.image, scene.camera.projection, pixels);
  result.method.name = "auto";
  result.method.options.clear();
  return result;
}

std::map<std::string, double> defaults_of(const MethodDescription& method) {
  std::map<std::string, double> defaults;
  for (const MethodOption& option : method.options) {
    defaults[option.name] = option.default_value;
  }
  return defaults;
}

std::vector<std::map<std::string, double>> chart_settings(const MethodDescription& method) {
  // As `auto` makes frames, which charts are to tell apart by more than by that.
  constexpr double interpolation = 0.002;
  std::vector<std::map<std::string, double>> settings = method.ladder;
  std::map<std::string, double> defaults = defaults_of(method);
  if (!method.random) defaults["interpolation"] = interpolation;
  for (const std::map<std::string, double>& change : method.variations) {
    std::map<std::string, double> varied = defaults;
    for (const auto& [name, value] : change) varied.at(name) = value;
    if (std::ranges::find(settings, varied) == settings.end()) settings.push_back(varied);
  }
  if (std::ranges::find(settings, defaults) == settings.end()) {
    settings.insert(settings.begin(), defaults);
  }
  return settings;
}

void measure_points(Engine& engine, const ChartSettings& settings, const Watch& watch,
                    const std::function<void(const ChartPoint&)>& done, ChartScene& chart) {
  Scene scene = read_scene(chart.document);
  if (json goal = goal_document(settings.reference); chart.goal != goal) {
    chart.points.clear();
    chart.goal = std::move(goal);
  }
  std::optional<Reference> reference;
  for (const MethodDescription& method : methods()) {
    if (!settings.methods.empty() &&
        std::ranges::find(settings.methods, method.name) == settings.methods.end()) {
      continue;
    }
    auto all =
        settings.defaults_only ? std::vector{defaults_of(method)} : chart_settings(method);
    for (const auto& options : all) {
      const ChartPoint* known = find(chart, method.name, options);
      if (!known) {
        if (!reference) {
          reference =
              make_reference(engine, scene, settings.reference, settings.references, watch);
          chart.walks = reference->walks;
          chart.noise = reference->noise;
        }
        chart.points.push_back(
            measure_point(engine, scene, *reference, method.name, options, settings, watch));
        known = &chart.points.back();
        done(*known);
      }
      if (known->frame_ms > settings.longest_ms) break;
    }
  }
}

double told_error(const ChartScene& scene, const ChartPoint& point) {
  const double error = point.error.measure.error;
  return std::max(error > 0 ? error : point.error.high, scene.noise);
}

std::vector<std::size_t> pareto_front(const ChartScene& scene, double frames) {
  const std::vector<ChartPoint>& points = scene.points;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].failure.empty()) order.push_back(i);
  }
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return points[i].cost_ms(frames); });
  auto error = [&](std::size_t i) { return told_error(scene, points[i]); };
  std::vector<std::size_t> front;
  for (std::size_t i : order) {
    if (front.empty() || error(i) < error(front.back())) front.push_back(i);
  }
  return front;
}

void take_over(const Chart& before, Chart& chart) {
  if (before.device != chart.device || before.version != chart.version) return;
  std::vector<ChartScene> others;
  for (const ChartScene& old : before.scenes) {
    bool asked = false;
    for (ChartScene& scene : chart.scenes) {
      asked |= scene.name == old.name;
      if (scene.document != old.document) continue;
      const std::string name = scene.name;
      scene = old;
      scene.name = name;
    }
    if (!asked) others.push_back(old);
  }
  chart.scenes.insert(chart.scenes.begin(), others.begin(), others.end());
}

json chart_document(const Chart& chart) {
  json scenes = json::array();
  for (const ChartScene& scene : chart.scenes) {
    json points = json::array();
    for (const ChartPoint& point : scene.points) points.push_back(point_document(point));
    scenes.push_back({{"name", scene.name},
                      {"scene", scene.document},
                      {"reference_walks", scene.walks},
                      {"reference_noise", scene.noise},
                      {"reference_goal", scene.goal},
                      {"points", points}});
  }
  return {{"device", chart.device}, {"version", chart.version}, {"scenes", scenes}};
}

Chart chart_from(const json& document) {
  Chart chart{document.at("device"), document.at("version"), {}};
  for (const json& each : document.at("scenes")) {
    ChartScene scene{each.at("name"),
                     each.at("scene"),
                     each.at("reference_walks"),
                     each.at("reference_noise"),
                     {},
                     each.value("reference_goal", json())};
    for (const json& point : each.at("points")) scene.points.push_back(point_from(point));
    chart.scenes.push_back(std::move(scene));
  }
  return chart;
}

std::string chart_csv(const Chart& chart) {
  std::ostringstream csv;
  csv << "scene,method,options,error,error_low,error_high,bias,p99,max,frame_ms,fastest_ms,"
         "slowest_ms,tables_ms,tables_mib,reference_noise,failure\n";
  for (const ChartScene& scene : chart.scenes) {
    for (const ChartPoint& point : scene.points) {
      csv << quoted(scene.name) << "," << point.method << ","
          << quoted(json(point.options).dump()) << ",";
      for (double figure : figures_of(point)) {
        if (point.failure.empty()) csv << figure;
        csv << ",";
      }
      csv << scene.noise << "," << quoted(point.failure) << "\n";
    }
  }
  return csv.str();
}

}  // namespace cyanometer
