#include "scene/scale.h"

#include "flute_grinder/base/units.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace grinder {
namespace test_scale {

using units::kMillimetre;
using visualization_msgs::Marker;

TEST(Scale, HasAFewRoundNumbersWhateverTheLength) {
  std::vector<double> lengths{0.5, 1, 2, 5, 10, 20, 50, 100};
  for (double length = 0.3; length < 200; length *= 1.03) lengths.push_back(length);
  for (const double length : lengths) {
    CutterGeometry cutter;
    cutter.end_diameter = length / 2 * kMillimetre;
    cutter.flute_length = length * kMillimetre;
    visualization_msgs::MarkerArray array;
    appendScale(array, cutter, "Planned: a job (2).yaml (D 10 mm)");
    std::vector<double> numbers;
    std::string texts;
    std::set<double> ticks, ends;  // of the ticks: X and -Y
    double nearest = -1;           // text [m]
    for (const Marker& m : array.markers) {
      EXPECT_EQ(m.pose.orientation.w, 1);
      if (m.type == Marker::LINE_LIST) {
        EXPECT_LT(m.scale.x, 0.02 * cutter.flute_length);
        for (std::size_t i = 0; i + 1 < m.points.size(); i += 2) {
          const geometry_msgs::Point &from = m.points[i], &to = m.points[i + 1];
          EXPECT_LT(from.y, -cutter.end_diameter / 2);
          if (from.y == to.y) continue;
          EXPECT_EQ(from.x, to.x);
          ticks.insert(from.x);
          ends.insert(-to.y);
        }
      }
      if (m.type != Marker::TEXT_VIEW_FACING) continue;
      nearest = std::max(nearest, m.pose.position.y);
      EXPECT_GT(m.scale.z, 0.03 * cutter.flute_length);
      EXPECT_LT(m.scale.z, 0.1 * cutter.flute_length);
      EXPECT_EQ(m.header.frame_id, "work");
      EXPECT_LT(m.pose.position.y, -cutter.end_diameter / 2);
      if (std::isdigit(m.text.front()) == 0) {
        texts += m.text + '\n';
        continue;
      }
      numbers.push_back(std::stod(m.text));
      EXPECT_NEAR(m.pose.position.x, numbers.back() * kMillimetre, 1e-9) << m.text;
    }
    ASSERT_EQ(ends.size(), 1u) << "of the same length";
    EXPECT_GT(*ends.begin(), cutter.end_diameter / 2);
    EXPECT_LT(*ends.begin(), -nearest) << "toward the numbers";
    for (const double number : numbers) {
      EXPECT_TRUE(
          std::any_of(ticks.begin(), ticks.end(), [&](double x) { return std::abs(x - number * kMillimetre) < 1e-9; }));
    }
    ASSERT_FALSE(ticks.empty());
    EXPECT_NEAR(*ticks.rbegin(), cutter.flute_length, 1e-9);
    ASSERT_GE(numbers.size(), 4U) << length;
    ASSERT_LE(numbers.size(), 8U) << length;
    EXPECT_LE(numbers.back(), length * (1 + 1e-9));
    const double step = numbers[1], digit = step / std::pow(10, std::floor(std::log10(step * 1.000001)));
    EXPECT_TRUE(std::abs(digit - 1) < 1e-5 || std::abs(digit - 2) < 1e-5 || std::abs(digit - 5) < 1e-5) << step;
    EXPECT_NE(texts.find("Planned: a job (2).yaml\nflutes "), std::string::npos) << texts;
    EXPECT_NE(texts.find(" mm long (D 10 mm)"), std::string::npos) << texts;
  }
}

}  // namespace test_scale
}  // namespace grinder
