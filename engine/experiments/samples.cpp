// How the samples of a nested march are best spent.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "engine/accuracy/chart.h"
#include "engine/accuracy/svg.h"
#include "engine/experiments/experiments.h"
#include "engine/experiments/measured.h"

namespace cyanometer {
namespace {

using nlohmann::json;

struct Pair {
  int view, light;
  /// Densities along the view ray and from each of its samples to the sun.
  double cost() const { return view * (light + 1.0); }
};

/// The thesis's own scene, its sun high and low.
Scene of_thesis(double sun_deg, int pixels) {
  return scene_of_preset(
      "thesis_defaults",
      {{"method", {{"scattering_orders", 1}}}, {"sun", {{"elevation_deg", sun_deg}}}}, pixels);
}

std::map<std::string, double> options_of(Pair pair) {
  return {{"view_samples", pair.view}, {"light_samples", pair.light}};
}

constexpr double suns_deg[] = {60, 20, 2};

struct Cell {
  Pair pair;
  double error;
};

/// Errors of all pairs of powers of two.
std::vector<Cell> cells_of(Engine& engine, const Scene& scene, int rays, int most,
                           const Watch& watch) {
  const std::vector<Direction> directions = sample_directions(scene, rays);
  const RayValues truth = finest_of(engine, scene, directions, watch);
  std::vector<Cell> cells;
  for (int view = 2; view <= most; view *= 2) {
    for (int light = 1; light <= most; light *= 2) {
      const Pair pair{view, light};
      const RayValues values =
          seen_by(engine, scene, directions, "nishita", options_of(pair), watch);
      cells.push_back({pair, measure_error(values, truth).error});
    }
  }
  return cells;
}

/// Those that no other of at most the same cost beats, cheapest first.
std::vector<Cell> best_splits(std::vector<Cell> cells) {
  std::ranges::sort(cells, {}, [](const Cell& cell) { return cell.pair.cost(); });
  std::vector<Cell> best;
  for (const Cell& cell : cells) {
    if (best.empty() || cell.error < best.back().error) best.push_back(cell);
  }
  return best;
}

/// From yellow, 1e-5, to blue-black, 1: light is good on white, and the label says the rest.
std::string colour_of(double error) {
  const double share = std::clamp((std::log10(std::max(error, 1e-5)) + 5) / 5, 0.0, 1.0);
  const std::array<std::array<double, 3>, 4> stops{
      {{253, 231, 150}, {94, 201, 140}, {49, 104, 142}, {48, 10, 64}}};
  const double at = share * 3;
  const auto low = std::min(static_cast<std::size_t>(at), std::size_t{2});
  char text[32];
  const auto channel = [&](std::size_t c) {
    return std::lround(std::lerp(stops[low][c], stops[low + 1][c], at - double(low)));
  };
  std::snprintf(text, sizeof text, "#%02lx%02lx%02lx", channel(0), channel(1), channel(2));
  return text;
}

constexpr double cell_px = 46, left_px = 70, top_px = 64;

double x_of(double light) { return left_px + (std::log2(light) + 0.5) * cell_px; }
double y_of(double view, int most) {
  return top_px + (std::log2(most) - std::log2(view) + 0.5) * cell_px;
}

void draw_cell(Svg& svg, const Cell& cell, int most) {
  const double x = x_of(cell.pair.light), y = y_of(cell.pair.view, most);
  svg.out() << "<rect x=\"" << x - cell_px / 2 << "\" y=\"" << y - cell_px / 2 << "\" width=\""
            << cell_px << "\" height=\"" << cell_px << "\" fill=\"" << colour_of(cell.error)
            << "\"/>\n";
  svg.text(x, y + 4, percent(cell.error), cell.error > 3e-3 ? "on-dark" : "on-light", "middle");
}

void draw_costs(Svg& svg, int most) {
  for (double cost = 16; cost <= double(most) * most; cost *= 8) {
    svg.out() << "<polyline class=\"cost\" points=\"";
    for (double light = 0.75; light <= most * 1.4; light *= 1.1) {
      const double view = cost / (light + 1);
      if (view > most * 1.4 || view < 1.45) continue;
      svg.out() << x_of(light) << "," << y_of(view, most) << " ";
    }
    svg.out() << "\"/>\n";
  }
}

std::string map_svg(const std::vector<Cell>& cells, double sun_deg, int most) {
  const double columns = std::log2(most) + 1, rows = std::log2(most);
  char title[96];
  std::snprintf(title, sizeof title, "Error of the nested march, sun at %g°", sun_deg);
  Svg svg(left_px + columns * cell_px + 20, top_px + rows * cell_px + 66, title, R"(
.on-dark { fill: #fff; font-size: 10px } .on-light { fill: #222; font-size: 10px }
.cost { fill: none; stroke: #fff; stroke-width: 1.5; stroke-dasharray: 5 4 }
.best { fill: none; stroke: #e8590c; stroke-width: 3 }
)");
  svg.text(left_px, 28, title, "title");
  svg.text(left_px, 48, "orange: the best split of its cost; dashed: equal cost", "faint");
  for (const Cell& cell : cells) draw_cell(svg, cell, most);
  draw_costs(svg, most);
  for (const Cell& cell : best_splits(cells)) {
    svg.out() << "<rect class=\"best\" x=\"" << x_of(cell.pair.light) - cell_px / 2 + 2
              << "\" y=\"" << y_of(cell.pair.view, most) - cell_px / 2 + 2 << "\" width=\""
              << cell_px - 4 << "\" height=\"" << cell_px - 4 << "\"/>\n";
  }
  for (int samples = 1; samples <= most; samples *= 2) {
    svg.text(x_of(samples), top_px + rows * cell_px + 18, std::to_string(samples), "",
             "middle");
    if (samples > 1)
      svg.text(left_px - 8, y_of(samples, most) + 4, std::to_string(samples), "", "end");
  }
  svg.text(left_px, top_px + rows * cell_px + 42, "light samples; upwards view samples",
           "faint");
  return svg.finish();
}

/// What the best splits say of the claim that samples towards the sun matter more.
std::string verdict(const std::vector<Cell>& cells) {
  const std::vector<Cell> best = best_splits(cells);
  double ratio = 0;
  int counted = 0;
  for (const Cell& cell : best) {
    if (cell.error > 0.3 || cell.error < 1e-3) continue;
    ratio += std::log2(double(cell.pair.view) / cell.pair.light);
    ++counted;
  }
  char text[160];
  std::snprintf(text, sizeof text, "%.2g view samples for each light sample",
                std::exp2(ratio / std::max(counted, 1)));
  return text;
}

}  // namespace

Finding sample_pairs(Engine& engine, const ExperimentSettings& settings, const Watch& watch) {
  constexpr Pair pairs[] = {{4, 2},   {8, 4},   {16, 4},  {16, 8},   {32, 8},
                            {32, 16}, {64, 16}, {64, 32}, {128, 32}, {256, 64}};
  std::string out = "| view x light samples |";
  std::string rule = "|---|";
  for (double sun : suns_deg) {
    out += " error, sun at " + degrees(sun) + " |";
    rule += "---|";
  }
  out += " frames a second |\n" + rule + "---|\n";
  ChartSettings timing;
  timing.pixels = settings.pixels;
  for (const Pair& pair : pairs) {
    out += "| " + std::to_string(pair.view) + " x " + std::to_string(pair.light) + " |";
    double frame_ms = 0;
    for (double sun : suns_deg) {
      const Scene scene = of_thesis(sun, settings.pixels);
      const std::vector<Direction> directions = sample_directions(scene, settings.rays);
      const RayValues truth = finest_of(engine, scene, directions, watch);
      const ChartPoint point = measure_point(engine, scene, {directions, {truth, truth}},
                                             "nishita", options_of(pair), timing, watch);
      out += " " + percent(point.error.measure.error) + " |";
      frame_ms = point.frame_ms;
    }
    char rate[32];
    std::snprintf(rate, sizeof rate, " %.3g |\n", 1000 / frame_ms);
    out += rate;
  }
  return {out, {}};
}

Finding sample_map(Engine& engine, const ExperimentSettings& settings, const Watch& watch) {
  Finding finding;
  std::string words;
  for (double sun : suns_deg) {
    const std::vector<Cell> cells = cells_of(engine, of_thesis(sun, settings.pixels),
                                             settings.rays, settings.most_samples, watch);
    const std::string name = "samples_" + std::to_string(int(sun)) + "deg.svg";
    finding.files[name] = map_svg(cells, sun, settings.most_samples);
    finding.markdown +=
        "![Error by samples, sun at " + std::to_string(int(sun)) + " deg](" + name + ")\n";
    words += (words.empty() ? "" : ", ") + verdict(cells) + " with the sun at " + degrees(sun);
  }
  finding.markdown += "\nThe best splits of a cost, between errors of 30 and 0.1 %, have " +
                      words + " (geometric means).\n";
  return finding;
}

}  // namespace cyanometer
