// Bytes that are a document, and bytes that are none.
#include <random>

#include "scene_testing.h"

namespace cyanometer {
namespace {

std::string parse_refusal(const std::string& bytes) {
  try {
    parse_json(bytes);
    return "accepted";
  } catch (const SceneError& error) {
    return "refused at '" + error.pointer + "'";
  }
}
std::string nested(int levels) {
  return std::string(static_cast<std::size_t>(levels), '[') +
         std::string(static_cast<std::size_t>(levels), ']');
}

TEST(JsonText, ValuesKeepTheirKinds) {
  const Json parsed =
      parse_json(" {\"a\": [1, -2, 2.5, true, null, \"\\u00e9\"], \"b\": {}} \n");
  EXPECT_EQ(parsed,
            (Json{{"a", {1, -2, 2.5, true, nullptr, "\u00e9"}}, {"b", Json::object()}}));
  EXPECT_EQ(parse_json("\xEF\xBB\xBF{}"), Json::object()) << "after a byte order mark";
}

TEST(JsonText, WhatIsNoJsonIsRefused) {
  for (const char* bad : {"", " ", "{", "{]", "[1,]", "{\"a\":}", "{} {}", "NaN", "[Infinity]",
                          "{'a': 1}", "// x\n{}", "01", "+1", "[\"\x01\"]", "\"\\ud800\""})
    EXPECT_EQ(parse_refusal(bad), "refused at ''") << bad;
}

TEST(JsonText, WhatIsNoUtf8IsRefused) {
  for (const char* bad : {"\"\xff\"", "\"\xc3\"", "\"\xed\xa0\x80\"", "{\"\xc0\xaf\": 1}"})
    EXPECT_EQ(parse_refusal(bad), "refused at ''") << bad;
}

TEST(JsonText, ARefusalIsItselfUtf8) {
  for (const char* bad : {"\"\xff\"", "\xfe", "{\"\xc0\xaf\": 1}"}) try {
      parse_json(bad);
      ADD_FAILURE();
    } catch (const SceneError& error) {
      EXPECT_NO_THROW((Json{error.pointer, error.given, error.allowed, error.what()}.dump()));
    }
}

TEST(JsonText, AKeyGivenTwiceIsRefusedByItsPointer) {
  EXPECT_EQ(parse_refusal(R"({"a": 1, "a": 1})"), "refused at '/a'");
  EXPECT_EQ(parse_refusal(R"({"x": [0, {"a/b": 1, "a/b": 2}]})"), "refused at '/x/1/a~1b'");
  EXPECT_EQ(parse_refusal(R"({"x": {"a": 1}, "y": {"a": 1, "b": {}, "a": 2}})"),
            "refused at '/y/a'");
  EXPECT_EQ(parse_refusal(R"({"x": {"a": 1}, "y": {"a": 1}})"), "accepted");
}

TEST(JsonText, NumbersTooLargeAreRefused) {
  EXPECT_EQ(parse_refusal("[1e308]"), "accepted");
  EXPECT_EQ(parse_refusal("[1e400]"), "refused at ''");
  EXPECT_EQ(parse_refusal("[-1e400]"), "refused at ''");
  EXPECT_EQ(parse_json("1e-400"), 0.0);
  EXPECT_EQ(parse_json("123456789012345678901234567890"), 123456789012345678901234567890.0);
}

TEST(JsonText, DepthAndSizeAreBounded) {
  EXPECT_EQ(parse_refusal(nested(32)), "accepted");
  EXPECT_EQ(parse_refusal(nested(33)), "refused at ''");
  EXPECT_EQ(parse_refusal(std::string(1'000'000, '[')), "refused at ''");
  EXPECT_EQ(parse_refusal(std::string(9'000'000, ' ') + "{}"), "refused at ''");
}

TEST(JsonText, NoBytesCrashIt) {
  std::mt19937 random(7);
  const std::string seed =
      R"({"sun": {"elevation_deg": -4.5e1, "place": null}, "preset": "earth",
      "image": {"show": ["sun"], "width": 640}, "planet": {"ground_albedo": [0.1, "\u00e9"]}})";
  for (int i = 0; i < 20000; ++i) {
    std::string bytes = seed;
    for (int change = 0; change < 1 + i % 4; ++change) {
      const std::size_t at = random() % bytes.size();
      if (random() % 3 == 0)
        bytes.erase(at, 1 + random() % 8);
      else if (random() % 2 == 0)
        bytes.insert(at, bytes.substr(random() % bytes.size(), 9));
      else
        bytes[at] = static_cast<char>(random());
      if (bytes.empty()) bytes = "{";
    }
    try {
      read_scene(parse_json(bytes));
    } catch (const SceneError& error) {
      EXPECT_NO_THROW((Json{error.pointer, error.given, error.what()}.dump())) << bytes;
    }
  }
}

}  // namespace
}  // namespace cyanometer
