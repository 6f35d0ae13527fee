#include "flute_grinder/control/command_history.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

namespace grinder {
namespace test_command_history {

class CommandHistoryTest : public testing::Test {
 protected:
  void add(int first, int last) {
    for (int number = first; number <= last; ++number) {
      CommandHistory::Entry entry;
      entry.command.setConstant(number);
      entry.track.setpoints = static_cast<std::uint64_t>(number);
      history_->add(entry);
    }
  }
  void expectInEffect(std::uint32_t waiting, int number) const {
    EXPECT_EQ(history_->inEffect(waiting).command[kX], number);
    EXPECT_EQ(history_->inEffect(waiting).track.setpoints, static_cast<std::uint64_t>(number));
  }

  std::unique_ptr<CommandHistory> history_ = std::make_unique<CommandHistory>();
};

TEST_F(CommandHistoryTest, InEffectIsTheOneBeforeThoseThatWaitAndAtMostTheOldestSinceAClear) {
  EXPECT_TRUE(history_->empty());
  add(1, 10);
  EXPECT_FALSE(history_->empty());
  for (const auto& [waiting, number] : {std::pair(0U, 10), {1U, 9}, {9U, 1}, {10U, 1}, {kMaxCommandsWaiting, 1}}) {
    expectInEffect(waiting, number);
  }
  history_->clear();
  EXPECT_TRUE(history_->empty());
  add(11, 12);
  expectInEffect(1, 11);
  expectInEffect(5, 11);
}

TEST_F(CommandHistoryTest, HoldsAsManyAsADriveMayBuffer) {
  constexpr int kLast = 3 * static_cast<int>(kMaxCommandsWaiting);
  add(1, kLast);
  expectInEffect(kMaxCommandsWaiting, kLast - static_cast<int>(kMaxCommandsWaiting));
  expectInEffect(kMaxCommandsWaiting + 1, kLast - static_cast<int>(kMaxCommandsWaiting));
}

}  // namespace test_command_history
}  // namespace grinder
