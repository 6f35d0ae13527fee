#include "node/served_queue.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <future>

namespace grinder {
namespace test_served_queue {

constexpr double kShort = 0.001;  ///< [s]
constexpr double kHour = 3600;    ///< [s]

TEST(ServedQueue, AShorterPeriodCountsAtOnceAndALongerOneSetByPollForTheNextPoll) {
  std::promise<void> done;
  int polls = 0;
  std::function<void()> poll;
  ServedQueue queue{kHour, [&] { poll(); }};
  poll = [&] {
    if (++polls == 1) queue.post([&] { done.set_value(); });
    queue.setPeriod(kHour);
  };
  queue.start();
  queue.post([&] { queue.setPeriod(kShort); });
  EXPECT_EQ(done.get_future().wait_for(std::chrono::seconds(60)), std::future_status::ready);
  queue.stop();
  EXPECT_EQ(polls, 1);
}

}  // namespace test_served_queue
}  // namespace grinder
