#include "control/fixtures.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/job/job_file.h"

#include <cerrno>
#include <cstdlib>
#include <memory>

// Counts every access to the heap: the executable's malloc and related functions replace the C library's, for the
// shared libraries too, and the C++ library's operator new calls them.

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);
}

namespace {

// Plain types, since they are used before any constructor runs.
thread_local bool counting = false;
thread_local int allocations = 0;
thread_local int releases = 0;

void countAllocation() {
  if (counting) ++allocations;
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) noexcept {
  countAllocation();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  countAllocation();
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) noexcept {
  countAllocation();
  return __libc_realloc(memory, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  countAllocation();
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  countAllocation();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  countAllocation();
  *memory = __libc_memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}

void free(void* memory) noexcept {
  // Releasing a null pointer does not use the heap.
  if (counting && memory) ++releases;
  __libc_free(memory);
}

}  // extern "C"

namespace flute_grinder::test_support {
namespace {

/// Heap calls of a piece of code.
struct HeapUse {
  int allocations = 0;
  int releases = 0;

  HeapUse& operator+=(const HeapUse& other) {
    allocations += other.allocations;
    releases += other.releases;
    return *this;
  }
};

template <typename Work>
HeapUse heapUse(const Work& work) {
  allocations = releases = 0;
  counting = true;
  work();
  counting = false;
  return {allocations, releases};
}

void expectNone(const HeapUse& use) {
  EXPECT_EQ(use.allocations, 0);
  EXPECT_EQ(use.releases, 0);
}

GrindJob paperJob() { return readJobFile("test/jobs/paper.yaml"); }

// ---------------------------------------------------------------------------------------------------------------------
// The counter must see every allocation, or the tests below would pass whatever happens.

/// Keeps the compiler from optimising an allocation away.
void* volatile kept = nullptr;

TEST(HeapUse, SeesMallocAndFree) {
  const HeapUse use = heapUse([] {
    kept = std::malloc(16);
    std::free(kept);
  });
  EXPECT_EQ(use.allocations, 1);
  EXPECT_EQ(use.releases, 1);
}

TEST(HeapUse, SeesCallocAndRealloc) {
  const HeapUse use = heapUse([] {
    kept = std::calloc(2, 16);
    kept = std::realloc(kept, 4096);
  });
  EXPECT_EQ(use.allocations, 2);
  std::free(kept);
}

TEST(HeapUse, SeesAlignedMemory) {
  const HeapUse use = heapUse([] {
    void* memory = nullptr;
    if (posix_memalign(&memory, 64, 128) == 0) kept = memory;
    std::free(kept);
    kept = std::aligned_alloc(64, 128);
  });
  EXPECT_EQ(use.allocations, 2);
  std::free(kept);
}

TEST(HeapUse, SeesNewAndDelete) {
  const HeapUse use = heapUse([] {
    auto* number = new double(1);
    kept = number;
    delete static_cast<double*>(kept);
  });
  EXPECT_EQ(use.allocations, 1);
  EXPECT_EQ(use.releases, 1);
}

TEST(HeapUse, SeesNewOfWhatIsOveraligned) {
  struct alignas(64) Wide {
    double numbers[8] = {};
  };
  const HeapUse use = heapUse([] {
    auto* wide = new Wide;
    kept = wide;
    delete static_cast<Wide*>(kept);
  });
  EXPECT_EQ(use.allocations, 1);
  EXPECT_EQ(use.releases, 1);
}

TEST(HeapUse, SeesIntoTheCoreLibrary) {
  const GrindJob job = paperJob();
  const LoopConfig config = machineConfig();
  const HeapUse use = heapUse([&] { GrindProgram(job, config.machine, config.machine.park); });
  EXPECT_GT(use.allocations, 0) << "a program keeps its moves on the heap";
}

TEST(HeapUse, SeesIntoTheDriveLibrary) {
  LoopFault fault;
  fault.kind = FaultKind::kFollowingError;
  const HeapUse use = heapUse([&] { fault.text(); });
  EXPECT_GT(use.allocations, 0) << "a text of this length is on the heap";
}

TEST(HeapUse, SeesIntoTheSimulatedDrive) {
  const HeapUse use = heapUse([] {
    SimulatedDrive drive;
    drive.init(driveModel(), equipment());
  });
  EXPECT_GT(use.allocations, 0) << "handles are kept in a map";
}

TEST(HeapUse, IsNothingWhereNothingIsAsked) {
  expectNone(heapUse([] {}));
}

// ---------------------------------------------------------------------------------------------------------------------
// The stream

class StreamAllocatesNothing : public testing::TestWithParam<EvenStepRule> {
 protected:
  StreamAllocatesNothing() : stream_(program()) {}

  static GrindProgram program() {
    GrindJob job = paperJob();
    job.interpolation.even_step = GetParam();
    job.process.z_law = ZLaw::kConstantRake;
    ZCorrection bow;
    bow.from = -job.process.overtravel_end;
    bow.pieces = ZCorrection::kMaxPieces;
    bow.piece = 3e-3;
    for (double& c : bow.coefficients) c = 1e-6 * static_cast<double>(&c - bow.coefficients.data());
    job.z_corrections = {bow};
    const LoopConfig config = machineConfig();
    return GrindProgram(job, config.machine, config.machine.park);
  }

  SetpointStream stream_;
};

TEST_P(StreamAllocatesNothing, OverAWholeJob) {
  int setpoints = 0;
  unsigned moves = 0;  // a bit for every kind that was seen
  const HeapUse use = heapUse([&] {
    Setpoint setpoint;
    while (stream_.next(setpoint)) {
      ++setpoints;
      moves |= 1u << static_cast<unsigned>(setpoint.move);
    }
  });
  expectNone(use);
  EXPECT_GT(setpoints, 3000);
  // From the park position, which is clear of the work, there is no lift.
  EXPECT_EQ(moves, 0b11111110u) << "some kind of move was not made";
}

TEST_P(StreamAllocatesNothing, WhileItIsHeldRetractedAndResumed) {
  for (const MoveKind move : {MoveKind::kPosition, MoveKind::kStroke, MoveKind::kReturn}) {
    SetpointStream stream = stream_;
    bool finished = false;
    const HeapUse use = heapUse([&] {
      Setpoint setpoint;
      const auto run = [&](int most) {
        for (int i = 0; i < most && stream.next(setpoint); ++i) {
        }
      };
      while (setpoint.move != move && stream.next(setpoint)) {
      }
      run(100);
      stream.setFeedOverride(0.5);
      run(100);
      stream.hold();
      run(100000);
      stream.retract();
      run(100000);
      stream.resume();
      run(100000);
      finished = stream.finished();
    });
    expectNone(use);
    EXPECT_TRUE(finished) << toString(move);
  }
}

INSTANTIATE_TEST_SUITE_P(Rule, StreamAllocatesNothing,
                         testing::Values(EvenStepRule::kPublished, EvenStepRule::kThirdOrder, EvenStepRule::kExact),
                         [](const testing::TestParamInfo<EvenStepRule>& info) {
                           return std::string(toString(info.param));
                         });

// ---------------------------------------------------------------------------------------------------------------------
// The loop

class CycleAllocatesNothing : public testing::Test {
 protected:
  CycleAllocatesNothing() {
    drive_.init(driveModel(), equipment());
    loop_ = std::make_unique<ControlLoop>(drive_, machineConfig());
    used_ += heapUse([&] { loop_->postSwivel(kPaperSwivel); });
    cycle();
  }

  /// @param periods since the last cycle.
  void cycle(double periods = 1) {
    const ros::Duration period(0.001 * periods);
    time_ += period;
    used_ += heapUse([&] {
      loop_->cycle(time_, period);
      status_ = loop_->status();
    });
    while (loop_->pop(record_)) ended_ += record_.job_ended;
  }

  void run(int cycles) {
    for (int i = 0; i < cycles; ++i) cycle();
  }

  /// Posts a request. The calls of the requesting thread count too, except its waiting.
  bool accepted(MachineEvent event, SetpointStream* stream = nullptr) {
    std::uint32_t ticket = 0;
    used_ += heapUse([&] {
      if (stream) {
        loop_->startJob(stream);
      } else if (isStop(event)) {
        ticket = loop_->postStopWithReply(event);
      } else {
        loop_->post(event);
      }
    });
    for (int i = 0; i < 10; ++i) {
      cycle();
      const auto answer = stream          ? loop_->startJobReply()
                          : isStop(event) ? loop_->stopReply(event, ticket)
                                          : loop_->reply();
      if (answer) return answer->accepted;
    }
    ADD_FAILURE() << "no answer";
    return false;
  }

  /// Posts a jog. The calls of the requesting thread count too.
  bool jogs(const JogRequest& jog) {
    used_ += heapUse([&] { loop_->postJog(jog); });
    cycle();
    const auto answer = loop_->jogReply();
    return answer && answer->accepted;
  }

  /// Runs until a state is reached.
  bool reaches(MachineState state) {
    for (int i = 0; i < 100000 && record_.state != state; ++i) cycle();
    return record_.state == state;
  }

  /// Enables, starts a job and runs to the middle of its stroke.
  bool grinds(SetpointStream& stream) {
    if (!accepted(MachineEvent::kEnable) || !accepted(MachineEvent::kStart, &stream)) return false;
    for (int i = 0; i < 100000 && !(record_.has_setpoint && record_.setpoint.move == MoveKind::kStroke); ++i) cycle();
    run(500);
    return record_.state == MachineState::kRunning;
  }

  SetpointStream paperStream(const Axes& offset = Axes::Zero()) const {
    Machine machine = machineConfig().machine;
    machine.work_offset = offset;
    return SetpointStream(GrindProgram(paperJob(), machine, record_.command - offset));
  }

  SimulatedDrive drive_;
  std::unique_ptr<ControlLoop> loop_;
  ros::Time time_{1000};
  CycleRecord record_;
  LoopStatus status_;
  HeapUse used_;  ///< by all cycles so far
  int ended_ = 0;
};

TEST_F(CycleAllocatesNothing, WhileDisabledAndWhileSwitchedOnAndOff) {
  run(10);
  ASSERT_TRUE(accepted(MachineEvent::kEnable));
  run(10);
  ASSERT_TRUE(accepted(MachineEvent::kDisable));
  run(10);
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverAWholeJob) {
  ASSERT_TRUE(accepted(MachineEvent::kEnable));
  SetpointStream stream = paperStream();
  ASSERT_TRUE(accepted(MachineEvent::kStart, &stream));
  for (int i = 0; i < 100000 && ended_ == 0; ++i) cycle();
  EXPECT_EQ(ended_, 1);
  EXPECT_EQ(record_.state, MachineState::kReady);
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverAJobWithWorkOffsetsAndOneThatLeavesTheLimits) {
  ASSERT_TRUE(accepted(MachineEvent::kEnable));
  SetpointStream stream = paperStream({0.1, 0.0375, -0.02, 7});
  ASSERT_TRUE(accepted(MachineEvent::kStart, &stream));
  for (int i = 0; i < 100000 && ended_ == 0; ++i) cycle();
  EXPECT_EQ(status_.end, JobEnd::kDone);
  SetpointStream too_far = paperStream({0.28, 0, 0, 0});
  ASSERT_TRUE(accepted(MachineEvent::kStart, &too_far));
  ASSERT_TRUE(reaches(MachineState::kFault));
  EXPECT_EQ(record_.fault.kind, FaultKind::kLimit);
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverACancel) {
  ASSERT_TRUE(accepted(MachineEvent::kEnable));
  SetpointStream stream = paperStream();
  ASSERT_TRUE(accepted(MachineEvent::kStart, &stream));
  run(200);
  ASSERT_TRUE(accepted(MachineEvent::kCancel));
  for (int i = 0; i < 100000 && ended_ == 0; ++i) cycle();
  EXPECT_EQ(record_.state, MachineState::kReady);
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverStopsFromSignalHandlersAndADisableAmidAJob) {
  SetpointStream stream = paperStream();
  ASSERT_TRUE(grinds(stream));
  used_ += heapUse([&] {
    loop_->postStop(MachineEvent::kHold);
    loop_->postStop(MachineEvent::kDisable);
  });
  ASSERT_TRUE(reaches(MachineState::kDisabled));
  EXPECT_EQ(status_.end, JobEnd::kCanceled);
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverALateCycleAndOneThatIsAFault) {
  SetpointStream stream = paperStream();
  ASSERT_TRUE(grinds(stream));
  cycle(5);
  run(100);
  ASSERT_EQ(record_.state, MachineState::kRunning);
  cycle(50);
  EXPECT_EQ(record_.fault.kind, FaultKind::kLate);
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverHoldRetractAndResume) {
  SetpointStream stream = paperStream();
  ASSERT_TRUE(grinds(stream));
  ASSERT_TRUE(accepted(MachineEvent::kHold));
  ASSERT_TRUE(reaches(MachineState::kHeld));
  run(20);
  ASSERT_TRUE(accepted(MachineEvent::kResume));
  run(300);
  ASSERT_TRUE(accepted(MachineEvent::kHold));
  ASSERT_TRUE(reaches(MachineState::kHeld));
  ASSERT_TRUE(accepted(MachineEvent::kRetract));
  run(20);
  ASSERT_TRUE(accepted(MachineEvent::kHold));
  ASSERT_TRUE(reaches(MachineState::kHeld));
  ASSERT_TRUE(accepted(MachineEvent::kRetract));
  ASSERT_TRUE(reaches(MachineState::kRetracted));
  run(20);
  ASSERT_TRUE(accepted(MachineEvent::kResume));
  EXPECT_EQ(record_.state, MachineState::kResuming);
  ASSERT_TRUE(reaches(MachineState::kRunning));
  ASSERT_TRUE(reaches(MachineState::kReady));
  EXPECT_EQ(ended_, 1);
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverJogs) {
  ASSERT_TRUE(accepted(MachineEvent::kEnable));
  ASSERT_TRUE(jogs({kX, false, 0.01, 0.05}));
  EXPECT_EQ(record_.state, MachineState::kJogging);
  EXPECT_FALSE(jogs({kX, false, 0.01, 0.05}));
  ASSERT_TRUE(reaches(MachineState::kReady));
  EXPECT_FALSE(jogs({kX, false, 1, 0.05}));
  ASSERT_TRUE(jogs({kZ, true, 0, 0.05}));
  run(40);
  ASSERT_TRUE(jogs({kZ, true, 0, 0.01}));
  ASSERT_TRUE(reaches(MachineState::kReady)) << "without messages";
  ASSERT_TRUE(jogs({kZ, true, 0, -0.05}));
  cycle(5);
  ASSERT_TRUE(accepted(MachineEvent::kHold));
  EXPECT_FALSE(jogs({kZ, true, 0, -0.05}));
  ASSERT_TRUE(jogs({kZ, true, 0, 0}));
  ASSERT_TRUE(reaches(MachineState::kReady));
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverJogsAmidAJob) {
  SetpointStream stream = paperStream();
  ASSERT_TRUE(grinds(stream));
  ASSERT_TRUE(accepted(MachineEvent::kHold));
  ASSERT_TRUE(reaches(MachineState::kHeld));
  ASSERT_TRUE(accepted(MachineEvent::kRetract));
  ASSERT_TRUE(reaches(MachineState::kRetracted));
  ASSERT_TRUE(jogs({kY, false, 0.01, 0.05}));
  EXPECT_EQ(record_.state, MachineState::kJoggingRetracted);
  ASSERT_TRUE(reaches(MachineState::kRetracted));
  ASSERT_TRUE(jogs({kX, true, 0, -0.05}));
  ASSERT_TRUE(reaches(MachineState::kRetracted));
  ASSERT_TRUE(accepted(MachineEvent::kResume));
  ASSERT_TRUE(reaches(MachineState::kRunning));
  ASSERT_TRUE(reaches(MachineState::kReady));
  EXPECT_EQ(ended_, 1);
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverFeedOverrides) {
  SetpointStream stream = paperStream();
  ASSERT_TRUE(grinds(stream));
  used_ += heapUse([&] { loop_->setFeedOverride(0); });
  run(300);
  EXPECT_FALSE(record_.has_setpoint);
  for (const double fraction : {0.3, 1.2, 1.0}) {
    used_ += heapUse([&] { loop_->setFeedOverride(fraction); });
    run(100);
    EXPECT_TRUE(record_.has_setpoint);
  }
  ASSERT_TRUE(reaches(MachineState::kReady));
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverEveryInterlock) {
  using Fault = SimulatedDrive::Fault;
  for (const Fault fault : {Fault::kSpindleLost, Fault::kCoolantLost, Fault::kReferenceLost}) {
    SetpointStream stream = paperStream();
    ASSERT_TRUE(grinds(stream));
    drive_.inject(fault);
    ASSERT_TRUE(reaches(MachineState::kRetracted)) << "of injected fault " << static_cast<int>(fault);
    EXPECT_NE(record_.interlock, Interlock::kNone);
    EXPECT_FALSE(accepted(MachineEvent::kResume));
    drive_.inject(Fault::kNone);
    run(10);
    if (fault == Fault::kReferenceLost) {
      ASSERT_TRUE(accepted(MachineEvent::kCancel));
    } else {
      ASSERT_TRUE(accepted(MachineEvent::kResume));
    }
    ASSERT_TRUE(reaches(MachineState::kReady));
  }
  EXPECT_EQ(ended_, 3);
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverASwivelThatIsConfirmedMeasuredAndSlips) {
  for (const double angle : {kPaperSwivel, 0.0}) {
    used_ += heapUse([&] { loop_->postSwivel(angle); });
    run(2);
    ASSERT_EQ(status_.swivel.angle, angle);
  }
  ASSERT_TRUE(accepted(MachineEvent::kEnable));
  SetpointStream refused = paperStream();
  EXPECT_FALSE(accepted(MachineEvent::kStart, &refused));
  SimulatedDrive::Equipment encoder = equipment();
  encoder.swivel = kPaperSwivel;
  drive_.init(driveModel(), encoder);
  run(2);
  SetpointStream stream = paperStream();
  ASSERT_TRUE(grinds(stream));
  drive_.inject(SimulatedDrive::Fault::kSwivelSlipped);
  ASSERT_TRUE(reaches(MachineState::kRetracted));
  EXPECT_EQ(record_.interlock, Interlock::kSwivel);
  drive_.inject(SimulatedDrive::Fault::kNone);
  run(10);
  ASSERT_TRUE(accepted(MachineEvent::kResume));
  ASSERT_TRUE(reaches(MachineState::kReady));
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverASpindleThatDoesNotCome) {
  drive_.inject(SimulatedDrive::Fault::kSpindleLost);
  ASSERT_TRUE(accepted(MachineEvent::kEnable));
  SetpointStream stream = paperStream();
  ASSERT_TRUE(accepted(MachineEvent::kStart, &stream));
  EXPECT_EQ(record_.state, MachineState::kStarting);
  ASSERT_TRUE(reaches(MachineState::kReady));
  EXPECT_EQ(record_.fault.kind, FaultKind::kInterlock);
  EXPECT_EQ(ended_, 1);
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverHomingThatEndsAndThatIsBrokenOff) {
  ASSERT_TRUE(accepted(MachineEvent::kEnable));
  ASSERT_TRUE(accepted(MachineEvent::kHome));
  EXPECT_EQ(record_.state, MachineState::kHoming);
  ASSERT_TRUE(reaches(MachineState::kReady));
  ASSERT_TRUE(accepted(MachineEvent::kHome));
  ASSERT_TRUE(accepted(MachineEvent::kDisable));
  ASSERT_TRUE(accepted(MachineEvent::kEnable));
  ASSERT_TRUE(accepted(MachineEvent::kHome));
  drive_.inject(SimulatedDrive::Fault::kEmergencyStop);
  ASSERT_TRUE(reaches(MachineState::kFault));
  EXPECT_EQ(record_.fault.kind, FaultKind::kEmergencyStop);
  drive_.inject(SimulatedDrive::Fault::kNone);
  run(2);
  ASSERT_TRUE(accepted(MachineEvent::kReset));
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverHomingThatTakesTooLong) {
  LoopConfig hasty = machineConfig();
  hasty.homing_timeout = 0.0015;
  loop_ = std::make_unique<ControlLoop>(drive_, hasty);
  cycle();
  ASSERT_TRUE(accepted(MachineEvent::kEnable));
  ASSERT_TRUE(accepted(MachineEvent::kHome));
  ASSERT_TRUE(reaches(MachineState::kFault));
  EXPECT_EQ(record_.fault.kind, FaultKind::kHoming);
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverEveryFaultAndItsReset) {
  using Fault = SimulatedDrive::Fault;
  for (const Fault fault :
       {Fault::kEmergencyStop, Fault::kStuckAxis, Fault::kStaleFeedback, Fault::kNanFeedback, Fault::kDriveFault}) {
    SetpointStream stream = paperStream();
    ASSERT_TRUE(grinds(stream));
    drive_.inject(fault, kX);
    ASSERT_TRUE(reaches(MachineState::kFault)) << "of injected fault " << static_cast<int>(fault);
    drive_.inject(Fault::kNone);
    run(2);
    ASSERT_TRUE(accepted(MachineEvent::kReset));
    run(2);
    ASSERT_TRUE(accepted(MachineEvent::kEnable));
    ASSERT_TRUE(accepted(MachineEvent::kLift));
    EXPECT_EQ(record_.state, MachineState::kLifting);
    ASSERT_TRUE(reaches(MachineState::kReady));
  }
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverASetpointThatALimitForbids) {
  LoopConfig weak = machineConfig();
  weak.machine.limits.max_velocity[kX] = 0.05;
  loop_ = std::make_unique<ControlLoop>(drive_, weak);
  loop_->postSwivel(kPaperSwivel);
  cycle();
  ASSERT_TRUE(accepted(MachineEvent::kEnable));
  SetpointStream stream = paperStream();
  ASSERT_TRUE(accepted(MachineEvent::kStart, &stream));
  EXPECT_TRUE(reaches(MachineState::kFault));
  EXPECT_EQ(record_.fault.kind, FaultKind::kLimit);
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, OverRefusedRequests) {
  SetpointStream stream = paperStream();
  EXPECT_FALSE(accepted(MachineEvent::kStart, &stream));
  EXPECT_FALSE(accepted(MachineEvent::kCancel));
  expectNone(used_);
}

TEST_F(CycleAllocatesNothing, WhileNobodyTakesTheRecords) {
  const ros::Duration period(0.001);
  const HeapUse use = heapUse([&] {
    for (int i = 0; i < 10000; ++i) loop_->cycle(time_, period);
  });
  expectNone(use);
  loop_->pop(record_);
  loop_->cycle(time_, period);
  while (loop_->pop(record_)) {
  }
  EXPECT_EQ(record_.records_lost, 10000u - 8192);
}

}  // namespace
}  // namespace flute_grinder::test_support
