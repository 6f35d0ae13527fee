#include "flute_grinder/base/await.h"

#include <gtest/gtest.h>

namespace grinder {
namespace test_await {

using std::chrono::microseconds;
using std::chrono::milliseconds;

TEST(Await, EndsOnceItIsTrueAndLooksOnceMoreWhenTheTimeIsOver) {
  int looks = 0;
  EXPECT_TRUE(await(milliseconds(300000), microseconds(10), [&] { return ++looks == 3; }));
  EXPECT_EQ(looks, 3);
  EXPECT_TRUE(await(microseconds(0), microseconds(10), [&] { return ++looks == 4; }));
  EXPECT_FALSE(await(microseconds(0), microseconds(10), [&] { return ++looks == 6; }));
  EXPECT_EQ(looks, 5);
  EXPECT_TRUE(await(microseconds(1), microseconds(10), [&] { return ++looks == 7; })) << "the last look";
}

TEST(Await, AStallCountsAsTenSteps) {
  int looks = 0;
  // Each look takes as long as all of the time that there is.
  const auto stalled = [&] {
    std::this_thread::sleep_for(milliseconds(5));
    return ++looks == 6;
  };
  EXPECT_TRUE(await(milliseconds(5), microseconds(100), stalled)) << "five stalls count as 5 ms";
  EXPECT_FALSE(await(milliseconds(5), milliseconds(1), stalled));
  EXPECT_EQ(looks, 8) << "each counts wholly";
}

}  // namespace test_await
}  // namespace grinder
