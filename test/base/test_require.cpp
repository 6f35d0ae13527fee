#include "flute_grinder/base/require.h"
#include "refusal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace grinder {
namespace test_require {

TEST(Require, SaysNameValueAndWhatIsAllowed) {
  const auto refusal = [](double value) {
    return test_support::refusalOf<std::invalid_argument>(
        [&] { require(value < 1, "width", value, "less than 1", " m"); });
  };
  EXPECT_EQ(refusal(0.5), "");
  EXPECT_EQ(refusal(1.25), "width = 1.25 m; allowed: less than 1");
  EXPECT_EQ(refusal(std::nextafter(1, 2)), "width = 1.0000000000000002 m; allowed: less than 1");
  EXPECT_EQ(refusal(std::nan("")), "width = nan m; allowed: less than 1");
}

}  // namespace test_require
}  // namespace grinder
