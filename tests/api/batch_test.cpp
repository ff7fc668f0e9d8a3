// cyanometer render --frames: every frame is that of its scene, whole or not there, made once,
// and said to be what it is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "engine/scene/document.h"
#include "server/batch/file_pattern.h"
#include "server/batch/manifest.h"
#include "server/batch/shard.h"
#include "server/batch/whole_file.h"
#include "tests/api/client.h"
#include "tests/api/program.h"

namespace cyanometer::testing {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
namespace fs = std::filesystem;

json sunset(int frames) {
  return {{"frames", frames}, {"to", {{"sun.elevation_deg", -6}, {"camera.pitch_deg", 30}}}};
}

/// Documents in a folder, and runs over them.
struct Bench {
  explicit Bench(const json& scene, const json& sequence) {
    write("scene.json", scene);
    write("sequence.json", sequence);
  }
  void write(const std::string& name, const json& document) const {
    std::ofstream(folder / name) << document.dump();
  }
  std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> out{"render",   folder / "scene.json",
                                 "--frames", folder / "sequence.json",
                                 "-o",       folder / "out" / "sky-%03d.png"};
    out.insert(out.end(), more.begin(), more.end());
    return out;
  }
  /// Its standard error.
  std::string run(const std::vector<std::string>& more = {}, int exit = 0) const {
    Program program(arguments(more));
    EXPECT_EQ(program.wait(), exit) << program.err();
    return program.err();
  }
  fs::path file(const std::string& name) const { return folder / "out" / name; }
  std::string frame(int number) const {
    return read_file(FilePattern((folder / "out" / "sky-%03d.png").string()).file(number));
  }
  std::vector<json> manifest(const std::string& name = "sky-manifest.jsonl") const {
    std::vector<json> lines;
    std::istringstream text(read_file(file(name)));
    for (std::string line; std::getline(text, line);) lines.push_back(json::parse(line));
    return lines;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& each : fs::directory_iterator(folder / "out")) {
      out.push_back(each.path().filename().string());
    }
    std::ranges::sort(out);
    return out;
  }

  TemporaryFolder folder;
};

std::string rendered(const json& scene) {
  const auto answer = client().Post("/v1/render", scene.dump(), "application/json");
  EXPECT_EQ(answer->status, 200) << answer->body;
  return answer->body;
}

TEST(Batch, FramesAreThoseOfTheirScenesAndTheManifestSaysWhatTheyAre) {
  const Bench bench(tiny_scene(), sunset(5));
  bench.run();
  const auto lines = bench.manifest();
  ASSERT_EQ(lines.size(), 5u);
  std::set<int> numbers;
  for (const json& line : lines) {
    const int number = line.at("frame");
    numbers.insert(number);
    const json patch{{"sun", {{"elevation_deg", 30 - 9 * number}}},
                     {"camera", {{"pitch_deg", 10 + 5 * number}}}};
    EXPECT_EQ(line.at("patch"), patch);
    EXPECT_EQ(line.at("sun").at("elevation_deg"), patch["sun"]["elevation_deg"]);
    EXPECT_EQ(line.at("camera").at("pitch_deg"), patch["camera"]["pitch_deg"]);
    EXPECT_EQ(line.at("method"), "raymarch");
    EXPECT_GT(line.at("error"), 0);
    const std::string bytes = bench.frame(number);
    EXPECT_EQ(line.at("bytes"), bytes.size());
    EXPECT_EQ(bytes, rendered(merge(tiny_scene(), patch))) << number;
  }
  EXPECT_EQ(numbers, (std::set{0, 1, 2, 3, 4}));
  EXPECT_EQ(bench.names().size(), 6u) << "frames and manifest, nothing unfinished";
}

TEST(Batch, PatchesMayBeListedAndPlansAreThoseOfEachFrameAlone) {
  json scene = small_scene();
  scene["method"] = {{"max_error", 0.3}};
  const json patches{json::object(), {{"sun", {{"elevation_deg", 2}}}}};
  const Bench bench(scene, {{"frames", patches}});
  bench.run({"--workers", "3"});
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(bench.frame(static_cast<int>(i)), rendered(merge(scene, patches[i]))) << i;
  }
}

TEST(Batch, PatchesMayLeaveTheirTypesToThePreset) {
  const auto hazy = [](const json& aerosol) {
    return json{{"atmosphere", {{"constituents", {{"aerosol", aerosol}}}}}};
  };
  const Bench bench(merge(tiny_scene(), hazy({{"optical_depth", 0.2}})),
                    {{"frames", {hazy({{"visibility_km", 10}})}}});
  bench.run();
  EXPECT_EQ(bench.frame(0), rendered(merge(tiny_scene(), hazy({{"visibility_km", 10}}))));
}

TEST(Batch, ASceneThatIsNoneIsNotTakenForAPatchOfOne) {
  const Bench bench(tiny_scene(), {{"frames", {json::object()}}});
  bench.write("scene.json", {1, 2});
  EXPECT_THAT(bench.run({}, 2), ::testing::HasSubstr("must be an object"));
  bench.write("scene.json", {{"image", 5}});
  EXPECT_THAT(bench.run({}, 2), ::testing::HasSubstr(" /image must be"));
}

TEST(Batch, WhatIsThereIsNotMadeAgainAndWhatIsBrokenOrOfAnotherSceneIs) {
  const Bench bench(tiny_scene(), sunset(4));
  bench.run();
  const std::string whole = bench.frame(2);
  EXPECT_THAT(bench.run(), ::testing::HasSubstr("0 rendered, 4 were there"));
  std::ofstream(bench.file("sky-002.png")) << whole.substr(0, whole.size() / 2);
  fs::remove(bench.file("sky-003.png"));
  EXPECT_THAT(bench.run(), ::testing::HasSubstr("2 rendered, 2 were there"));
  EXPECT_EQ(bench.frame(2), whole);
  EXPECT_EQ(bench.manifest().size(), 4u);

  json other = sunset(4);
  other["to"]["sun.elevation_deg"] = 10;
  bench.write("sequence.json", other);
  // The first frame, where the sweep begins, is the same.
  EXPECT_THAT(bench.run(), ::testing::HasSubstr("3 rendered, 1 were there"));
  EXPECT_EQ(bench.manifest().size(), 4u);
}

TEST(Batch, ShardsAreTheWholeOnceAndOnlyOnce) {
  const Bench bench(tiny_scene(), sunset(7));
  bench.run({"--shard", "0/3"});
  setenv("JOB_COMPLETION_INDEX", "1", 1);
  bench.run({"--shard", "/3"});
  unsetenv("JOB_COMPLETION_INDEX");
  bench.run({"--shard", "2/3"});
  EXPECT_EQ(bench.manifest("sky-manifest.0-of-3.jsonl").size(), 3u);
  EXPECT_EQ(bench.manifest("sky-manifest.1-of-3.jsonl").size(), 2u);
  EXPECT_EQ(bench.manifest("sky-manifest.2-of-3.jsonl").size(), 2u);
  EXPECT_THAT(bench.run(), ::testing::HasSubstr("0 rendered, 7 were there"));
}

TEST(Batch, TwoRunsDoNotWriteOneManifest) {
  const Bench bench(tiny_scene(), sunset(2));
  fs::create_directories(bench.folder / "out");
  {
    const Manifest other(bench.file("sky-manifest"), "");
    EXPECT_THAT(bench.run({}, 1), ::testing::HasSubstr("another run is writing"));
    EXPECT_TRUE(bench.manifest().empty());
    bench.run({"--shard", "0/2"});  // which has its own
    EXPECT_EQ(bench.manifest("sky-manifest.0-of-2.jsonl").size(), 1u);
  }
  EXPECT_THAT(bench.run(), ::testing::HasSubstr("1 rendered, 1 were there"));
  EXPECT_EQ(bench.names().size(), 4u) << "frames and manifests, no lock";
}

TEST(Interrupted, ABatchEndsAndGoesOnLater) {
  json scene = tiny_scene();
  scene["image"] = {{"width", 160}, {"height", 90}};
  for (const int signal : {SIGINT, SIGTERM}) {
    const Bench bench(scene, sunset(400));
    Program program(bench.arguments());
    const auto made = [&] {
      std::error_code none;
      return fs::exists(bench.file("sky-003.png"), none);
    };
    for (int i = 0; i < 3000 && !made(); ++i) std::this_thread::sleep_for(10ms);
    const auto start = std::chrono::steady_clock::now();
    program.signal(signal);
    EXPECT_EQ(program.wait(), 130) << program.err();
    EXPECT_LT(std::chrono::steady_clock::now() - start, 2s);
    const auto lines = bench.manifest();
    ASSERT_GT(lines.size(), 2u);
    ASSERT_LT(lines.size(), 400u);
    EXPECT_EQ(bench.names().size(), lines.size() + 1) << "nothing unfinished";
    if (signal == SIGTERM) continue;
    // Frames 0 and 200, of which the first is there.
    EXPECT_THAT(bench.run({"--shard", "0/200"}),
                ::testing::HasSubstr("1 rendered, 1 were there"));
  }
}

TEST(Interrupted, AKilledBatchGoesOnLater) {
  json scene = tiny_scene();
  scene["image"] = {{"width", 160}, {"height", 90}};
  const Bench bench(scene, sunset(200));
  Program program(bench.arguments());
  for (int i = 0; i < 3000 && !fs::exists(bench.file("sky-003.png")); ++i)
    std::this_thread::sleep_for(10ms);
  program.signal(SIGKILL);
  EXPECT_EQ(program.wait(), 1000 + SIGKILL);
  const auto before = bench.manifest();
  ASSERT_GT(before.size(), 0u);
  ASSERT_LT(before.size(), 200u);
  for (const json& line : before) {
    EXPECT_EQ(line.at("bytes"), fs::file_size(bench.file(line.at("file")))) << line;
  }
  EXPECT_THAT(bench.run(),
              ::testing::HasSubstr(std::to_string(200 - before.size()) + " rendered, " +
                                   std::to_string(before.size()) + " were there"));
  EXPECT_EQ(bench.manifest().size(), 200u);
  EXPECT_EQ(bench.names().size(), 201u) << "nothing unfinished, no lock";
}

TEST(Batch, IsRefusedBeforeTheFirstFrame) {
  const json low{{"sun", {{"elevation_deg", -100}}}};
  const Bench bench(tiny_scene(), {{"frames", {json::object(), low}}});
  EXPECT_THAT(bench.run({}, 2), ::testing::HasSubstr("/frames/1/sun/elevation_deg"));
  EXPECT_FALSE(fs::exists(bench.file("sky-000.png")));
  for (const std::string shard : {"3", "3/3", "-1/3", "a/b", "1/0", "/3", "1/3x", ""}) {
    EXPECT_THAT(bench.run({"--shard", shard}, 2), ::testing::HasSubstr("shard")) << shard;
  }
  bench.write("sequence.json", {{"frames", 3}, {"too", 1}});
  EXPECT_THAT(bench.run({}, 2), ::testing::HasSubstr("/too"));
  Program alone({"render", bench.folder / "scene.json", "-o", "sky.png", "--shard", "0/2"});
  EXPECT_EQ(alone.wait(), 2);
  Program one({"render", bench.folder / "scene.json", "--frames",
               bench.folder / "sequence.json", "-o", bench.folder / "sky.png"});
  EXPECT_EQ(one.wait(), 2);
  EXPECT_THAT(one.err(), ::testing::HasSubstr("%05d"));
}

TEST(Batch, AFolderThatTakesNothingIsAFailure) {
  const Bench bench(tiny_scene(), sunset(3));
  std::ofstream(bench.folder / "out") << "no folder";
  bench.run({}, 1);
}

TEST(Batch, AFullDiskEndsItAndLaterItGoesOn) {
  const Bench bench(tiny_scene(), sunset(5));
  fs::create_directories(bench.folder / "out");
  fs::create_symlink("/dev/full", bench.file("sky-002.png.part"));
  EXPECT_THAT(bench.run({"--workers", "1"}, 1), ::testing::HasSubstr("sky-002.png"));
  EXPECT_EQ(bench.names(),
            (std::vector<std::string>{"sky-000.png", "sky-001.png", "sky-manifest.jsonl"}));
  EXPECT_EQ(bench.manifest().size(), 2u);
  EXPECT_THAT(bench.run(), ::testing::HasSubstr("3 rendered, 2 were there"));
  EXPECT_EQ(bench.manifest().size(), 5u);
}

TEST(Batch, AManifestThatTakesNothingEndsItAndItsFramesAreMadeAgain) {
  const Bench bench(tiny_scene(), sunset(3));
  fs::create_directories(bench.folder / "out");
  fs::create_symlink("/dev/full", bench.file("sky-manifest.jsonl.part"));
  EXPECT_THAT(bench.run({"--workers", "1"}, 1), ::testing::HasSubstr("sky-manifest.jsonl"));
  fs::remove(bench.file("sky-manifest.jsonl"));
  EXPECT_THAT(bench.run(), ::testing::HasSubstr("3 rendered, 0 were there"));
  EXPECT_EQ(bench.manifest().size(), 3u);
}

TEST(Batch, PatternsNameEachFrameOnce) {
  EXPECT_EQ(FilePattern("a/sky-%05d.exr").file(42), "a/sky-00042.exr");
  EXPECT_EQ(FilePattern("%d.png").file(42), "42.png");
  EXPECT_EQ(FilePattern("%02d.png").file(123), "123.png");
  EXPECT_EQ(FilePattern("a/sky-%05d.exr").manifest_stem(), "a/sky-manifest");
  for (const std::string text : {"sky.png", "%d-%d.png", "%5d.png", "%s.png", "%x.png",
                                 "%00d.png", "100%.png", "a%d/b.png"}) {
    EXPECT_THROW(FilePattern{text}, std::invalid_argument) << text;
  }
}

TEST(Batch, ALineThatWasCutShortCountsForNothing) {
  TemporaryFolder folder;
  write_whole(folder / "a.png", "four");
  const fs::path stem = folder / "m";
  {
    Manifest manifest(stem, "");
    manifest.begin({});
    manifest.add({{"file", "a.png"}, {"key", "k"}, {"bytes", 4}});
  }
  EXPECT_TRUE(Manifest(stem, "").complete(folder / "a.png", "k"));
  EXPECT_FALSE(Manifest(stem, "").complete(folder / "a.png", "other"));
  EXPECT_FALSE(Manifest(stem, "").complete(folder / "b.png", "k"));
  EXPECT_TRUE(Manifest(stem, ".1-of-2").complete(folder / "a.png", "k"));
  const std::string text = read_file(folder / "m.jsonl");
  std::ofstream(folder / "m.jsonl") << text << text.substr(0, 20);
  Manifest again(stem, "");
  EXPECT_TRUE(again.complete(folder / "a.png", "k"));
  again.begin({});
  EXPECT_EQ(read_file(folder / "m.jsonl"), text);
  EXPECT_THROW(write_whole(folder / "none" / "a.png", ""), std::runtime_error);
}

}  // namespace
}  // namespace cyanometer::testing
