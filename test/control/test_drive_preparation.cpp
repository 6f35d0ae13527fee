#include "control/rig.h"
#include "soon.h"

#include <atomic>
#include <functional>
#include <stdexcept>
#include <thread>
#include <utility>

// A drive that is to be made ready before the power, by what may block.
namespace grinder::test_support {
namespace test_drive_preparation {

/// Of prepare(), which a test opens.
struct Gate {
  std::atomic<bool> open{false}, has_visitor{false};

  void pass() {
    has_visitor = true;
    while (!open) std::this_thread::yield();
  }
  void awaitVisitor() const {
    while (!has_visitor) std::this_thread::yield();
  }
};

class Preparation : public testing::Test {
 protected:
  ~Preparation() override { gate.open = true; }

  /// @param timeout of an enable [s].
  void make(double timeout, std::function<void()> on_prepare) {
    LoopConfig config = machineConfig();
    config.enable_timeout = timeout;
    made_.emplace(config, [&](FakeDrive& drive) {
      drive.can.prepares = true;
      drive.on_prepare = std::move(on_prepare);
    });
  }
  Rig<FakeDrive>& rig() { return *made_; }
  bool isPowerOn() { return rig().drive.written_drive.enable; }

  void post(E event) { ASSERT_TRUE(rig().loop->post(event)); }
  /// Runs cycles until the request is answered.
  std::string answer() {
    std::optional<RequestReply> reply;
    EXPECT_TRUE(soon([&] {
      rig().runUnseen(1);
      return (reply = rig().loop->reply()).has_value();
    }));
    return !reply ? "no answer" : reply->accepted ? "accepted" : reply->text;
  }
  std::string enable() {
    post(E::kEnable);
    return answer();
  }

  Gate gate;

 private:
  std::optional<Rig<FakeDrive>> made_;
};

constexpr double kForEver = 1e9;

TEST_F(Preparation, ComesBeforeThePowerAndOutsideTheLoop) {
  make(kForEver, [this] { gate.pass(); });
  post(E::kEnable);
  rig().runUnseen(1);
  gate.awaitVisitor();
  rig().runUnseen(100);
  EXPECT_FALSE(isPowerOn());
  EXPECT_TRUE(rig().loop->isPreparing());
  gate.open = true;
  EXPECT_EQ(answer(), "accepted");
  EXPECT_TRUE(isPowerOn());
  EXPECT_FALSE(rig().loop->isPreparing());
}

TEST_F(Preparation, ThatFailsSaysWhyAndLeavesThePowerOff) {
  std::atomic<int> calls{0};
  make(kForEver, [&] {
    if (++calls == 1) throw std::runtime_error("the brake does not open");
    if (calls == 2) throw 7;
  });
  for (const char* why : {"the brake does not open", "an exception that is no std::exception"}) {
    EXPECT_EQ(enable(), std::string("enable refused: the drive is not ready: ") + why);
    rig().runUnseen(100);
    EXPECT_FALSE(isPowerOn());
  }
  EXPECT_EQ(enable(), "accepted");
}

TEST_F(Preparation, ThatHangsIsRefusedInTimeAndUntilItReturns) {
  make(0.1, [this] { gate.pass(); });
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(enable(), "enable refused: the drive has not become ready in time; wait, then try again");
  }
  EXPECT_FALSE(isPowerOn());
}

TEST_F(Preparation, ThatHangsIsNotBlamedForWrongReadings) {
  make(0.1, [this] { gate.pass(); });
  rig().drive.on_read = [](FakeDrive& d) { d.position[kX] += d.status.feedback_count % 2 == 0 ? 0.01 : -0.01; };
  EXPECT_EQ(enable(), "enable refused: the drive gives no valid, fresh positions");
}

TEST_F(Preparation, IsWithdrawnByADisable) {
  make(kForEver, [this] { gate.pass(); });
  post(E::kEnable);
  rig().runUnseen(1);
  gate.awaitVisitor();
  rig().loop->postStop(E::kDisable);
  EXPECT_EQ(answer(), "enable refused: disable came before the power");
  gate.open = true;
  while (rig().loop->isPreparing()) rig().runUnseen(1);
  rig().runUnseen(100);
  EXPECT_FALSE(isPowerOn());
  EXPECT_EQ(enable(), "accepted");
}

}  // namespace test_drive_preparation
}  // namespace grinder::test_support
