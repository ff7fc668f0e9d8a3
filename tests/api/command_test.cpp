// The program as its users run it.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <thread>

#include "server/config.h"
#include "tests/api/client.h"
#include "tests/api/program.h"
#include "tests/composite/picture_file.h"

namespace cyanometer::testing {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
namespace fs = std::filesystem;

TEST(Command, EveryCommandHelpsWithAnExample) {
  for (const auto* name :
       {"serve", "render", "radiance", "plan", "devices", "health", "contact-sheet", "schema",
        "bench", "chart", "audit", "profile", "load", "load-report", "compare", "composite",
        "explain", "tables", "stability"}) {
    Program run({name, "--help"});
    EXPECT_EQ(run.wait(), 0) << name;
    EXPECT_THAT(run.out(), ::testing::HasSubstr("Example: ")) << name;
  }
}

TEST(Command, HelpListsWhatThereIsToChooseFrom) {
  for (const auto& [name, choice] :
       std::vector<std::pair<std::string, std::string>>{{"bench", "hillaire"},
                                                        {"chart", "hillaire"},
                                                        {"chart", "titan"},
                                                        {"tables", "titan"},
                                                        {"load", "atmosphere"},
                                                        {"load-report", "titan"},
                                                        {"composite", "cd/m^2"}}) {
    Program run({name, "--help"});
    EXPECT_EQ(run.wait(), 0) << name;
    EXPECT_THAT(run.out(), ::testing::HasSubstr(choice)) << name;
  }
  Program unknown({"bench", "--method", "guessing"});
  EXPECT_EQ(unknown.wait(), 2);
}

TEST(Command, AnUnknownOneIsRefused) {
  Program run({"paint"});
  EXPECT_EQ(run.wait(), 2);
  EXPECT_FALSE(run.err().empty());
  EXPECT_TRUE(run.out().empty());
}

TEST(Command, RenderTakesItsFormatFromTheExtension) {
  TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> kinds{{"png", "\x89PNG"},
                                                               {"exr", "\x76\x2f\x31\x01"},
                                                               {"npy", "\x93NUMPY"},
                                                               {"jpg", "\xff\xd8"}};
  for (const auto& [extension, magic] : kinds) {
    const auto file = folder / ("sky." + extension);
    Program run({"render", "-", "-o", file}, tiny_scene().dump());
    EXPECT_EQ(run.wait(), 0) << run.err();
    EXPECT_TRUE(read_file(file).starts_with(magic)) << extension;
  }
}

TEST(Command, RenderRefusesAnExtensionThatContradictsTheScene) {
  TemporaryFolder folder;
  auto scene = small_scene();
  scene["image"]["format"] = "exr";
  Program run({"render", "-", "-o", folder / "sky.png"}, scene.dump());
  EXPECT_EQ(run.wait(), 2);
  EXPECT_THAT(run.err(), ::testing::HasSubstr("exr"));
  EXPECT_FALSE(fs::exists(folder / "sky.png"));
}

TEST(Command, RenderRefusesASceneByName) {
  Program run({"render", "-", "-o", "-"}, R"({"planet":{"radius_km":-1}})");
  EXPECT_EQ(run.wait(), 2);
  EXPECT_THAT(run.err(), ::testing::HasSubstr("/planet/radius_km"));
  EXPECT_TRUE(run.out().empty());
}

TEST(Command, RenderRefusesWhatIsNoScene) {
  TemporaryFolder folder;
  for (const auto& [text, said] : std::vector<std::pair<std::string, std::string>>{
           {"[1,2]", "must be an object"}, {R"({"image":5})", "/image"}}) {
    Program run({"render", "-", "-o", folder / "sky.exr"}, text);
    EXPECT_EQ(run.wait(), 2) << text;
    EXPECT_THAT(run.err(), ::testing::HasSubstr(said)) << text;
    EXPECT_FALSE(fs::exists(folder / "sky.exr")) << text;
  }
}

TEST(Command, CompareTakesScenesAndPictures) {
  TemporaryFolder folder;
  auto scene = small_scene();
  scene["spectrum"] = {{"wavelengths_nm", {680, 550, 440}}};
  scene["method"] = {{"scattering_orders", 1}};
  std::ofstream(folder / "b.json") << scene.dump();
  Program same({"compare", "-", folder / "b.json", "-o", folder / "error.png"}, scene.dump());
  EXPECT_EQ(same.wait(), 0) << same.err();
  EXPECT_EQ(json::parse(same.out()).at("error"), 0);
  EXPECT_TRUE(read_file(folder / "error.png").starts_with("\x89PNG"));
  Program render({"render", folder / "b.json", "-o", folder / "a.exr"});
  EXPECT_EQ(render.wait(), 0) << render.err();
  Program judged({"compare", folder / "a.exr", folder / "b.json"});
  EXPECT_EQ(judged.wait(), 0) << judged.err();
  EXPECT_LT(json::parse(judged.out()).at("error"), 0.02);
  Program larger({"compare", folder / "a.exr", "-"}, "{}");
  EXPECT_EQ(larger.wait(), 2);
  EXPECT_THAT(larger.err(), ::testing::HasSubstr("16 x 8"));
}

TEST(Command, CompositeTakesItsSizeFromThePicture) {
  TemporaryFolder folder;
  std::ofstream(folder / "card.exr") << even_picture(16, 8, 0.5f, 2);
  const std::string scene =
      R"({"method":{"name":"raymarch"},"spectrum":{"wavelengths_nm":[680,550,440]}})";
  Program run({"composite", folder / "card.exr", "-", "--scale", "2", "-o", folder / "out.png"},
              scene);
  EXPECT_EQ(run.wait(), 0) << run.err();
  EXPECT_TRUE(read_file(folder / "out.png").starts_with("\x89PNG"));
  Program larger({"composite", folder / "card.exr", "-", "-o", "-"},
                 R"({"image":{"width":17}})");
  EXPECT_EQ(larger.wait(), 2);
  EXPECT_THAT(larger.err(), ::testing::HasSubstr("/image/width"));
  std::ofstream(folder / "bad.exr") << "no picture";
  Program bad({"composite", folder / "bad.exr", "-", "-o", "-"}, scene);
  EXPECT_EQ(bad.wait(), 2);
  EXPECT_THAT(bad.err(), ::testing::HasSubstr("bad.exr: This is no OpenEXR file."));
}

TEST(Command, ExplainPrintsATableOrTheDocument) {
  const std::string scene =
      R"({"method":{"scattering_orders":1},"spectrum":{"wavelengths_nm":[680,550,440]}})";
  Program table({"explain", "-"}, scene);
  EXPECT_EQ(table.wait(), 0) << table.err();
  EXPECT_THAT(table.out(), ::testing::HasSubstr("CIEDE2000"));
  EXPECT_LT(table.out().find("air"), table.out().find("ozone"));
  Program document({"explain", "-", "--json"}, scene);
  EXPECT_EQ(document.wait(), 0) << document.err();
  EXPECT_TRUE(json::parse(document.out()).contains("curvature"));
}

TEST(Command, AttributePrintsATableOrTheDocument) {
  const std::string scene =
      R"({"method":{"name":"nishita","scattering_orders":1,"view_samples":8},
          "spectrum":{"wavelengths_nm":[680,550,440]}})";
  Program table({"attribute", "-", "--rays", "16"}, scene);
  EXPECT_EQ(table.wait(), 0) << table.err();
  EXPECT_THAT(table.out(), ::testing::HasSubstr("view_samples 8 to 32"));
  Program document({"attribute", "-", "--rays", "16", "--json"}, scene);
  EXPECT_EQ(document.wait(), 0) << document.err();
  EXPECT_EQ(json::parse(document.out()).at("shares").at(0).at("cause"), "quadrature");
}

/// A scene of small tables of `bruneton`.
json small_tables() {
  const json method{{"name", "bruneton"}, {"altitudes", 4},       {"zeniths", 6},
                    {"suns", 8},          {"source_azimuths", 3}, {"source_zeniths", 5},
                    {"samples", 6},       {"orders", 2}};
  return {{"method", method}, {"sun", {{"elevation_deg", 5}}}};
}

TEST(Command, TablesWritesAPictureOfEachAndSaysWhatItIs) {
  TemporaryFolder folder;
  Program run({"tables", "-", "-o", folder / "tables"}, small_tables().dump());
  EXPECT_EQ(run.wait(), 0) << run.err();
  for (const std::string name : {"source", "irradiance", "view"}) {
    const std::string file = folder / "tables" / (name + ".png");
    EXPECT_TRUE(read_file(file).starts_with("\x89PNG")) << file;
    EXPECT_THAT(run.out(), ::testing::HasSubstr(file + ": " + name));
  }
  EXPECT_EQ(std::ranges::count(run.out(), '\n'), 3);
}

TEST(Command, TablesRefusesASceneThatHasNone) {
  TemporaryFolder folder;
  auto scene = small_tables();
  scene["method"]["scattering_orders"] = 1;
  Program none({"tables", "-", "-o", folder / "none"}, scene.dump());
  EXPECT_EQ(none.wait(), 2);
  EXPECT_THAT(none.err(), ::testing::HasSubstr("first_order"));
  Program two({"tables", "-", "--preset", "mars", "-o", folder / "none"}, "{}");
  EXPECT_EQ(two.wait(), 2);
  Program unknown({"tables", "--preset", "nowhere", "-o", folder / "none"});
  EXPECT_EQ(unknown.wait(), 2);
  EXPECT_FALSE(fs::exists(folder / "none"));
}

TEST(Command, ChartWritesItsThreeFilesAndGoesOnWhereItWas) {
  TemporaryFolder folder;
  const std::vector<std::string> arguments{"chart",        "-",
                                           "--method",     "raymarch",
                                           "--rays",       "16",
                                           "--pixels",     "64",
                                           "--references", folder / "references",
                                           "-o",           folder / "chart"};
  const std::string scene = R"({"method":{"scattering_orders":1}})";
  Program run(arguments, scene);
  EXPECT_EQ(run.wait(), 0) << run.err();
  EXPECT_THAT(run.err(), ::testing::HasSubstr("raymarch"));
  const std::string document = read_file(folder / "chart" / "chart.json");
  EXPECT_THAT(read_file(folder / "chart" / "chart.svg"), ::testing::StartsWith("<svg"));
  EXPECT_THAT(read_file(folder / "chart" / "chart.csv"), ::testing::StartsWith("scene,"));
  Program again(arguments, scene);
  EXPECT_EQ(again.wait(), 0) << again.err();
  EXPECT_TRUE(again.err().empty()) << again.err();
  EXPECT_EQ(read_file(folder / "chart" / "chart.json"), document);
}

TEST(Command, StabilityRefusesToTryAutoOnRandomScenes) {
  TemporaryFolder folder;
  Program run({"stability", "--random", "1", "--method", "auto", "-o", folder / "failures"});
  EXPECT_EQ(run.wait(), 2);
  EXPECT_THAT(run.err(), ::testing::HasSubstr("--method auto"));
  EXPECT_FALSE(fs::exists(folder / "failures"));
}

TEST(Command, RenderGivesWhatTheServerGives) {
  Program run({"render", "-", "-o", "-"}, small_scene().dump());
  EXPECT_EQ(run.wait(), 0) << run.err();
  EXPECT_EQ(run.out(),
            client().Post("/v1/render", small_scene().dump(), "application/json")->body);
}

TEST(Interrupted, ARenderEndsAtSigint) {
  Program run({"render", "-", "-o", "-"}, long_scene().dump());
  std::this_thread::sleep_for(1500ms);
  const auto start = std::chrono::steady_clock::now();
  run.signal(SIGINT);
  EXPECT_EQ(run.wait(), 130) << run.err();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 2s);
}

TEST(Command, AFileThatIsNotThereIsAFailure) {
  Program run({"render", "/nowhere.json", "-o", "sky.png"});
  EXPECT_EQ(run.wait(), 1);
  EXPECT_THAT(run.err(), ::testing::HasSubstr("/nowhere.json"));
}

TEST(Command, AFullDiskIsAFailure) {
  TemporaryFolder folder;
  fs::create_symlink("/dev/full", folder / "sky.png");
  Program run({"render", "-", "-o", folder / "sky.png"}, tiny_scene().dump());
  EXPECT_EQ(run.wait(), 1);
  EXPECT_THAT(run.err(), ::testing::HasSubstr("sky.png"));
}

TEST(Command, PlanRadianceAndSchemaAnswerAsTheRoutesDo) {
  Program plan({"plan", "-"}, small_scene().dump());
  EXPECT_EQ(plan.wait(), 0) << plan.err();
  EXPECT_EQ(json::parse(plan.out()),
            json_of(client().Post("/v1/plan", small_scene().dump(), "application/json")));
  const std::string directions =
      R"({"directions":[{"elevation_deg":45,"azimuth_deg":10}],"scene":{}})";
  Program radiance({"radiance", "-"}, directions);
  EXPECT_EQ(radiance.wait(), 0) << radiance.err();
  EXPECT_EQ(json::parse(radiance.out()),
            json_of(client().Post("/v1/radiance", directions, "application/json")));
  Program schema({"schema"});
  EXPECT_EQ(schema.wait(), 0);
  EXPECT_EQ(json::parse(schema.out()), json_of(client().Get("/v1/schema")));
}

TEST(Command, TheContactSheetIsOnePictureAsWideAsAsked) {
  TemporaryFolder folder;
  const auto file = folder / "sheet.png";
  Program run({"contact-sheet", "-o", file, "--width", "200", "--columns", "2", "--preset",
               "earth", "--preset", "earth_noon", "--preset", "airless_moon"});
  EXPECT_EQ(run.wait(), 0) << run.err();
  const auto png = read_file(file);
  ASSERT_GT(png.size(), 24u);
  // The header chunk begins with width and height, four bytes each, highest first.
  EXPECT_EQ(png.substr(12, 8), std::string("IHDR\0\0\0\xc8", 8));
}

TEST(Command, DevicesMarksTheOneThatWouldBeUsed) {
  Program run({"devices"});
  EXPECT_EQ(run.wait(), 0) << run.err();
  EXPECT_THAT(run.out(), ::testing::HasSubstr("\n*"));
  Program none({"devices", "--device", "no such device"});
  EXPECT_EQ(none.wait(), 1);
}

TEST(Command, LoadAsksForFramesThatNoOtherRunLeftAndOfAnyFormat) {
  TemporaryFolder folder;
  json scene = tiny_scene();
  scene["image"]["format"] = "jpeg";
  std::ofstream(folder / "scene.json") << scene.dump();
  const auto kept = [] { return shared_daemon().service().frames.counts().kept; };
  const std::string url = "http://127.0.0.1:" + std::to_string(shared_daemon().port());
  const auto before = kept();
  for (int i = 0; i < 2; ++i) {
    Program run({"load", url, "--clients", "1", "--seconds", "0.5", "--from", "127.0.0.2",
                 "--scene", folder / "scene.json", "--json"});
    ASSERT_EQ(run.wait(), 0) << run.err();
    const json report = json::parse(run.out());
    EXPECT_GE(report.at("statuses").value("200", 0), 1) << report;
    EXPECT_GT(report.at("asked_per_s"), 0);
    EXPECT_EQ(report.at("truncated"), 0);
  }
  EXPECT_EQ(kept(), before);
}

TEST(Command, LoadVariesWhatItIsTold) {
  TemporaryFolder folder;
  std::ofstream(folder / "scene.json") << tiny_scene().dump();
  const std::string url = "http://127.0.0.1:" + std::to_string(shared_daemon().port());
  for (const std::string vary : {"sun", "nothing"}) {
    Program run({"load", url, "--clients", "1", "--seconds", "0.3", "--scene",
                 folder / "scene.json", "--vary", vary, "--size", "16x9", "--format", "exr",
                 "--json"});
    ASSERT_EQ(run.wait(), 0) << run.err();
    const json report = json::parse(run.out());
    const auto frames = report.at("statuses").value("200", std::size_t{0});
    EXPECT_GE(frames, 2u) << report;
    EXPECT_EQ(report.at("truncated"), 0);
    EXPECT_EQ(report.at("kept").get<std::size_t>() + 1 >= frames, vary == "nothing") << report;
    EXPECT_GT(report.at("stated_error"), 0);
    EXPECT_TRUE(report.at("stage_ms").contains("render"));
  }
  Program refused({"load", url, "--vary", "moods"});
  EXPECT_EQ(refused.wait(), 2);
  Program unsized({"load", url, "--size", "16"});
  EXPECT_EQ(unsized.wait(), 2);
  EXPECT_THAT(unsized.err(), ::testing::HasSubstr("1280x720"));
}

std::vector<std::string> tiny_load_report(const TemporaryFolder& folder) {
  return {"load-report", "-o",     folder / "report", "--scene",     folder / "scene.json",
          "--clients",   "2",      "--size",          "16x9",        "--format",
          "exr",         "--vary", "camera",          "--vary",      "nothing",
          "--seconds",   "0.1",    "--preset",        "airless_moon"};
}

/// By a daemon of its own, whatever settings the environment has for others.
TEST(Command, LoadReportMeasuresEachClassOnceAndItsError) {
  TemporaryFolder folder;
  std::ofstream(folder / "scene.json") << tiny_scene().dump();
  setenv("CYANOMETER_TOKEN", "secret", 1);
  Program run(tiny_load_report(folder));
  const int ended = run.wait();
  unsetenv("CYANOMETER_TOKEN");
  ASSERT_EQ(ended, 0) << run.err();
  const std::string lines = read_file(folder / "report" / "points.jsonl");
  EXPECT_EQ(count(lines, "{\"by\":{"), 6u) << lines;
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    const json found = json::parse(line);
    if (found.contains("error")) {
      EXPECT_LT(found.at("error").at("error"), 0.03) << line;
    } else {
      EXPECT_GT(found.at("point").at("frames_per_s"), 0) << line;
      EXPECT_GT(found.at("point").at("cpu_s"), 0) << line;
      EXPECT_GT(found.at("point").at("floor").at("store_ms"), 0) << line;
      EXPECT_GT(found.at("point").at("floor").at("encode_ms"), 0) << line;
      EXPECT_EQ(found.at("point").at("failed"), 0) << line;
    }
  }
  EXPECT_THAT(read_file(folder / "report" / "report.md"), ::testing::HasSubstr("airless_moon"));
  EXPECT_THAT(read_file(folder / "report" / "report.svg"), ::testing::StartsWith("<svg"));
  Program again(tiny_load_report(folder));
  EXPECT_EQ(again.wait(), 0) << again.err();
  EXPECT_TRUE(again.err().empty()) << again.err();
  EXPECT_EQ(read_file(folder / "report" / "points.jsonl"), lines);
}

TEST(Command, LoadReportWritesWhatItHasWhenItsTimeIsOver) {
  TemporaryFolder folder;
  std::ofstream(folder / "scene.json") << tiny_scene().dump();
  auto arguments = tiny_load_report(folder);
  arguments.insert(arguments.end(), {"--minutes", "0.0001"});
  Program run(arguments);
  EXPECT_EQ(run.wait(), 0) << run.err();
  EXPECT_THAT(run.err(), ::testing::HasSubstr("goes on"));
  EXPECT_TRUE(read_file(folder / "report" / "points.jsonl").empty());
  EXPECT_THAT(read_file(folder / "report" / "report.md"), ::testing::StartsWith("# Frames"));
}

TEST(Command, HealthProbesADaemon) {
  const std::string url = "http://127.0.0.1:" + std::to_string(shared_daemon().port());
  Program well({"health", url});
  EXPECT_EQ(well.wait(), 0) << well.err();
  Program missing({"health", url + "/v1/nothing"});
  EXPECT_EQ(missing.wait(), 1);
  Program nobody({"health", "http://127.0.0.1:1"});
  EXPECT_EQ(nobody.wait(), 1);
}

TEST(Serve, SigtermFinishesWhatIsInFlightAndExitsWithZero) {
  Program run({"serve", "--listen", "127.0.0.1:0"});
  httplib::Client daemon("127.0.0.1", run.port());
  daemon.set_read_timeout(300);
  auto scene = small_scene();
  scene["method"] = {{"name", "nishita"}, {"view_samples", 200}, {"light_samples", 200}};
  auto answer = std::async(std::launch::async, [&] {
    return daemon.Post("/v1/render", scene.dump(), "application/json");
  });
  std::this_thread::sleep_for(300ms);
  run.signal(SIGTERM);
  const auto finished = answer.get();
  ASSERT_TRUE(finished) << run.err();
  EXPECT_EQ(finished->status, 200) << finished->body;
  EXPECT_EQ(run.wait(), 0) << run.err();
}

TEST(Serve, EveryRequestIsOneLineOfJson) {
  Program run({"serve", "--listen", "127.0.0.1:0"});
  httplib::Client daemon("127.0.0.1", run.port());
  daemon.Get("/v1/limits?\"evil\"", {{"X-Request-Id", "abc"}});
  daemon.Get("/%22%0a%7b");
  run.signal(SIGINT);
  EXPECT_EQ(run.wait(), 0);
  std::istringstream lines(run.err());
  int found = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto entry = json::parse(line);
    EXPECT_TRUE(entry.contains("time"));
    if (entry.value("id", "") == "abc") {
      ++found;
      EXPECT_EQ(entry.at("path"), "/v1/limits");
      EXPECT_EQ(entry.at("status"), 200);
    }
  }
  EXPECT_EQ(found, 1);
}

TEST(Serve, AnAddressThatIsTakenIsAFailure) {
  Program run({"serve", "--listen", "127.0.0.1:" + std::to_string(shared_daemon().port())});
  EXPECT_EQ(run.wait(), 1);
  EXPECT_THAT(run.err(), ::testing::HasSubstr("cannot listen"));
}

TEST(Serve, ADeviceThatIsNotThereIsAFailure) {
  Program run({"serve", "--listen", "127.0.0.1:0", "--device", "no such device"});
  EXPECT_EQ(run.wait(), 1);
}

TEST(Serve, ADriverThatDoesNotStartIsAFailure) {
  for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
    setenv(name, "/nowhere.json", 1);
  }
  Program run({"serve", "--listen", "127.0.0.1:0"});
  const int ended = run.wait();
  for (const char* name : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) unsetenv(name);
  EXPECT_EQ(ended, 1);
  EXPECT_THAT(run.err(), ::testing::HasSubstr("no device to work on"));
}

/// Of a daemon that logs to such a file.
void expect_answers_and_an_end(const std::string& log) {
  int port = 0;
  {
    Daemon free(free_port());
    port = free.port();
  }
  Program run({"serve", "--listen", "127.0.0.1:" + std::to_string(port)}, "", log);
  httplib::Client daemon("127.0.0.1", port);
  daemon.set_read_timeout(300);
  httplib::Result answer = daemon.Get("/healthz");
  for (int i = 0; i < 600 && !answer; ++i) {
    std::this_thread::sleep_for(10ms);
    answer = daemon.Get("/healthz");
  }
  ASSERT_TRUE(answer);
  answer = daemon.Post("/v1/render", tiny_scene().dump(), "application/json");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  run.signal(SIGTERM);
  EXPECT_EQ(run.wait(), 0);
}

/// A log on a full disk is lost; the daemon is not.
TEST(Serve, ALogThatCannotBeWrittenHindersNobody) { expect_answers_and_an_end("/dev/full"); }

TEST(Serve, ALogThatNobodyReadsHindersNobody) {
  TemporaryFolder folder;
  const std::string pipe = folder / "log";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const int held = open(pipe.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  const std::string page(4096, 'x');
  while (write(held, page.data(), page.size()) > 0) continue;
  expect_answers_and_an_end(pipe);
  close(held);
}

TEST(Serve, LongPathsAreCutInTheLog) {
  Program run({"serve", "--listen", "127.0.0.1:0"});
  httplib::Client daemon("127.0.0.1", run.port());
  std::string path = "/";
  for (int i = 0; i < 2000; ++i) path += "%01";
  EXPECT_EQ(daemon.Get(path)->status, 404);
  run.signal(SIGTERM);
  EXPECT_EQ(run.wait(), 0);
  std::istringstream lines(run.err());
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LT(line.size(), 4096u) << "more than a pipe takes at once";
    EXPECT_TRUE(json::accept(line)) << line;
  }
}

TEST(Serve, SettingsComeFromTheEnvironmentAndAreChecked) {
  setenv("CYANOMETER_QUEUE", "0", 1);
  Program refused({"serve", "--listen", "127.0.0.1:0"});
  EXPECT_EQ(refused.wait(), 2);
  EXPECT_THAT(refused.err(), ::testing::HasSubstr("queue"));
  setenv("CYANOMETER_QUEUE", "7", 1);
  Program run({"serve", "--listen", "127.0.0.1:0"});
  unsetenv("CYANOMETER_QUEUE");
  EXPECT_EQ(json_of(httplib::Client("127.0.0.1", run.port()).Get("/v1/limits")).at("queue"), 7);
}

TEST(Serve, TheTableOfSettingsListsEachOne) {
  Program run({"serve", "--help-markdown"});
  EXPECT_EQ(run.wait(), 0);
  for (const auto& setting : settings()) {
    EXPECT_THAT(run.out(), ::testing::HasSubstr("`" + setting.flag() + "` | `" +
                                                setting.variable() + "`"));
  }
}

}  // namespace
}  // namespace cyanometer::testing
