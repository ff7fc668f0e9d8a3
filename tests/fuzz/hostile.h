// What nobody should send: values and texts that have broken parsers.
#pragma once

#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

namespace cyanometer::testing {

class Hostile {
 public:
  using Json = nlohmann::json;
  explicit Hostile(unsigned seed) : random_(seed) {}

  bool chance(double p) { return std::bernoulli_distribution(p)(random_); }
  std::size_t below(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
  }
  template <class T>
  const T& one_of(const std::vector<T>& list) {
    return list[below(list.size())];
  }

  Json value() {
    static const std::vector<Json> values{nullptr,
                                          true,
                                          false,
                                          0,
                                          -0.0,
                                          -1,
                                          1e-320,
                                          1e308,
                                          -1e308,
                                          9223372036854775807,
                                          9223372036854775808u,
                                          18446744073709551615u,
                                          "",
                                          "\u0000",
                                          "auto",
                                          "all",
                                          "../../etc/passwd",
                                          std::string(5000, 'a'),
                                          Json::array(),
                                          Json::array({Json::array()}),
                                          Json::array({1, "1", nullptr}),
                                          Json::object(),
                                          {{"type", "table"}},
                                          {{"", 1}},
                                          {{"a/b~c", 1}}};
    return one_of(values);
  }

  /// Sets, adds or removes something somewhere in the document.
  void mutate(Json& document) {
    Json* place = &document;
    while (place->is_structured() && !place->empty() && chance(0.8)) {
      auto inner = place->begin();
      std::advance(inner, static_cast<std::ptrdiff_t>(below(place->size())));
      place = &*inner;
    }
    if (place->is_object() && chance(0.5)) {
      (*place)[chance(0.5) ? "type" : "unknown_member"] = value();
    } else {
      *place = value();
    }
  }

  /// The text of a document, broken.
  std::string broken(std::string text) {
    static const std::vector<std::string> numbers{
        "NaN", "-Infinity", "1e400", "-1e400", "-0",     "0x10", "1.",          ".5",     "+1",
        "01",  "1e",        "--1",   "1_000",  "'text'", "True", "\"\\ud800\"", "\"\\x\""};
    const std::size_t at = text.empty() ? 0 : below(text.size());
    switch (below(8)) {
      case 0:
        return text.substr(0, at);
      case 1:
        return text.insert(at, 1, static_cast<char>(0x80 + below(0x80)));
      case 2:
        return text.insert(at, 1, static_cast<char>(below(0x20)));
      case 3:
        return text + text;
      case 4:
        return std::string(1 + below(200000), chance(0.5) ? '[' : '{') + text;
      case 5:
        return "{\"sun\":{\"elevation_deg\":" + one_of(numbers) + "}}";
      case 6:
        return "{\"sun\":{},\"sun\":" + text + "}";
      default:
        return text.insert(at, one_of(numbers));
    }
  }

  /// Bytes that a header's value may hold on the way.
  std::string header() {
    static const std::vector<std::string> texts{"",
                                                "*/*",
                                                "image/png;q=nan",
                                                ",,,;;;===",
                                                "\"\"",
                                                "W/\"x\", *",
                                                "-1",
                                                "1e400",
                                                "0.000000001x",
                                                "%0d%0aX-Evil: 1",
                                                std::string(4000, ','),
                                                "\xff\xfe"};
    return one_of(texts);
  }

 private:
  std::mt19937 random_;
};

}  // namespace cyanometer::testing
