#include "engine/scene/document.h"

#include "engine/scene/members.h"
#include "engine/scene/presets.h"

namespace cyanometer {
namespace {

/// Parts in the order in which they are read: a part may look at those before it.
ObjectOf<Scene> make_scene_members() {
  return object<Scene>(
      Member("spectrum", &Scene::spectrum, Spelled<SpectrumChoice>(spectrum_members()), "Light",
             "The wavelengths that are computed.")
          .group("light"),
      Member("planet", &Scene::planet, Spelled<Planet>(planet_members()), "Planet",
             "The planet and its ground.")
          .group("planet"),
      Member("atmosphere", &Scene::atmosphere, Spelled<Atmosphere>(atmosphere_members()), "Air",
             "What the air is made of.")
          .group("air"),
      Member("sun", &Scene::sun, Spelled<Sun>(sun_members()), "Sun",
             "Where the sun stands and what it looks like.")
          .group("sun"),
      Member("camera", &Scene::camera, Spelled<Camera>(camera_members()), "Camera",
             "Where the camera stands and where it looks.")
          .group("camera"),
      Member("method", &Scene::method, Spelled<MethodChoice>(method_members()), "Method",
             "How the light is computed, and how exactly.")
          .group("method"),
      Member("image", &Scene::image, Spelled<Image>(image_members()), "Picture",
             "The image and its file.")
          .group("picture"));
}

/// @param whole  which no preset stands behind any more
Scene read_expanded(Json whole) {
  // A part that is left out is not the default of its struct: its defaults may follow from
  // others.
  for (const std::string& part : scene_members().names())
    if (!given_member(whole, part)) whole[part] = Json::object();
  Reading reading;
  scene_members().read_whole(reading.scene, whole, At{reading, ""});
  return reading.scene;
}

}  // namespace

const Object<Scene>& scene_members() {
  static const ObjectOf<Scene> members = make_scene_members();
  return *members;
}

Scene read_scene(const Json& document) { return read_expanded(expanded(document)); }

Scene read_scene(const Json& document, const Json& patch) {
  return read_expanded(expanded(document, patch));
}

Json merge(const Json& document, const Json& patch) {
  return scene_members().merged(document, patch);
}

Json canonical(const Scene& scene) {
  Json document = scene_members().write(scene);
  Json& constituents = document["atmosphere"]["constituents"];
  // The document will be read over the preset that stands where none is named.
  const Json& base = expanded_preset(base_preset)["atmosphere"]["constituents"];
  for (const auto& [name, value] : base.items())
    if (!constituents.contains(name)) constituents[name] = nullptr;
  return document;
}

}  // namespace cyanometer
