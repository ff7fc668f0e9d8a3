// Whatever is sent, the daemon answers as its own OpenAPI document says, never with 5xx, and
// goes on. The operations and what they take are read from the daemon. The number of cases is
// CYANOMETER_FUZZ_CASES, the first of them CYANOMETER_FUZZ_FIRST; each is a function of its
// number.
#include <gtest/gtest.h>
#include <httplib.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <thread>

#include "engine/scene/document.h"
#include "server/daemon.h"
#include "tests/composite/picture_file.h"
#include "tests/fuzz/hostile.h"
#include "tests/scene/random_document.h"

namespace cyanometer::testing {
namespace {

using nlohmann::json;

struct Operation {
  std::string method, path;
  json description;
};

struct Case {
  std::string method, target, body;
  httplib::Headers headers;
};

class ApiFuzzer {
 public:
  ApiFuzzer(const json& openapi, const json& scene_schema)
      : openapi_(openapi), scene_schema_(scene_schema) {
    for (const auto& [path, operations] : openapi.at("paths").items()) {
      for (const auto& [method, operation] : operations.items()) {
        operations_.push_back({method == "get" ? "GET" : "POST", path, operation});
      }
    }
  }

  std::pair<Operation, Case> make(unsigned number) {
    Hostile hostile(number);
    const Operation& operation = one_of_operations(hostile);
    Case made{operation.method, operation.path, "", {}};
    if (operation.description.contains("parameters") &&
        (operation.method == "GET" || operation.path == "/v1/composite" ||
         hostile.chance(0.2))) {
      made.target += "?" + query(hostile, number, operation.path == "/v1/stream");
    }
    if (operation.method == "POST") made.body = body(operation, hostile, number);
    for (const char* name : {"Accept", "If-None-Match", "Cyanometer-Deadline", "X-Request-Id",
                             "Content-Type", "Origin", "Range"}) {
      if (hostile.chance(0.05)) made.headers.emplace(name, hostile.header());
    }
    return {operation, made};
  }

 private:
  /// The chart of a scene that is sound takes ten seconds and more: few of them.
  const Operation& one_of_operations(Hostile& hostile) const {
    for (;;) {
      const Operation& operation = hostile.one_of(operations_);
      if (operation.path != "/v1/chart" || hostile.chance(0.1)) return operation;
    }
  }

  /// Small and quick where nothing else is said, with some members out of the whole schema.
  json scene(Hostile& hostile, unsigned number) {
    json document{{"image", {{"width", 8}, {"height", 4}}},
                  {"spectrum", {{"wavelengths_nm", {680, 550, 440}}}},
                  {"method", {{"name", "raymarch"}, {"scattering_orders", 1}}}};
    json other = RandomDocument(scene_schema_, number).next();
    make_cheap(other, hostile);
    // Each form of scene has kernels of its own for each method, which take most of the time.
    const std::map<std::string, double> seldom{{"method", 0.4}, {"spectrum", 0.1}};
    for (const auto& [name, part] : other.items()) {
      const auto chance = seldom.find(name);
      if (hostile.chance(chance == seldom.end() ? 0.3 : chance->second)) document[name] = part;
    }
    return document;
  }

  /// Any method, file and few wavelengths, of which frames are soon made.
  void make_cheap(json& document, Hostile& hostile) {
    json& image = document["image"];
    if (!image.is_object()) image = json::object();
    image["width"] = 1 + hostile.below(16);
    image["height"] = 1 + hostile.below(8);
    json& method = document["method"];
    if (!method.is_object()) method = json::object();
    const json& options = scene_schema_.at("properties").at("method").at("properties");
    const json& names = options.at("name").at("enum");
    method["name"] = names[hostile.below(names.size())];
    for (const auto& [name, option] : options.items()) {
      if (option.value("type", "") != "integer" || name == "seed") continue;
      const std::int64_t least = option.at("minimum"), default_value = option.at("default");
      const std::int64_t most = std::max<std::int64_t>(least, 8);
      method[name] = std::min(method.value(name, default_value), most);
    }
    if (method.contains("max_error")) {
      method["max_error"] = std::max(method["max_error"].get<double>(), 0.1);
    }
    if (hostile.chance(0.9)) method.erase("verify");  // by walks, which take seconds
  }

  json instance(const json& schema, Hostile& hostile, unsigned number) {
    if (schema.contains("$ref")) return scene(hostile, number);
    if (schema.contains("const")) return schema["const"];
    if (!schema.contains("type") && schema.contains("oneOf")) {
      const json& kinds = schema["oneOf"];
      return instance(kinds[hostile.below(kinds.size())], hostile, number);
    }
    const std::string type = schema.value("type", "null");
    if (type == "object" && schema.value("additionalProperties", json()).is_object()) {
      return {{"sun.elevation_deg", instance(schema["additionalProperties"], hostile, number)}};
    }
    if (type == "object") {
      json object = json::object();
      const json properties = schema.value("properties", json::object());
      for (const auto& [name, part] : properties.items()) {
        // Without a scene it is the whole Earth, planned for many wavelengths: slow.
        if (hostile.chance(part.contains("$ref") ? 0.99 : 0.7))
          object[name] = instance(part, hostile, number);
      }
      if (properties.empty()) object = scene(hostile, number);
      return object;
    }
    if (type == "array") {
      json list = json::array();
      for (std::size_t i = hostile.below(3) + 1; i > 0; --i) {
        list.push_back(instance(schema["items"], hostile, number + static_cast<unsigned>(i)));
      }
      return list;
    }
    if (type == "integer")
      return schema.value("minimum", 0) + static_cast<int>(hostile.below(3));
    if (type == "number")
      return schema.value("minimum", 0.0) / (1.0 + double(hostile.below(4)));
    if (type == "boolean") return hostile.chance(0.5);
    return hostile.value();
  }

  std::string body(const Operation& operation, Hostile& hostile, unsigned number) {
    const json& content = operation.description.at("requestBody").at("content");
    if (!content.contains("application/json")) return picture(hostile);
    json document = instance(content.at("application/json").at("schema"), hostile, number);
    if (hostile.chance(0.6)) hostile.mutate(document);
    std::string text = document.dump(-1, ' ', false, json::error_handler_t::replace);
    return hostile.chance(0.2) ? hostile.broken(text) : text;
  }

  /// An EXR with distances, now and then of odd values or channels, or broken.
  static std::string picture(Hostile& hostile) {
    constexpr int width = 8, height = 4;
    Channels channels;
    for (const char* name : {"R", "G", "B", "Z"}) {
      std::vector<float>& plane = channels[name];
      plane.assign(width * height, static_cast<float>(hostile.below(100)) / 10);
      if (hostile.chance(0.1)) {
        plane[hostile.below(plane.size())] =
            hostile.one_of<float>({-1, NAN, INFINITY, 1e30f, -INFINITY, 3e38f, 1e-40f});
      }
    }
    if (hostile.chance(0.05)) channels.erase(channels.begin());
    const std::string file = picture_file(width, height, channels);
    return hostile.chance(0.2) ? hostile.broken(file) : file;
  }

  static void flatten(const json& value, const std::string& path, httplib::Params& to) {
    if (!value.is_object() || value.empty()) {
      to.emplace(path, value.is_string() ? value.get<std::string>() : value.dump());
      return;
    }
    for (const auto& [name, part] : value.items()) {
      flatten(part, path.empty() ? name : path + "." + name, to);
    }
  }

  std::string query(Hostile& hostile, unsigned number, bool stream) {
    json document = scene(hostile, number);
    if (hostile.chance(0.6)) hostile.mutate(document);
    httplib::Params parameters;
    flatten(document, "", parameters);
    if (stream) {
      if (hostile.chance(0.6)) parameters.emplace("frames", hostile.chance(0.7) ? "2" : "1e9");
      if (hostile.chance(0.6)) parameters.emplace("to.sun.elevation_deg", "5");
      if (hostile.chance(0.3)) parameters.emplace("refine", "true");
    }
    if (hostile.chance(0.1)) parameters.emplace("to.a.b", "%");
    std::string text = httplib::detail::params_to_query_str(parameters);
    if (hostile.chance(0.1))
      text += hostile.one_of<std::string>(
          {"&", "&=", "&a..b=1", "&%00=1", "&%ff=1", "&sun=1&sun.elevation_deg=2", "&%zz"});
    return text;
  }

  json openapi_, scene_schema_;
  std::vector<Operation> operations_;
};

unsigned from_environment(const char* name, unsigned otherwise) {
  const char* text = std::getenv(name);
  return text ? static_cast<unsigned>(std::stoul(text)) : otherwise;
}

/// How often each status was answered: to all, and to those that name each method.
class Tally {
 public:
  explicit Tally(const json& scene_schema)
      : methods_(scene_schema.at("/properties/method/properties/name/enum"_json_pointer)) {}

  void add(const Case& made, int status) {
    ++counts_["all"][status];
    for (const auto& name : methods_) {
      if (made.body.find("\"name\":\"" + name + "\"") != std::string::npos ||
          made.target.find("method.name=" + name) != std::string::npos) {
        ++counts_[name][status];
      }
    }
  }
  void print() const {
    for (const auto& [name, counts] : counts_) {
      std::printf("%-9s", name.c_str());
      for (const auto& [status, count] : counts) std::printf(" %d: %d", status, count);
      std::printf("\n");
    }
  }
  int of(const std::string& name, int status) { return counts_[name][status]; }
  const std::vector<std::string>& methods() const { return methods_; }

 private:
  std::vector<std::string> methods_;
  std::map<std::string, std::map<int, int>> counts_;
};

void check(const Operation& operation, const httplib::Result& answer) {
  ASSERT_TRUE(answer) << httplib::to_string(answer.error());
  EXPECT_LT(answer->status, 500) << answer->body.substr(0, 500);
  EXPECT_TRUE(operation.description.at("responses").contains(std::to_string(answer->status)))
      << answer->status << answer->body.substr(0, 500);
  EXPECT_FALSE(answer->has_header("X-Evil"));
  if (answer->status < 400) return;
  EXPECT_EQ(answer->get_header_value("Content-Type"), "application/problem+json");
  const json problem = json::parse(answer->body, nullptr, false);
  ASSERT_TRUE(problem.is_object()) << answer->body;
  EXPECT_EQ(problem.value("status", 0), answer->status);
  EXPECT_FALSE(problem.value("detail", "").empty());
}

TEST(Fuzz, EveryAnswerIsOneOfTheContract) {
  Config config;
  config.listen = "127.0.0.1:0";
  config.warm = false;
  config.max_pixels = 4096;
  config.max_device_s = 1;
  config.max_wavelengths = 8;
  config.max_frames = 4;
  Daemon daemon(config);
  daemon.start();
  httplib::Client client("127.0.0.1", daemon.port());
  client.set_keep_alive(true);
  client.set_tcp_nodelay(true);
  client.set_read_timeout(600);
  for (int i = 0; i < 6000 && client.Get("/readyz")->status != 200; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  const json scene_schema = json::parse(client.Get("/v1/schema")->body);
  ApiFuzzer fuzzer(json::parse(client.Get("/openapi.json")->body), scene_schema);
  const unsigned first = from_environment("CYANOMETER_FUZZ_FIRST", 0);
  const unsigned cases = from_environment("CYANOMETER_FUZZ_CASES", 1000);
  Tally tally(scene_schema);
  for (unsigned number = first; number < first + cases && !HasFailure(); ++number) {
    const auto [operation, made] = fuzzer.make(number);
    SCOPED_TRACE("CYANOMETER_FUZZ_CASES=1 CYANOMETER_FUZZ_FIRST=" + std::to_string(number) +
                 ": " + made.method + " " + made.target.substr(0, 300) + " " +
                 made.body.substr(0, 1000));
    const auto answer = made.method == "GET" ? client.Get(made.target.c_str(), made.headers)
                                             : client.Post(made.target.c_str(), made.headers,
                                                           made.body, "application/json");
    check(operation, answer);
    if (answer) tally.add(made, answer->status);
  }
  EXPECT_EQ(client.Get("/readyz")->status, 200);
  tally.print();
  // One case by itself, to see it again, may well be refused.
  EXPECT_TRUE(cases < 50 || tally.of("all", 200) > static_cast<int>(cases / 50));
  const auto answered = [&](const std::string& name) { return tally.of(name, 200) > 0; };
  EXPECT_TRUE(cases < 1000 || std::ranges::count_if(tally.methods(), answered) >= 5);
}

}  // namespace
}  // namespace cyanometer::testing
