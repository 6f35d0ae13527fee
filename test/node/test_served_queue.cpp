#include "node/served_queue.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <future>

namespace grinder {
namespace test_served_queue {

constexpr double kShort = 0.001;  ///< [s]
constexpr double kHour = 3600;    ///< [s]
constexpr std::chrono::seconds kPatience(60);

class ServedQueueTest : public testing::Test {
 protected:
  ~ServedQueueTest() override { queue_.stop(); }

  bool soon() { return done_.get_future().wait_for(kPatience) == std::future_status::ready; }

  std::promise<void> done_;
  std::function<void()> poll_ = [] {};
  ServedQueue queue_{kHour, [this] { poll_(); }};
};

TEST_F(ServedQueueTest, AShorterPeriodCountsAtOnce) {
  poll_ = [this] {
    done_.set_value();
    queue_.setPeriod(kHour);
  };
  queue_.start();
  queue_.post([this] { queue_.setPeriod(kShort); });
  EXPECT_TRUE(soon());
}

TEST_F(ServedQueueTest, ALongerPeriodSetByPollCountsForTheNextPoll) {
  int polls = 0;
  poll_ = [this, &polls] {
    if (++polls == 1) queue_.post([this] { done_.set_value(); });
    queue_.setPeriod(kHour);
  };
  queue_.start();
  queue_.post([this] { queue_.setPeriod(kShort); });
  EXPECT_TRUE(soon());
  queue_.stop();
  EXPECT_EQ(polls, 1);
}

}  // namespace test_served_queue
}  // namespace grinder
