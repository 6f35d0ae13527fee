#include "node/progress_tracker.h"

#include "control/fixtures.h"
#include "flute_grinder/job/job_file.h"
#include "soon.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace grinder {
namespace test_progress_tracker {

const ToothPass kFirst{0, 0};

/// One tooth in as many passes.
GrindProgram program(int passes, const Axes& offset = Axes::Zero()) {
  GrindJob job = readJobFile("test/jobs/paper.yaml");
  job.process().infeed = job.process().depth / passes;
  const Machine machine = test_support::machineConfig().machine;
  return {ValidJob(job), machine, {machine.park, {}, offset}};
}

/// Index of the stroke of a pass.
std::uint32_t strokeOf(const GrindProgram& program, int pass) {
  std::uint32_t index = 0;
  for (const Move& move : program.moves()) {
    if (move.kind == MoveKind::kStroke && move.pass == pass) return index;
    ++index;
  }
  throw std::logic_error("no such stroke");
}

class ProgressTrackerTest : public ::testing::Test {
 protected:
  /// What is on the disk once all is there that was entered.
  Progress onDisk() {
    EXPECT_TRUE(test_support::soon([this] { return tracker_.upToDate(); }));
    return writer_.status().on_disk;
  }

  static OffsetBasis named(const std::string& job) {
    OffsetBasis basis;
    basis.job_name = job + ".yaml";
    basis.tool_digest = "tool of " + job;
    basis.kind = OperationKind::kGash;
    return basis;
  }
  void begin(const GrindProgram& program, const std::string& digest) {
    tracker_.begin(program, digest, named(digest), ++status_.jobs_started, now_);
    status_.strokes_ended_at = 0;
    status_.place = {};
  }
  void endStroke(const GrindProgram& program, int pass) {
    status_.strokes_ended_at = strokeOf(program, pass) + 1;
    tracker_.update(status_);
  }
  /// Why a job cannot begin there, unless it is said that the one before is discarded.
  static std::string refusal(const ProgressTracker& tracker, const std::string& digest, const ToothPass& first,
                             bool discard = false) {
    const std::string refused = tracker.refusal(digest, first);
    const auto need = tracker.need(digest, first);
    if (!refused.empty() || !need || discard) return refused;
    EXPECT_EQ(need->answers, std::vector{NeedAnswer::kDiscard});
    return need->text;
  }
  std::string refusal(const std::string& digest, const ToothPass& first) const {
    return refusal(tracker_, digest, first);
  }
  std::string offsetRefusal(const std::string& digest, const Axes& offset) {
    WorkOffsets offsets = now_;
    for (std::size_t axis = 0; axis < offsets.axes.size(); ++axis) {
      offsets.axes[axis].value = offset[static_cast<int>(axis)];
    }
    const auto need = tracker_.offsetNeed(digest, kFirst, offsets);
    const std::string refused = need ? need->text : "";
    const bool continues = digest == onDisk().job_digest && !onDisk().finished && refused.empty();
    EXPECT_EQ(tracker_.continues(digest, offsets), continues);
    return refused;
  }
  /// A job that is canceled after so many passes.
  void grind(const GrindProgram& program, const std::string& digest, int passes) {
    begin(program, digest);
    for (int pass = 0; pass < passes; ++pass) endStroke(program, pass);
    tracker_.end(status_, "canceled");
  }

  const GrindProgram two_ = program(2);
  const test_support::TempFolder folder_;
  Journal writer_{folder_.path() / "journal", "/test"};
  ProgressTracker tracker_{writer_};
  LoopStatus status_;
  WorkOffsets now_;  ///< with wheel and tool
};

TEST_F(ProgressTrackerTest, EntersEveryPassThatHasEndedHowTheJobDidAndItsFeedOverride) {
  status_.feed_override = 0.36;
  tracker_.update(status_);
  begin(two_, "job");
  EXPECT_EQ(onDisk().next.pass, 0);
  EXPECT_EQ(onDisk().feed_override, 0.36) << "before its first stroke";
  EXPECT_TRUE(onDisk().wheel.in_work) << "until its end";
  status_.feed_override = 0.8;
  endStroke(two_, 0);
  EXPECT_EQ(onDisk().next.pass, 1);
  EXPECT_EQ(onDisk().feed_override, 0.8);
  EXPECT_FALSE(onDisk().finished);
  endStroke(two_, 1);
  EXPECT_TRUE(onDisk().finished);
  EXPECT_EQ(onDisk().end, "") << "as long as it runs";
  EXPECT_EQ(onDisk().tool_digest, "tool of job");
  EXPECT_EQ(onDisk().kind, OperationKind::kGash);
  EXPECT_DOUBLE_EQ(onDisk().x, two_.strokeTo());
  tracker_.end(status_, "canceled");
  EXPECT_FALSE(onDisk().wheel.in_work);
  EXPECT_EQ(onDisk().end, "canceled");
  begin(two_, "next");
  EXPECT_EQ(onDisk().end, "");
}

TEST_F(ProgressTrackerTest, WhatTheLoopSaysOfTheJobBeforeIsNotTheNextOnes) {
  grind(program(3), "long", 3);
  ASSERT_TRUE(onDisk().finished);

  const GrindProgram one = program(1);
  tracker_.begin(one, "short", named("short"), status_.jobs_started + 1, now_);
  tracker_.update(status_);
  const Progress entered = onDisk();
  EXPECT_EQ(entered.job_digest, "short");
  EXPECT_FALSE(entered.finished);
  EXPECT_DOUBLE_EQ(entered.x, one.strokeFrom());
}

TEST_F(ProgressTrackerTest, AJobThatWasNotStartedLeavesTheOneBefore) {
  grind(two_, "left", 1);
  const Progress before = onDisk();
  tracker_.begin(two_, "refused", named("refused"), status_.jobs_started + 1, now_);
  EXPECT_EQ(onDisk().job_digest, "refused");
  tracker_.revert();
  EXPECT_EQ(onDisk().job_digest, before.job_digest);
  EXPECT_EQ(onDisk().next.pass, before.next.pass);
}

TEST_F(ProgressTrackerTest, AnUnfinishedJobIsInTheWayOfEveryOtherAndAFinishedOneOfNone) {
  EXPECT_EQ(refusal("job", kFirst), "");
  grind(two_, "job", 1);
  EXPECT_EQ(refusal("job", {0, 1}), "") << "it is continued";
  EXPECT_NE(refusal("job", kFirst), "") << "from its beginning";
  const std::string other = refusal("other", kFirst);
  EXPECT_NE(other.find("job.yaml (D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth), tooth 1, pass 2"),
            std::string::npos)
      << other;
  EXPECT_NE(other.find("discard"), std::string::npos);
  grind(two_, "job", 2);
  EXPECT_EQ(refusal("other", kFirst), "");
  EXPECT_EQ(refusal("job", kFirst), "");
}

TEST_F(ProgressTrackerTest, AJobBeginsAtItsFirstPassOrWhereTheJournalHasLeftIt) {
  const GrindProgram three = program(3);
  const auto isRefused = [&](const std::string& digest, const ToothPass& first) {
    const std::string refused = refusal(digest, first);
    EXPECT_EQ(refused, refusal(tracker_, digest, first, true)) << "what is discarded is not ground";
    return refused.find("allowed: tooth 1, pass 1, or where the journal has left the job") != std::string::npos;
  };
  EXPECT_TRUE(isRefused("job", {0, 1})) << "nothing is ground";
  grind(three, "job", 1);
  EXPECT_FALSE(isRefused("job", {0, 1}));
  EXPECT_TRUE(isRefused("job", {0, 2}));
  EXPECT_TRUE(isRefused("job", {1, 0}));
  EXPECT_TRUE(isRefused("other", {0, 1}));
  EXPECT_EQ(refusal(tracker_, "job", kFirst, true), "");
  grind(three, "job", 3);
  EXPECT_TRUE(isRefused("job", {0, 2})) << "it is finished";
}

TEST_F(ProgressTrackerTest, ADamagedJournalIsInTheWayOfEveryJob) {
  const std::string path = folder_.path() / "damaged";
  std::ofstream(path) << "nothing of a journal";
  Journal writer(path, "/test");
  ProgressTracker tracker(writer);
  EXPECT_EQ(
      refusal(tracker, "job", kFirst),
      "journal " + path + ": its checksum is missing; what job it kept is unknown; restore the file, or discard it");
  EXPECT_EQ(refusal(tracker, "job", kFirst, true), "");
  // What is done about the wheel leaves it, for whoever can restore it.
  for (const bool known : {false, true}) {
    status_.wheel = unknownWheel(test_support::machineConfig().machine.limits, false);
    status_.wheel.in_work = !(status_.wheel.known = known);
    tracker.update(status_);
    EXPECT_TRUE(tracker.upToDate());
    EXPECT_NE(writer.status().damage, "");
  }
}

TEST_F(ProgressTrackerTest, AJournalThatCannotBeReadIsInTheWayEvenIfDiscardedUntilItIsGone) {
  const std::filesystem::path folder = folder_.path() / "folder";
  std::ofstream(folder) << "a file";
  Journal writer(folder / "journal", "/test");
  ProgressTracker tracker(writer);
  EXPECT_EQ(refusal(tracker, "job", kFirst, true).rfind("journal " + folder.string(), 0), 0U);
  std::filesystem::remove(folder);
  EXPECT_TRUE(test_support::soon([&] {
    tracker.update(status_);
    return refusal(tracker, "job", kFirst).empty();
  }));
}

TEST_F(ProgressTrackerTest, AJobIsContinuedWithItsWorkOffsetsWheelAndToolOnly) {
  const Axes offset(0.1, 0.03, 0, 0.5);
  const GrindProgram shifted = program(2, offset);
  grind(shifted, "job", 1);
  EXPECT_TRUE((onDisk().offset == offset).all());
  EXPECT_EQ(offsetRefusal("other", Axes::Zero()), "") << "other jobs are refused for another reason";
  const std::string unfinished = "the job is not finished, and ";
  EXPECT_EQ(offsetRefusal("job", {0.1, 0.03125, 0, 0}),
            unfinished +
                "it began with other work offsets; that of axis Y was 30 mm and is 31.25 mm; "
                "that of axis A was 28.6478898 deg and is 0 deg; set them as they were, or discard the job");
  for (const Axes& same : {offset, Axes(0.1 + 0.9e-7, 0.03 - 0.9e-7, 0, 0.5 + 0.9e-6)}) {
    EXPECT_EQ(offsetRefusal("job", same), "") << same.transpose();
  }
  for (const Axes& other : {Axes(0.1 + 1.1e-7, 0.03, 0, 0.5), Axes(0.1, 0.03, -1.1e-7, 0.5),
                            Axes(0.1, 0.03, 0, 0.5 - 1.1e-6), Axes(std::nan(""), 0.03, 0, 0.5)}) {
    EXPECT_NE(offsetRefusal("job", other), "") << other.transpose();
  }
  ++now_.wheel.mounting;
  EXPECT_EQ(offsetRefusal("job", offset),
            unfinished + "another wheel has been mounted since it began; discard the job");
  --now_.wheel.mounting;
  ++now_.tool.clamping;
  EXPECT_EQ(offsetRefusal("job", offset), unfinished + "a tool was clamped since it began; discard the job");
  grind(shifted, "job", 2);
  EXPECT_EQ(offsetRefusal("job", Axes::Zero()), "") << "it is finished";
  EXPECT_TRUE(onDisk().finished);
}

TEST_F(ProgressTrackerTest, TheWheelIsEnteredWithoutAJobToo) {
  status_.wheel = {true, 0.01, 0.002};
  tracker_.update(status_);
  EXPECT_TRUE(onDisk().wheel.in_work);
  EXPECT_DOUBLE_EQ(onDisk().wheel.clear_y, 0.01);
  status_.wheel.in_work = false;
  tracker_.update(status_);
  EXPECT_FALSE(onDisk().wheel.in_work);
  status_.wheel.y_doubted = true;
  tracker_.update(status_);
  EXPECT_TRUE(onDisk().wheel.y_doubted);
}

}  // namespace test_progress_tracker
}  // namespace grinder
