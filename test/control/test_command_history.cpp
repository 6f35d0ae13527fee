#include "flute_grinder/control/command_history.h"

#include <gtest/gtest.h>

#include <memory>

namespace grinder {
namespace test_command_history {

CommandHistory::Entry entry(int number) {
  CommandHistory::Entry entry;
  entry.command.setConstant(number);
  entry.track.setpoints = static_cast<std::uint64_t>(number);
  return entry;
}

class CommandHistoryTest : public testing::Test {
 protected:
  void add(int first, int last) {
    for (int number = first; number <= last; ++number) history_->add(entry(number));
  }
  void expectInEffect(std::uint32_t waiting, int number) const {
    EXPECT_EQ(history_->inEffect(waiting).command[kX], number);
    EXPECT_EQ(history_->inEffect(waiting).track.setpoints, static_cast<std::uint64_t>(number));
  }

  std::unique_ptr<CommandHistory> history_ = std::make_unique<CommandHistory>();
};

TEST_F(CommandHistoryTest, IsEmptyAtFirstAndOnceCleared) {
  EXPECT_TRUE(history_->empty());
  add(1, 1);
  EXPECT_FALSE(history_->empty());
  history_->clear();
  EXPECT_TRUE(history_->empty());
}

TEST_F(CommandHistoryTest, InEffectIsTheOneBeforeThoseThatWaitAndAtMostTheOldest) {
  add(1, 10);
  expectInEffect(0, 10);
  expectInEffect(1, 9);
  expectInEffect(9, 1);
  expectInEffect(10, 1);
  expectInEffect(kMaxCommandsWaiting, 1);
}

TEST_F(CommandHistoryTest, HoldsAsManyAsADriveMayBuffer) {
  constexpr int kLast = 3 * static_cast<int>(kMaxCommandsWaiting);
  add(1, kLast);
  expectInEffect(kMaxCommandsWaiting, kLast - static_cast<int>(kMaxCommandsWaiting));
  expectInEffect(kMaxCommandsWaiting + 1, kLast - static_cast<int>(kMaxCommandsWaiting));
}

TEST_F(CommandHistoryTest, DoesNotReachBackBeyondAClear) {
  add(1, 10);
  history_->clear();
  add(11, 12);
  expectInEffect(1, 11);
  expectInEffect(5, 11);
}

}  // namespace test_command_history
}  // namespace grinder
