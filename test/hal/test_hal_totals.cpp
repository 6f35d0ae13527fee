#include "drive/hal_hardware.h"

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <algorithm>
#include <chrono>
#include <vector>

// The drive on the real HAL, written to as the control loop does, and the counts of commands at which HAL's FIFO of
// LinuxCNC 2.9 keeps the last one back: multiples of its depth. Alone on a fresh HAL, so that all that the FIFO ever
// got is counted.
namespace grinder {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kDepth = 4096;   ///< of the bench's streamer
constexpr std::uint32_t kBuffer = 1000;  ///< of totals.test
constexpr int kSamplerKey = 0x48534130;
constexpr const char* kSamplerTypes = "ffffffffbbus";
const ros::Duration kPeriod(0.001);
/// Longer than any host stalls.
constexpr std::chrono::seconds kPatience(30);

struct Row {
  Axes command;
  bool enabled;
  std::uint32_t played;
};

/// What the bench's sampler has recorded of each servo cycle.
class Recorder {
 public:
  Recorder() : component_("recorder") {
    if (hal_stream_attach(&stream_, component_.id(), kSamplerKey, kSamplerTypes) < 0)
      throw std::runtime_error("no sampler");
    component_.ready();
  }
  ~Recorder() { hal_stream_detach(&stream_); }

  const std::vector<Row>& read() {
    std::array<hal_stream_data, HAL_STREAM_MAX_PINS> d;
    while (hal_stream_readable(&stream_) && hal_stream_read(&stream_, d.data(), nullptr) >= 0) {
      rows_.push_back({Axes(d[0].f, d[1].f, d[2].f, d[3].f), d[8].b, d[10].u});
    }
    return rows_;
  }

 private:
  HalComponent component_;
  hal_stream_t stream_{};
  std::vector<Row> rows_;
};

bool same(const Axes& a, const Axes& b) { return (a == b).all(); }

class Totals : public ::testing::Test {
 protected:
  Totals() {
    ros::NodeHandle root("~"), own("~hardware");
    drive_.init(root, own);
  }

  static DriveCycle now() { return {ros::Time::now(), kPeriod, kPeriod}; }

  DriveStatus read() {
    drive_.read(now(), feedback_);
    return feedback_.status;
  }

  /// As of the control loop; the drive passes a command on while there is power.
  void cycle(bool enable) {
    drive_.wait(kPeriod);
    const bool powered = read().enabled;
    DriveCommand command;
    command.enable = enable;
    std::copy(command_.data(), command_.data() + kAxisCount, command.position.begin());
    drive_.write(now(), command);
    if (powered && enable) written_.push_back(command_);
  }

  void switchPower(bool on) {
    // The drive fills its buffer ahead of the power.
    if (on) written_.insert(written_.end(), kBuffer, command_);
    const auto deadline = Clock::now() + kPatience;
    while (read().enabled != on && Clock::now() < deadline) cycle(on);
    ASSERT_EQ(read().enabled, on);
  }

  /// Writes one new place after the other until the FIFO has got `total` commands since HAL was started.
  void moveUntil(std::size_t total) {
    while (written_.size() < total) {
      const std::size_t before = written_.size();
      command_ += Axes(1e-6, -2e-6, 3e-6, 1e-5);
      cycle(true);
      ASSERT_GT(written_.size(), before) << "the power was lost: the host stalled for longer than the buffer lasts";
    }
  }

  /// Writes the same place, as long as what was written before may wait in the FIFO.
  void rest() {
    for (std::uint32_t i = 0; i < 2 * kBuffer; ++i) cycle(true);
  }

  /// Every servo cycle with power up to here has played one command, the next one.
  void expectAllPlayed(std::size_t count) {
    std::vector<Row> rows;
    for (const Row& row : recorder_.read()) {
      if (row.enabled) rows.push_back(row);
    }
    ASSERT_GE(rows.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(rows[i].played, i + 1);
      ASSERT_TRUE(same(rows[i].command, written_[i])) << "command " << i + 1;
    }
  }

  Recorder recorder_;
  HalHardware drive_;
  DriveFeedback feedback_;
  Axes command_ = Axes::Zero();
  std::vector<Axes> written_;  ///< since HAL was started
};

TEST_F(Totals, LastSetpointIsPlayedAndNothingIsLeftBehind) {
  switchPower(true);
  for (const std::size_t total : {kDepth - 1, 2 * kDepth, 3 * kDepth + 1}) {
    ASSERT_NO_FATAL_FAILURE(moveUntil(total));
    rest();
    expectAllPlayed(total);
  }

  // A program that stops in the midst of a move, of all places there: HAL keeps the last command back, which must
  // neither count as played nor be played when there is power again.
  ASSERT_NO_FATAL_FAILURE(moveUntil(4 * kDepth));
  const auto deadline = Clock::now() + kPatience;
  while (read().enabled && Clock::now() < deadline) ros::WallDuration(0.001).sleep();
  const DriveStatus stopped = read();
  ASSERT_FALSE(stopped.enabled);
  EXPECT_GE(stopped.underruns, 1U);
  const Row last = recorder_.read().back();
  EXPECT_EQ(stopped.commands_waiting, 4 * kDepth - last.played);
  EXPECT_TRUE(same(last.command, written_[last.played - 1]));
  expectAllPlayed(last.played);
  RecordProperty("kept_back", static_cast<int>(stopped.commands_waiting));

  command_ = last.command;
  for (std::uint32_t i = 0; i < kBuffer; ++i) cycle(false);
  const std::size_t first = recorder_.read().size();
  switchPower(true);
  for (std::uint32_t i = 0; i < 2 * kBuffer; ++i) cycle(true);
  const std::vector<Row>& rows = recorder_.read();
  for (std::size_t i = first; i < rows.size(); ++i) EXPECT_TRUE(same(rows[i].command, last.command)) << "row " << i;
  switchPower(false);
}

TEST_F(Totals, PowerOffLastsAsLongAsPowerIsAskedFor) {
  read();
  std::copy(feedback_.position.begin(), feedback_.position.end(), command_.data());
  switchPower(true);
  EXPECT_TRUE(drive_.powerOff());
  EXPECT_FALSE(read().enabled) << "ahead of HAL";
  for (std::uint32_t i = 0; i < kBuffer; ++i) cycle(true);
  EXPECT_FALSE(read().enabled);
  cycle(false);
  switchPower(true);
  switchPower(false);
}

}  // namespace
}  // namespace grinder

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_hal_totals");
  return RUN_ALL_TESTS();
}
