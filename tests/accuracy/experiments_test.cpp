// What the experiments find, on few rays.
#include "engine/experiments/experiments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "tests/device.h"

namespace cyanometer {
namespace {

const ExperimentSettings few{.rays = 32, .pixels = 1024, .most_samples = 16};

/// The numbers of a table's body, [row][column]; without the first column.
std::vector<std::vector<double>> numbers(const std::string& markdown) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(markdown);
  int line_number = 0;
  for (std::string line; std::getline(lines, line) && line.starts_with("|"); ++line_number) {
    if (line_number < 2) continue;
    std::istringstream cells(line.substr(line.find('|', 1) + 1));
    std::vector<double>& row = rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, '|');)
      row.push_back(std::strtod(cell.c_str(), nullptr));
  }
  return rows;
}

TEST(Experiments, MoreOrdersLeaveLessOut) {
  const auto rows = numbers(orders_kept(device(), few, {}).markdown);
  ASSERT_EQ(rows.size(), 6u);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    for (std::size_t sky = 0; sky < 4; ++sky) EXPECT_LT(rows[i][sky], rows[i - 1][sky]);
  }
}

TEST(Experiments, TenPairsEndNearTheTruth) {
  const auto rows = numbers(sample_pairs(device(), few, {}).markdown);
  ASSERT_EQ(rows.size(), 10u);
  for (std::size_t sun = 0; sun < 3; ++sun) {
    EXPECT_GT(rows.front()[sun], 10);
    EXPECT_LT(rows.back()[sun], 0.5);
  }
  EXPECT_GT(rows.front()[3], rows.back()[3]) << "frames a second";
}

TEST(Experiments, TheMapHasACellForEachPairAndMarksTheBest) {
  const Finding found = sample_map(device(), few, {});
  ASSERT_EQ(found.files.size(), 3u);
  for (const auto& [name, svg] : found.files) {
    EXPECT_THAT(found.markdown, ::testing::HasSubstr(name));
    std::size_t cells = 0;
    for (std::size_t at = 0; (at = svg.find("<rect x=", at)) != std::string::npos; ++at)
      ++cells;
    EXPECT_EQ(cells, 4u * 5);
    EXPECT_THAT(svg, ::testing::HasSubstr("class=\"best\""));
  }
}

TEST(Experiments, ACurveBurnsOutLessThanCuttingOff) {
  const Finding found = with_and_without_hdr(device(), few, {});
  EXPECT_EQ(found.files.size(), 4u);
  const auto rows = numbers(found.markdown.substr(found.markdown.find("| burnt out")));
  ASSERT_EQ(rows.size(), 2u);
  for (const auto& row : rows) EXPECT_LT(row[1], row[0]);
}

TEST(Experiments, AHigherTopAddsNothingButCoarserSteps) {
  const auto rows = numbers(heights_of_the_top(device(), few, {}).markdown);
  ASSERT_EQ(rows.size(), 8u);
  for (std::size_t i = 2; i < rows.size(); ++i) {
    EXPECT_LE(rows[i][0], rows[i - 1][0]);
    EXPECT_GT(rows[i][1], rows[i - 1][1]);
  }
}

}  // namespace
}  // namespace cyanometer
