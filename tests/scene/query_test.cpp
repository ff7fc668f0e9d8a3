// A scene in a link.
#include "scene_testing.h"

namespace cyanometer {
namespace {

using Query = std::vector<std::pair<std::string, std::string>>;

std::string query_refusal(const Query& query) {
  try {
    document_from_query(query);
    return "accepted";
  } catch (const SceneError& error) {
    return "refused at '" + error.pointer + "'";
  }
}

TEST(Query, DottedPathsSetMembers) {
  EXPECT_EQ(document_from_query({{"preset", "mars"},
                                 {"sun.elevation_deg", "4"},
                                 {"sun.azimuth_deg", "-9.5"},
                                 {"atmosphere.constituents.dust", "null"},
                                 {"image.show", R"(["sun"])"},
                                 {"method.verify", "true"}}),
            parse_json(R"({"preset": "mars", "sun": {"elevation_deg": 4, "azimuth_deg": -9.5},
                           "atmosphere": {"constituents": {"dust": null}},
                           "image": {"show": ["sun"]}, "method": {"verify": true}})"));
  EXPECT_EQ(document_from_query({}), Json::object());
}

TEST(Query, WhatIsNoJsonIsAString) {
  EXPECT_EQ(document_from_query({{"a", "2003-10-17T12:30:30Z"}, {"b", ""}, {"c", "\"q\""}}),
            (Json{{"a", "2003-10-17T12:30:30Z"}, {"b", ""}, {"c", "q"}}));
}

TEST(Query, ObjectsMayBeFilledFurther) {
  EXPECT_EQ(document_from_query({{"sun", R"({"elevation_deg": 1})"}, {"sun.azimuth_deg", "2"}}),
            parse_json(R"({"sun": {"elevation_deg": 1, "azimuth_deg": 2}})"));
}

TEST(Query, APathGivenTwiceIsRefused) {
  EXPECT_EQ(query_refusal({{"sun.a", "1"}, {"sun.a", "1"}}), "refused at '/sun/a'");
  EXPECT_EQ(query_refusal({{"a", "null"}, {"a", "1"}}), "refused at '/a'");
  EXPECT_EQ(query_refusal({{"sun.a", "1"}, {"sun", "{}"}}), "refused at '/sun'");
}

TEST(Query, APathThroughNoObjectIsRefused) {
  EXPECT_EQ(query_refusal({{"sun", "5"}, {"sun.a", "1"}}), "refused at '/sun'");
  EXPECT_EQ(query_refusal({{"sun", "null"}, {"sun.a", "1"}}), "refused at '/sun'");
}

TEST(Query, PathsHaveNoEmptyParts) {
  EXPECT_EQ(query_refusal({{"", "1"}}), "refused at ''");
  EXPECT_EQ(query_refusal({{"sun.", "1"}}), "refused at '/sun'");
  EXPECT_EQ(query_refusal({{"sun..a", "1"}}), "refused at '/sun'");
  EXPECT_EQ(query_refusal({{std::string(100000, '.'), "1"}}), "refused at ''");
}

TEST(Query, TextIsUtf8) {
  EXPECT_EQ(query_refusal({{"a", "\xff"}}), "refused at '/a'");
  EXPECT_EQ(query_refusal({{"\xff", "1"}}), "refused at ''");
}

}  // namespace
}  // namespace cyanometer
