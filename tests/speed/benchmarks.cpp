// Device times of frames by method, pixel by pixel and interpolated, beside that of a pass that
// only stores pixels; of tables; of encoders; and of whole requests.
#include <benchmark/benchmark.h>
#include <httplib.h>
#include <unistd.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "engine/engine.h"
#include "engine/image/encode.h"
#include "engine/scene/document.h"
#include "server/load/own_daemon.h"

namespace cyanometer {
namespace {

using nlohmann::json;

Engine& engine() {
  static Engine one;
  return one;
}

struct Size {
  int width, height;
};
const std::map<std::string, Size> sizes{
    {"360p", {640, 360}}, {"720p", {1280, 720}}, {"1080p", {1920, 1080}}};

Scene scene_of(json document, const Size& size, const std::string& format) {
  document["image"].update(
      {{"width", size.width}, {"height", size.height}, {"format", format}});
  return read_scene(document);
}

Plan default_plan(const std::string& method, double interpolation) {
  Plan plan;
  plan.method = method;
  for (const MethodDescription& each : methods()) {
    if (each.name != method) continue;
    for (const MethodOption& option : each.options)
      plan.options[option.name] = option.default_value;
  }
  plan.options["interpolation"] = interpolation;
  plan.wavelengths_nm = {680, 550, 440};
  return plan;
}

/// A frame whose tables are there, turned a little from one to the next.
void frame(benchmark::State& state, const std::string& method, const std::string& preset,
           const Size& size, double interpolation) {
  const Plan plan = default_plan(method, interpolation);
  double heading_deg = 0, sum_ms = 0;
  auto next = [&] {
    json document{{"preset", preset}, {"camera", {{"heading_deg", heading_deg += 0.01}}}};
    return engine().render(scene_of(document, size, "png"), plan);
  };
  next();
  for (auto _ : state) {
    const double ms = next().render_ms;
    state.SetIterationTime(ms / 1000);
    sum_ms += ms;
  }
  const double store_ms = engine().store_ms(scene_of({}, size, "png").image);
  state.counters["x_store"] = sum_ms / static_cast<double>(state.iterations()) / store_ms;
}

void store(benchmark::State& state, const Size& size, const std::string& format) {
  const Image image = scene_of({}, size, format).image;
  for (auto _ : state) state.SetIterationTime(engine().store_ms(image) / 1000);
}

void tables(benchmark::State& state, const std::string& method, const std::string& preset) {
  const Plan plan = default_plan(method, 0);
  const Scene scene = scene_of({{"preset", preset}}, {16, 9}, "npy");
  engine().frame_ms(scene, plan);
  for (auto _ : state) {
    engine().forget_tables();
    const double before = engine().tables().making_ms;
    engine().render(scene, plan);
    state.SetIterationTime((engine().tables().making_ms - before) / 1000);
  }
}

void encoder(benchmark::State& state, const Size& size, const std::string& format) {
  const Scene scene = scene_of({{"preset", "earth_low_sun"}}, size, format);
  const Frame frame = engine().render(scene);
  std::size_t bytes = 0;
  for (auto _ : state) bytes = encode(frame, scene).size();
  state.counters["bytes"] = static_cast<double>(bytes);
}

void request(benchmark::State& state, const std::string& vary, const Size& size,
             const std::string& format) {
  static const OwnDaemon daemon({});
  daemon.wait_until_ready({});
  httplib::Client client(daemon.origin());
  client.set_keep_alive(true);
  client.set_tcp_nodelay(true);
  client.set_read_timeout(600);
  double turn = 0;
  auto ask = [&] {
    turn += 0.002;
    json scene{{"image", {{"width", size.width}, {"height", size.height}, {"format", format}}}};
    if (vary == "camera") scene["camera"]["heading_deg"] = turn;
    if (vary == "sun") scene["sun"]["elevation_deg"] = 30 + turn;
    const auto answer = client.Post("/v1/render", scene.dump(), "application/json");
    if (!answer || answer->status != 200) throw std::runtime_error("no frame");
    return answer->body.size();
  };
  std::size_t bytes = ask();
  for (auto _ : state) bytes = ask();
  state.counters["bytes"] = static_cast<double>(bytes);
}

template <class... Arguments>
void add(const std::string& name, void (*run)(benchmark::State&, Arguments...), bool manual,
         std::decay_t<Arguments>... arguments) {
  auto* one = benchmark::RegisterBenchmark(
      name.c_str(), [=](benchmark::State& state) { run(state, arguments...); });
  one->Unit(benchmark::kMillisecond)->MinTime(0.2);
  if (manual) {
    one->UseManualTime();
  } else {
    one->UseRealTime();
  }
}

void add_all() {
  for (const auto& [name, size] : sizes) {
    for (const char* format : {"png", "exr"})
      add("Store/" + std::string(format) + "/" + name, store, true, size, std::string(format));
  }
  for (const char* method : {"nishita", "raymarch", "hillaire", "moments"}) {
    for (const char* preset : {"earth_noon", "earth_twilight", "earth_limb"}) {
      for (double interpolation : {0.0, 0.002}) {
        add(std::string("Frame/") + method + "/" + preset +
                (interpolation > 0 ? "/interpolated" : "/all_rays"),
            frame, true, std::string(method), std::string(preset), sizes.at("720p"),
            interpolation);
      }
    }
  }
  for (const char* method : {"hillaire", "moments"}) {
    for (const char* preset : {"earth_noon", "earth_hazy"})
      add(std::string("Tables/") + method + "/" + preset, tables, true, std::string(method),
          std::string(preset));
  }
  for (const auto& [name, size] : sizes) {
    for (const char* format : {"png", "jpeg", "exr", "hdr", "npy"})
      add("Encode/" + std::string(format) + "/" + name, encoder, false, size,
          std::string(format));
    for (const char* vary : {"nothing", "camera", "sun"}) {
      for (const char* format : {"jpeg", "png"})
        add("Request/" + std::string(vary) + "/" + format + "/" + name, request, false,
            std::string(vary), size, std::string(format));
    }
  }
}

}  // namespace
}  // namespace cyanometer

int main(int argc, char** argv) {
  // A daemon of this same program is the one beside it.
  if (argc > 1 && std::string(argv[1]) == "serve") {
    const auto program = std::filesystem::read_symlink("/proc/self/exe").parent_path();
    execv((program / "cyanometer").c_str(), argv);
    return 1;
  }
  cyanometer::add_all();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
