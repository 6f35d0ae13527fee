#include "flute_grinder/base/await.h"

#include <gtest/gtest.h>

namespace grinder {
namespace test_await {

using std::chrono::microseconds;

TEST(Await, LooksOncePerStepAndAtTheEndAndNoMoreOnceItIsTrue) {
  int looks = 0;
  EXPECT_FALSE(await(microseconds(30), microseconds(10), [&] { return ++looks, false; }));
  EXPECT_EQ(looks, 4);
  EXPECT_TRUE(await(microseconds(30), microseconds(10), [&] { return ++looks == 8; })) << "the last look counts, too";
  EXPECT_TRUE(await(microseconds(0), microseconds(10), [&] { return ++looks == 9; }));
  EXPECT_FALSE(await(microseconds(25), microseconds(10), [&] { return ++looks, false; }));
  EXPECT_EQ(looks, 13);
}

}  // namespace test_await
}  // namespace grinder
