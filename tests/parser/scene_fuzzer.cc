// libFuzzer's target: any bytes are read as a scene or refused; what is read has one canonical
// form, which reads back as the same scene. Inputs grow from documents that the schema
// describes. (Not a .cpp: those are programs of GoogleTest.)
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "engine/scene/document.h"
#include "tests/scene/random_document.h"

namespace {

using namespace cyanometer;

[[noreturn]] void fail(const char* law) {
  std::fprintf(stderr, "broken: %s\n", law);
  std::abort();
}

#ifdef SEEDED_BUG
/// Shows that what takes two members at once to reach is found.
void seeded_bug(const Scene& scene) {
  if (scene.sun.distance_km && scene.camera.projection == Projection::cubemap) {
    fail("the seeded bug");
  }
}
#endif

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* bytes, std::size_t size) {
  Scene scene;
  try {
    scene = read_scene(parse_json({reinterpret_cast<const char*>(bytes), size}));
  } catch (const SceneError& error) {
    if (std::strlen(error.what()) == 0) fail("a refusal says why");
    return 0;
  }
#ifdef SEEDED_BUG
  seeded_bug(scene);
#endif
  const auto document = canonical(scene);
  if (read_scene(parse_json(document.dump())) != scene) fail("the canonical form reads back");
  if (canonical(read_scene(document)) != document) fail("there is one canonical form");
  return 0;
}

extern "C" std::size_t LLVMFuzzerMutate(unsigned char* bytes, std::size_t size,
                                        std::size_t most);

/// Some inputs are fresh documents; the others are changed byte by byte.
extern "C" std::size_t LLVMFuzzerCustomMutator(unsigned char* bytes, std::size_t size,
                                               std::size_t most, unsigned seed) {
  static const auto schema = scene_schema();
  if (seed % 8 != 0) return LLVMFuzzerMutate(bytes, size, most);
  const std::string text = RandomDocument(schema, seed).next().dump();
  if (text.size() > most) return LLVMFuzzerMutate(bytes, size, most);
  std::memcpy(bytes, text.data(), text.size());
  return text.size();
}
