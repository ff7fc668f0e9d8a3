// What the mappings of precomputed tables are worth.
#include <nlohmann/json.hpp>

#include "engine/accuracy/error.h"
#include "engine/experiments/experiments.h"
#include "engine/experiments/measured.h"

namespace cyanometer {

Finding table_mappings(Engine& engine, const ExperimentSettings& settings, const Watch& watch) {
  struct Mapping {
    const char* words;
    double mapping, horizon;
  };
  constexpr Mapping mappings[] = {{"linear", 0, 0},
                                  {"linear, split at the horizon", 0, 1},
                                  {"by distances [Bruneton and Neyret 2008]", 1, 1},
                                  {"gathered at horizon and terminator", 2, 1}};
  constexpr const char* skies[] = {"earth_noon", "earth_low_sun", "earth_twilight"};
  std::string head = "| mapping |", rule = "|---|";
  std::vector<std::string> rows(std::size(mappings));
  for (const char* sky : skies) {
    head += " `" + std::string(sky) + "` |";
    rule += "---|";
    const Scene scene = scene_of_preset(sky, nlohmann::json::object(), settings.pixels);
    const std::vector<Direction> directions = sample_directions(scene, settings.rays);
    const RayValues truth = finest_of(engine, scene, directions, watch);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      // As tables are read from the shaders of old: nothing is gathered for the view, no
      // logarithms, and order one is in them too.
      const RayValues values = seen_by(engine, scene, directions, "bruneton",
                                       {{"altitudes", 8},
                                        {"zeniths", 16},
                                        {"suns", 16},
                                        {"azimuths", 7},
                                        {"gather", 0},
                                        {"logarithmic", 0},
                                        {"first_order", 1},
                                        {"mapping", mappings[i].mapping},
                                        {"horizon", mappings[i].horizon}},
                                       watch);
      engine.forget_tables();
      rows[i] += " " + percent(measure_error(values, truth).error) + " |";
    }
  }
  std::string out = head + "\n" + rule + "\n";
  for (std::size_t i = 0; i < rows.size(); ++i)
    out += "| " + std::string(mappings[i].words) + " |" + rows[i] + "\n";
  return {out, {}};
}

}  // namespace cyanometer
