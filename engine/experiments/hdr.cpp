// Pictures of the nested march, as graphics cards of 2004 could afford it and as it is
// converged, cut off at white and through a curve that keeps what is brighter.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/experiments/experiments.h"
#include "engine/experiments/measured.h"
#include "engine/image/encode.h"
#include "engine/scene/document.h"

namespace cyanometer {
namespace {

using nlohmann::json;

/// Share of the pixels that are as bright as can be in some channel.
double burnt_out(const Frame& frame) {
  const std::size_t pixels = std::size_t(frame.width) * frame.height;
  std::size_t burnt = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    const unsigned char* pixel = frame.rgbx + 4 * i;
    burnt += std::max({pixel[0], pixel[1], pixel[2]}) == 255;
  }
  return static_cast<double>(burnt) / static_cast<double>(pixels);
}

/// [O'Neil 2005, GPU Gems 2, chapter 16]: air as thick as a fortieth of the radius, a quarter
/// of that as its scale height for molecules and particles alike, 650, 570 and 475 nm, five
/// samples, and a forward peak with a g of 0.99.
json of_o_neil() {
  const double thickness_km = 6371.0 / 40, scale_km = thickness_km / 4;
  const json falling{{"type", "exponential"}, {"scale_height_km", scale_km}};
  // K 4 pi over the thickness, as its integral counts lengths; molecules as wavelength^-4 in
  // micrometres.
  const double four_pi = 12.566370614, molecules = 0.0025 * four_pi / thickness_km,
               particles = 0.0010 * four_pi / thickness_km;
  const auto rayleigh = [&](double um) { return molecules / (um * um * um * um); };
  return {{"planet", {{"radius_km", 6371}, {"ground_albedo", 0.1}}},
          {"atmosphere",
           {{"thickness_km", thickness_km},
            {"constituents",
             {{"ozone", nullptr},
              {"air",
               {{"type", "molecules"},
                {"scattering_per_km",
                 {{"wavelengths_nm", {475, 570, 650}},
                  {"values", {rayleigh(0.475), rayleigh(0.570), rayleigh(0.650)}}}},
                {"profile", falling}}},
              {"aerosol",
               {{"type", "particles"},
                {"scattering_per_km", particles},
                {"absorption_per_km", 0},
                {"phase", {{"type", "cornette_shanks"}, {"g", 0.99}}},
                {"profile", falling}}}}}}},
          {"spectrum", {{"wavelengths_nm", {650, 570, 475}}}},
          {"method", {{"name", "nishita"}, {"view_samples", 5}, {"light_samples", 5}}}};
}

json of_nishita() {
  return {{"preset", "thesis_defaults"},
          {"method", {{"name", "nishita"}, {"view_samples", 128}, {"light_samples", 32}}}};
}

}  // namespace

Finding with_and_without_hdr(Engine& engine, const ExperimentSettings& settings,
                             const Watch& watch) {
  const int width = settings.pixels >= 57600 ? 320 : 64;
  Finding finding;
  std::string
      pictures = "| | cut off at white | through a curve |\n|---|---|---|\n",
      figures = "\n| burnt out pixels | cut off at white | through a curve |\n|---|---|---|\n";
  for (const auto& [name, words, document] :
       {std::tuple{"nishita", "Nishita's air, 128 x 32 samples", of_nishita()},
        std::tuple{"o_neil", "O'Neil's air, 5 x 5 samples", of_o_neil()}}) {
    pictures += "| " + std::string(words) + " |";
    figures += "| " + std::string(words) + " |";
    for (const char* tone_map : {"linear", "exponential"}) {
      json asked = document;
      asked.update({{"sun", {{"elevation_deg", 6}, {"azimuth_deg", 15}}},
                    {"camera", {{"altitude_km", 0.01}, {"pitch_deg", 12}, {"fov_deg", 60}}},
                    {"image",
                     {{"width", width},
                      {"height", width * 9 / 16},
                      {"tone_map", tone_map},
                      {"exposure_ev", 2}}}},
                   true);
      const Scene scene = read_scene(asked);
      const Frame frame = engine.render(scene, watch);
      const std::string file = std::string(name) + "_" + tone_map + ".png";
      finding.files[file] = encode(frame, scene);
      pictures += " ![" + std::string(words) + ", " + tone_map + "](" + file + ") |";
      figures += " " + percent(burnt_out(frame)) + " |";
    }
    pictures += "\n";
    figures += "\n";
  }
  finding.markdown = pictures + figures;
  return finding;
}

}  // namespace cyanometer
