#include "scene/scale.h"

#include "flute_grinder/base/units.h"

#include <gtest/gtest.h>

#include <cmath>
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
    for (const Marker& m : array.markers) {
      if (m.type != Marker::TEXT_VIEW_FACING) continue;
      EXPECT_EQ(m.header.frame_id, "work");
      EXPECT_LT(m.pose.position.y, -cutter.end_diameter / 2);
      if (std::isdigit(m.text.front()) == 0) {
        texts += m.text + '\n';
        continue;
      }
      numbers.push_back(std::stod(m.text));
      EXPECT_NEAR(m.pose.position.x, numbers.back() * kMillimetre, 1e-9) << m.text;
    }
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
