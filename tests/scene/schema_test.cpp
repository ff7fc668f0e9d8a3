// The schema says what reading does.
#include <set>

#include "random_document.h"
#include "scene_testing.h"

namespace cyanometer {
namespace {

const std::set<std::string> groups{"sun",    "air",   "haze",    "ozone", "planet",
                                   "camera", "light", "picture", "method"};

/// Calls f(name, schema) for every member that the schema describes.
template <class F>
void each_member(const Json& schema, const F& f) {
  for (const char* word : {"properties", "patternProperties"})
    if (schema.contains(word))
      for (const auto& [name, member] : schema[word].items()) {
        if (word == std::string("properties")) f(name, member);
        each_member(member, f);
      }
  if (schema.contains("anyOf"))
    for (const Json& one : schema["anyOf"]) each_member(one, f);
}

/// Calls f(pointer, schema) for every member of the parts of a scene.
template <class F>
void each_member_of_parts(const F& f) {
  const Json parts = scene_schema()["properties"];
  for (const auto& [part, schema] : parts.items()) {
    const Json members = schema.value("properties", Json::object());
    for (const auto& [name, member] : members.items()) f("/" + part + "/" + name, member);
  }
}

/// Calls f(schema) for every schema of a number.
template <class F>
void each_number(const Json& schema, const F& f) {
  if (schema.is_object() && schema.contains("type") &&
      (schema["type"] == "number" || schema["type"] == "integer"))
    f(schema);
  if (schema.is_structured())
    for (const Json& part : schema) each_number(part, f);
}

/// The keywords of JSON Schema that the schema uses.
bool conforms(const Json& value, const Json& schema);

bool has_type(const Json& value, const std::string& type) {
  if (type == "number") return value.is_number();
  if (type == "integer")
    return value.is_number() && value.get<double>() == std::trunc(value.get<double>());
  return value.type_name() == type;
}
bool conforms_as_object(const Json& value, const Json& schema) {
  for (const Json& name : schema.value("required", Json::array()))
    if (!value.contains(name.get<std::string>())) return false;
  for (const auto& [name, member] : value.items()) {
    const Json* own = nullptr;
    if (schema["properties"].contains(name))
      own = &schema["properties"][name];
    else if (schema.contains("patternProperties"))
      own = &*schema["patternProperties"].begin();
    if (own ? !conforms(member, *own) : schema.contains("additionalProperties")) return false;
  }
  return true;
}
bool conforms_as_array(const Json& value, const Json& schema) {
  if (value.size() < schema.value("minItems", 0u)) return false;
  if (value.size() > schema.value("maxItems", 1u << 20)) return false;
  for (std::size_t i = 0; i < value.size(); ++i)
    if (!conforms(value[i],
                  schema.contains("items") ? schema["items"] : schema["prefixItems"][i]))
      return false;
  return true;
}
bool conforms(const Json& value, const Json& schema) {
  if (schema.contains("anyOf") && std::ranges::none_of(schema["anyOf"], [&](const Json& one) {
        return conforms(value, one);
      }))
    return false;
  if (schema.contains("const") && value != schema["const"]) return false;
  if (schema.contains("enum") &&
      std::ranges::find(schema["enum"], value) == schema["enum"].end())
    return false;
  if (schema.contains("type") && !has_type(value, schema["type"])) return false;
  if (schema.contains("minimum") && value < schema["minimum"]) return false;
  if (schema.contains("maximum") && value > schema["maximum"]) return false;
  if (value.is_object() && schema.contains("properties"))
    return conforms_as_object(value, schema);
  if (value.is_array() && !schema.contains("anyOf")) return conforms_as_array(value, schema);
  return true;
}

TEST(Schema, EveryMemberIsExplainedAndBelongsToAGroup) {
  int members = 0;
  each_member(scene_schema(), [&](const std::string& name, const Json& member) {
    ++members;
    EXPECT_FALSE(member.value("title", "").empty()) << name;
    const std::string help = member.value("description", "");
    EXPECT_TRUE(help.ends_with('.')) << name << ": " << help;
    EXPECT_TRUE(groups.contains(member.value("x-group", ""))) << name << member["x-group"];
  });
  EXPECT_GT(members, 100);
}

TEST(Schema, EveryNumberHasARange) {
  each_number(scene_schema(), [](const Json& number) {
    ASSERT_TRUE(number.contains("minimum") && number.contains("maximum")) << number;
    EXPECT_LT(number["minimum"], number["maximum"]) << number;
  });
}

TEST(Schema, EveryUnitInANameIsAUnitOfTheMember) {
  each_member(scene_schema(), [](const std::string& name, const Json& member) {
    if (name.ends_with("_km") || name.ends_with("_deg") || name.ends_with("_nm") ||
        name.ends_with("_per_s")) {
      EXPECT_TRUE(member.contains("x-unit")) << name;
    }
  });
}

TEST(Schema, SlidersLieWithinTheRange) {
  int sliders = 0;
  each_member(scene_schema(), [&](const std::string& name, const Json& member) {
    if (!member.contains("x-slider")) return;
    ++sliders;
    const Json& slider = member["x-slider"];
    EXPECT_LT(slider["minimum"], slider["maximum"]) << name;
    EXPECT_GT(slider["step"], 0) << name;
    EXPECT_TRUE(conforms(slider["minimum"], member)) << name;
    EXPECT_TRUE(conforms(slider["maximum"], member)) << name;
    EXPECT_GT(slider["minimum"], slider["scale"] == "log" ? 0 : -1000) << name;
  });
  EXPECT_GT(sliders, 30);
}

TEST(Schema, EveryNumberThatIsAMemberHasASlider) {
  each_member(scene_schema(), [](const std::string& name, const Json& member) {
    if (name == "value") return;  // the power law's, which has the spectrum's
    EXPECT_TRUE(!member.contains("minimum") || member.contains("x-slider")) << name;
  });
}

TEST(Schema, DefaultsAreWhatTheEmptyDocumentMeans) {
  const Scene empty = scene_of("{}");
  int defaults = 0;
  each_member_of_parts([&](const std::string& pointer, const Json& member) {
    if (!member.contains("default")) return;
    ++defaults;
    const Json document = with(pointer, member["default"]);
    ASSERT_FALSE(refusal(document)) << document;
    EXPECT_EQ(read_scene(document), empty) << document;
    EXPECT_EQ(read_scene(with(pointer, nullptr)), empty) << pointer;
  });
  EXPECT_GT(defaults, 25);
}

TEST(Schema, WhatIsBeyondARangeIsRefusedThere) {
  each_member_of_parts([](const std::string& pointer, const Json& member) {
    if (!member.contains("minimum")) return;
    const double high = member["maximum"], low = member["minimum"];
    for (const double bad : {high + 1, low - 1, 1e300}) {
      const auto error = refusal(with(pointer, bad));
      ASSERT_TRUE(error) << pointer << bad;
      EXPECT_EQ(error->pointer, pointer);
    }
  });
}

TEST(Schema, WhatIsOfNoKindIsRefusedThere) {
  each_member_of_parts([](const std::string& pointer, const Json&) {
    const auto error = refusal(with(pointer, parse_json(R"({"no such member": true})")));
    ASSERT_TRUE(error) << pointer;
    EXPECT_TRUE(error->pointer.starts_with(pointer)) << error->pointer;
  });
  for (const char* part : {"/planet", "/atmosphere", "/sun", "/camera", "/spectrum", "/method",
                           "/image", "/preset"})
    EXPECT_EQ(refusal(with(part, 5))->pointer, part);
}

TEST(Schema, DocumentsThatAreReadConformToIt) {
  const Json schema = scene_schema();
  RandomDocument random(schema, 2);
  for (int i = 0; i < 500; ++i) {
    const Json document = random.next();
    EXPECT_TRUE(conforms(document, schema)) << document;
    if (refusal(document)) continue;
    EXPECT_TRUE(conforms(canonical(read_scene(document)), schema)) << document;
  }
  for (const Preset& preset : presets())
    EXPECT_TRUE(conforms(canonical(read_scene({{"preset", preset.name}})), schema))
        << preset.name;
}

/// Every object of the document, the members of `of` first.
void each_object(Json& of, const std::function<void(Json&)>& f) {
  if (!of.is_structured()) return;
  for (Json& part : of) each_object(part, f);
  if (of.is_object()) f(of);
}

TEST(Schema, ReadingRefusesAnUnknownMemberInEveryObject) {
  for (const char* name : {"earth", "earth_us76"}) {
    Json document = canonical(read_scene({{"preset", name}}));
    int objects = 0;
    each_object(document, [&](Json& object) {
      object["unheard_of"] = 1;
      const auto error = refusal(document);
      ASSERT_TRUE(error) << document;
      EXPECT_TRUE(error->pointer.ends_with("/unheard_of")) << error->pointer;
      object.erase("unheard_of");
      ++objects;
    });
    EXPECT_GT(objects, 15);
  }
}

}  // namespace
}  // namespace cyanometer
