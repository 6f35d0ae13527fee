#include "flute_grinder/base/on_all_cores.h"
#include "refusal.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>

namespace grinder {
namespace test_on_all_cores {

TEST(OnAllCores, CallsForEachOnceAndThrowsWhatTheFirstInOrderDid) {
  for (const std::size_t count : {0, 1, 2, 1000}) {
    std::vector<std::atomic<int>> calls(count);
    onAllCores(count, [&](std::size_t i) { ++calls[i]; });
    for (const auto& times : calls) EXPECT_EQ(times, 1);
  }
  std::atomic<int> calls{0};
  const auto count_and_throw = [&](std::size_t i) {
    ++calls;
    if (i >= 17) throw std::runtime_error(std::to_string(i));
  };
  EXPECT_EQ(test_support::refusalOf<std::runtime_error>([&] { onAllCores(100, count_and_throw); }), "17");
  EXPECT_EQ(calls, 100);
}

}  // namespace test_on_all_cores
}  // namespace grinder
