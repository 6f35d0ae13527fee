#include "control/fixtures.h"
#include "control/heap.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/drive/parameters.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/job/valid_job.h"
#include "flute_grinder/motion/setpoint_stream.h"

#include <cstdlib>

// That the heap is counted, of which every rig makes use, and what no rig runs.
namespace grinder::test_support {
namespace test_heap {

/// Keeps the compiler from optimising an allocation away.
void* volatile kept = nullptr;

struct alignas(64) Wide {
  double numbers[8] = {};
};

/// A counter that saw nothing would let every rig pass.
TEST(HeapUse, IsSeenHoweverAndWhereverTheHeapIsUsed) {
  const ValidJob job(readJobFile("test/jobs/paper.yaml"));
  const LoopConfig config = machineConfig();
  LoopFault fault;
  fault.kind = FaultKind::kFollowingError;
  struct Row {
    const char* name;
    std::function<void()> work;
    int allocations;  ///< at least
  };
  const Row rows[] = {
      {"malloc", [] { std::free(kept = std::malloc(16)); }, 1},
      {"calloc and realloc", [] { std::free(kept = std::realloc(kept = std::calloc(2, 16), 4096)); }, 2},
      {"posix_memalign",
       [] {
         void* memory = nullptr;
         if (posix_memalign(&memory, 64, 128) == 0) kept = memory;
         std::free(kept);
       },
       1},
      {"aligned_alloc", [] { std::free(kept = std::aligned_alloc(64, 128)); }, 1},
      {"new", [] { delete static_cast<double*>(kept = new double(1)); }, 1},
      {"new of what is over-aligned", [] { delete static_cast<Wide*>(kept = new Wide); }, 1},
      {"the core library: the moves of a program", [&] { GrindProgram(job, config.machine, config.machine.park); }, 1},
      {"the drive library: a long text", [&] { fault.text(); }, 1},
      {"the simulated drive: a refusal of its parameters",
       [] {
         const ParameterReader none({}, "");
         EXPECT_THROW(SimulatedDrive::readSimulation(none, none), ParameterError);
       },
       1}};
  for (const Row& row : rows) {
    const HeapUse use = heapUse(row.work);
    EXPECT_GE(use.allocations, row.allocations) << row.name;
    EXPECT_GE(use.releases, 1) << row.name;
  }
}

/// The rigs run the published rule, without a correction.
TEST(StreamAllocatesNothing, WhileItIsHeldRetractedAndResumed) {
  const LoopConfig config = machineConfig();
  GrindJob job = readJobFile("test/jobs/paper.yaml");
  job.process().z_law = ZLaw::kConstantRake;
  ZCorrection bow;
  bow.from = -job.process().overtravel_end;
  bow.pieces = ZCorrection::kMaxPieces;
  bow.piece = 3e-3;
  for (double& c : bow.coefficients) c = 1e-6 * static_cast<double>(&c - bow.coefficients.data());
  for (const EvenStepRule rule : {EvenStepRule::kPublished, EvenStepRule::kThirdOrder, EvenStepRule::kExact}) {
    job.interpolation.even_step = rule;
    const GrindProgram program(ValidJob(job).withZCorrections({bow}), config.machine, config.machine.park);
    for (const MoveKind move : {MoveKind::kPosition, MoveKind::kStroke, MoveKind::kReturn}) {
      SCOPED_TRACE(std::string(toString(rule)) + " " + toString(move));
      SetpointStream stream(program);
      Rest rest = Rest::kNone;
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
        rest = stream.rest();
      });
      EXPECT_FALSE(use.any());
      EXPECT_EQ(rest, Rest::kEnd);
    }
  }
}

}  // namespace test_heap
}  // namespace grinder::test_support
