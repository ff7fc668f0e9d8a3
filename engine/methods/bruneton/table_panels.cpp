#include "engine/methods/bruneton/table_panels.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/glm.hpp>

namespace cyanometer::bruneton {
namespace {

std::string label(const char* format, double value) {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::vector<std::string> labels(const char* format, const std::vector<double>& values) {
  std::vector<std::string> all;
  for (double value : values) all.push_back(label(format, value));
  return all;
}

/// Of the sun's zenith cosines.
std::vector<std::string> sun_labels(std::vector<double> cosines, const char* format) {
  for (double& c : cosines) c = glm::degrees(std::asin(std::clamp(c, -1.0, 1.0)));
  return labels(format, cosines);
}

Panels panels_over(const ScatteringGrid& grid, const Places& places) {
  Panels panels;
  panels.rows = {"altitude", labels("%.3g km", places.altitudes_km), grid.altitudes};
  panels.columns = {"elevation of the sun", sun_labels(places.sun_cosines, "sun %.1f deg"),
                    grid.suns};
  panels.across = {"azimuth from the sun in deg", {"0", "90", "180"}, grid.azimuths};
  panels.down = {"zenith angle in deg", {"0", "90", "180"}, grid.zeniths};
  return panels;
}

/// Over a table's rays, whose nodes begin with their altitudes and suns.
Panels panels_over(const Rays& rays) {
  const ScatteringGrid& grid = rays.grid;
  auto suns = rays.nodes.begin() + grid.altitudes;
  Panels panels = panels_over(grid, {{rays.nodes.begin(), suns}, {suns, suns + grid.suns}});
  bool from_space = grid.highest_mu <= 0;
  panels.down.quantity = from_space ? "view from along the top to straight down by node"
                                    : "view from up over the horizon to straight down by node";
  panels.down.labels = {from_space ? "along" : "up", "horizon", "down"};
  return panels;
}

/// Reads a table of vec4 by group of wavelengths, from its quantity with this index on.
void read_values(const vulkan::Buffer& buffer, std::size_t first_group, const Problem& problem,
                 bool logarithmic, Panels& panels) {
  std::size_t size = std::size_t{1} * panels.rows.nodes * panels.columns.nodes *
                     panels.down.nodes * panels.across.nodes;
  panels.wavelengths_nm = problem.wavelengths_nm;
  std::vector<glm::vec4> group(size);
  for (std::size_t w = 0; w < panels.wavelengths_nm.size(); ++w) {
    if (w % 4 == 0) {
      buffer.read((first_group + w / 4) * size * sizeof(glm::vec4),
                  std::as_writable_bytes(std::span(group)));
    }
    std::vector<float>& plane = panels.values.emplace_back();
    for (const glm::vec4& four : group) {
      float value = four[static_cast<int>(w % 4)];
      plane.push_back(logarithmic ? std::exp(value) : value);
    }
  }
}

/// Tables of rays begin straight down; pictures have the sky above.
void turn_upside_down(Panels& panels) {
  auto row = static_cast<std::ptrdiff_t>(panels.across.nodes),
       rows = std::ptrdiff_t{panels.down.nodes};
  for (std::vector<float>& plane : panels.values) {
    for (auto panel = plane.begin(); panel != plane.end(); panel += row * rows) {
      for (std::ptrdiff_t y = 0; y < rows / 2; ++y) {
        std::swap_ranges(panel + y * row, panel + (y + 1) * row, panel + (rows - 1 - y) * row);
      }
    }
  }
}

Panels source_panels(const SourceTables& tables, const Problem& problem, const Setup& setup) {
  Panels panels = panels_over(tables.grid, source_places(problem, setup));
  panels.name = "source";
  panels.title =
      "source - orders from 2 on scattered into a view per scattering coefficient - per sr";
  read_values(tables.source, 0, problem, setup.logarithmic, panels);
  return panels;
}

Panels irradiance_panels(const SourceTables& tables, const Problem& problem,
                         const Setup& setup) {
  Panels panels;
  panels.name = "irradiance";
  panels.title = "irradiance - diffuse light on the ground per irradiance of the sun";
  std::vector<std::string> all = sun_labels(source_places(problem, setup).sun_cosines, "%.1f");
  panels.across = {"elevation of the sun in deg by node",
                   {all.front(), all[all.size() / 2], all.back()},
                   tables.grid.suns};
  read_values(tables.irradiance, 0, problem, setup.logarithmic, panels);
  return panels;
}

Panels view_panels(const ViewTable& table, const Problem& problem, const Setup& setup) {
  Panels panels = panels_over(table.rays.rays);
  panels.name = "view";
  panels.title = "view - light of orders from 2 on scattered along a path - per sr";
  read_values(table.values, 0, problem, setup.logarithmic, panels);
  turn_upside_down(panels);
  return panels;
}

/// Of one constituent, in the device's order.
Panels single_panels(const SingleTable& table, const UploadedScene& scene, int constituent) {
  Panels panels = panels_over(table.rays.rays);
  const std::string& name = packed_media(scene.problem())[constituent]->name;
  panels.name = "first_order_" + name;
  panels.title = "first order of " + name + " - lit and attenuated density along a path - km";
  read_values(table.values, std::size_t{1} * constituent * scene.groups(), scene.problem(),
              false, panels);
  turn_upside_down(panels);
  return panels;
}

}  // namespace

std::vector<Panels> table_panels(TableMaker& maker, Tracer& tracer, const UploadedScene& scene,
                                 const Setup& setup) {
  const Problem& problem = scene.problem();
  std::vector<Panels> all;
  if (has_multiple(problem)) {
    auto sources = maker.source(tracer, scene, setup);
    auto view = maker.view(tracer, scene, setup);
    all.push_back(source_panels(*sources, problem, setup));
    all.push_back(irradiance_panels(*sources, problem, setup));
    all.push_back(view_panels(*view, problem, setup));
  }
  if (setup.first == Setup::First::separate) {
    auto single = maker.single(tracer, scene, setup);
    for (int c = 0; c < scene.media(); ++c) all.push_back(single_panels(*single, scene, c));
  }
  return all;
}

}  // namespace cyanometer::bruneton
