#include "flute_grinder/record/job_record.h"

#include "any_tool.h"
#include "control/fixtures.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/motion/setpoint_stream.h"
#include "flute_grinder/record/record_file.h"
#include "node/job_recorder.h"
#include "record/ground_strokes.h"
#include "refusal.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

/// @file
/// The record of a job is made of its cycles. Here a job's own setpoints with readings, periods, holds and overrides
/// made at random; each figure is computed once more from the list of all of them.

namespace grinder {
namespace test_job_record {

constexpr double kStart = 1795367053.123;  ///< 2026-11-22 17:04:13.123 UTC
const MachineInfo kMachine{"mill",           "1.2.3",          "some/Drive",       0.001,
                           Axes(1, 2, 3, 4), Axes(5, 6, 7, 8), Axes(9, 10, 11, 12)};
const JobNames kNames{"short.yaml", "wheel.yaml", "2026-11-20"};
const Tolerances kTolerances{0.05, 0.02, 50, 5, 1};

/// Two unequal teeth of a short cone in two passes.
GrindJob shortJob() {
  GrindJob job = readJobFile("test/jobs/paper.yaml");
  test_support::askForRakeAlone(job.cutter);
  job.cutter.flute_length = 2e-3;
  job.process().overtravel_shank = 1e-3;
  job.process().feed = 0.05;
  job.process().depth = 1e-3;
  job.process().depth_end = 0.8e-3;
  job.process().setup_x_shift = -15e-3;
  job.process().infeed = 0.6e-3;
  job.process().wheel_wear = 0.01e-3;
  job.tooth_angles = {0, 3.1};
  job.spiral_angles = {job.cutter.spiral_angle, job.cutter.spiral_angle * 0.9};
  return job;
}

struct Cycle {
  CycleSample sample;
  bool has_setpoint = false;
  Setpoint setpoint;  ///< that reaches the axes in this cycle
};

class JobRecordTest : public ::testing::Test {
 protected:
  JobRecordTest() {
    plan_.program = std::make_shared<const GrindProgram>(ValidJob(job_), config_.machine, config_.machine.park);
    plan_.statistics.setpoints = 4321;
    plan_.statistics.duration = 4.32;
    plan_.statistics.max_deviation = 0.5e-6;
  }

  double random(double low, double high) { return std::uniform_real_distribution<>(low, high)(engine_); }
  bool once(int in) { return std::uniform_int_distribution<>(1, in)(engine_) == 1; }

  Cycle& cycle(MachineState state) {
    Cycle cycle;
    CycleSample& r = cycle.sample;
    r.period = once(50) ? random(0.0015, 0.01) : random(0.0009, 0.0015);
    time_ += r.period;
    r.time = time_;
    r.state = state;
    r.feed_override = override_;
    r.command_in_effect = command_;
    for (int axis = 0; axis < kAxisCount; ++axis) r.position[axis] = command_[axis] + random(-1e-5, 1e-5);
    cycles_.push_back(cycle);
    return cycles_.back();
  }

  /// Of a job whose X was probed, and whose other offsets were never set.
  std::shared_ptr<JobRecord> newRecord() const {
    WorkOffsets offsets;
    offsets.axes[kX] = {0.012, "anna@grinder", 1.7e9};
    offsets.axes[kX].basis.method = OffsetMethod::kProbe;
    offsets.axes[kX].basis.wheel_digest = "a";
    offsets.axes[kX].basis.swivel = units::kPi / 6;
    return std::make_shared<JobRecord>(plan_, kNames, offsets, true);
  }

  /// A hold of some cycles, which retracts as may be. @return the number of its cycles.
  void hold(Interlock interlock) {
    for (const MachineState state : {MachineState::kHolding, MachineState::kHeld, MachineState::kRetracting,
                                     MachineState::kRetracted, MachineState::kJoggingRetracted}) {
      for (int i = 0; i < 5; ++i) cycle(state).sample.interlock = interlock;
      if (once(3)) break;
    }
    cycle(MachineState::kResuming);
  }

  /// All cycles of the job.
  void makeCycles() {
    SetpointStream stream(plan_.program);
    Setpoint setpoint;
    for (int i = 0; i < 20; ++i) cycle(MachineState::kStarting);
    while (stream.next(setpoint)) {
      if (once(700)) hold(once(2) ? Interlock::kNone : Interlock::kCoolant);
      if (once(300)) override_ = std::round(random(0, 120)) / 100;
      stream.setFeedOverride(std::max(0.3, override_));
      Cycle& c = cycle(MachineState::kRunning);
      c.has_setpoint = true;
      c.setpoint = setpoint;
      command_ = setpoint.position;
    }
    cycle(MachineState::kReady);
  }

  /// Gives all cycles to a job's record, or to what makes it; all later by some time.
  template <typename ToRecord>
  void give(ToRecord&& record, double later = 0) const {
    for (Cycle c : cycles_) {
      c.sample.time += later;
      record.addCycle(c.sample);
      if (c.has_setpoint) record.addSetpoint(c.setpoint, c.sample);
    }
  }

  Json recorded() const {
    JobRecord record(plan_, kNames, {}, false);
    give(record);
    record.conclude({"done", "", 5});
    return documentOf(record);
  }

  /// Head and body, as they are written.
  static Json documentOf(const JobRecord& record) {
    const Json file = Json::parse(text(record.record("/grinder", kMachine, kTolerances)));
    Json all = file["head"];
    all.update(file["body"]);
    return all;
  }

  /// The cycles of a stroke.
  std::vector<Cycle> strokeCycles(int tooth, int pass) const {
    std::vector<Cycle> stroke;
    for (const Cycle& c : cycles_) {
      const Setpoint& p = c.setpoint;
      if (c.has_setpoint && p.move == MoveKind::kStroke && p.tooth == tooth && p.pass == pass) stroke.push_back(c);
    }
    return stroke;
  }
  /// The records that are kept.
  std::vector<Json> kept() const {
    std::vector<Json> records;
    for (const std::string& file : recordFilesIn(folder_.path()).records) {
      const Record record = readRecord(file);
      records.push_back(toJson(record.head));
      records.back().update(record.body);
    }
    return records;
  }
  double since(const CycleSample& sample) const { return sample.time - cycles_.front().sample.time; }

  void expectStroke(const Json& reported, int tooth, int pass) const {
    const std::vector<Cycle> stroke = strokeCycles(tooth, pass);
    EXPECT_EQ(reported["tooth"], tooth + 1);
    EXPECT_EQ(reported["pass"], pass + 1);
    EXPECT_TRUE(reported["complete"]);
    EXPECT_NEAR(reported["started_s"], since(stroke.front().sample), 1e-6);
    EXPECT_NEAR(reported["duration_s"], stroke.back().sample.time - stroke.front().sample.time, 1e-6);
    double low = 1e9, high = 0, deviation = 0, low_x = 0, deviation_x = 0;
    Axes following = Axes::Zero();
    const double spiral = std::tan(job_.spiral_angles[static_cast<std::size_t>(tooth)]), cone = job_.cutter.cone_angle;
    for (const Cycle& c : stroke) {
      const double x = c.setpoint.position[kX];
      const double normal = std::cos(std::atan(spiral * std::cos(cone)));
      const double radius = job_.cutter.end_diameter / 2 + (x + 15e-3) * std::tan(cone);
      const double off = std::abs(c.setpoint.path_error) * radius * normal;
      if (off > deviation) deviation_x = x;
      deviation = std::max(deviation, off);
      following = following.max((c.sample.command_in_effect - c.sample.position).abs());
      if (c.setpoint.step != StepKind::kEven || x < 0 || x > job_.cutter.flute_length) continue;
      if (c.setpoint.feed < low) low_x = x;
      low = std::min(low, c.setpoint.feed);
      high = std::max(high, c.setpoint.feed);
    }
    EXPECT_NEAR(reported["feed_min_mm_min"], low * 60e3, 1e-6);
    EXPECT_NEAR(reported["feed_min_x_mm"], low_x * 1e3, 1e-9);
    EXPECT_NEAR(reported["feed_max_mm_min"], high * 60e3, 1e-6);
    EXPECT_NEAR(reported["deviation_um"], deviation * 1e6, 1e-9);
    EXPECT_NEAR(reported["deviation_x_mm"], deviation_x * 1e3, 1e-9);
    const Axes scale(1e6, 1e6, 1e6, 180e3 / units::kPi);
    const char* const names[]{"x_um", "y_um", "z_um", "a_mdeg"};
    for (int axis = 0; axis < kAxisCount; ++axis) {
      EXPECT_NEAR(reported["following_error"][names[axis]], following[axis] * scale[axis], 1e-9);
    }
  }

  const test_support::TempFolder folder_;
  const LoopConfig config_ = test_support::machineConfig();
  const GrindJob job_ = shortJob();
  PlannedJob plan_;
  std::mt19937 engine_{1};
  std::vector<Cycle> cycles_;
  double time_ = kStart;
  double override_ = 1;
  Axes command_ = config_.machine.park;
};

TEST_F(JobRecordTest, StrokesAreThoseOfTheSetpoints) {
  makeCycles();
  const Json record = recorded();
  ASSERT_EQ(record["strokes"].size(), 4U);
  // 0.6 mm, then the rest, where the flute is deepest: at the small end.
  const double depths[]{0.6, 1.0};
  std::size_t i = 0;
  for (const int tooth : {0, 1}) {
    for (const int pass : {0, 1}) {
      const Json& reported = record["strokes"][i++];
      expectStroke(reported, tooth, pass);
      EXPECT_NEAR(reported["depth_mm"], depths[pass], 1e-12);
    }
  }
}

TEST_F(JobRecordTest, HoldsAndOverridesAreThoseOfTheCycles) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    engine_.seed(seed);
    cycles_.clear();
    override_ = once(2) ? 1 : 0.5;
    makeCycles();
    const Json record = recorded();
    const Json& holds = record["holds"];
    const Json& overrides = record["overrides"];
    std::size_t hold = 0, change = 0;
    double override = 1;
    ToothPass pass;
    for (std::size_t i = 0; i < cycles_.size(); ++i) {
      const CycleSample& r = cycles_[i].sample;
      if (r.feed_override != override) {
        override = r.feed_override;
        ASSERT_LT(change, overrides.size());
        EXPECT_NEAR(overrides[change]["at_s"], since(r), 1e-6);
        EXPECT_NEAR(overrides[change]["percent"], override * 100, 1e-12);
        EXPECT_EQ(overrides[change]["tooth"], pass.tooth + 1);
        EXPECT_EQ(overrides[change++]["pass"], pass.pass + 1);
      }
      if (r.state == MachineState::kHolding && cycles_[i - 1].sample.state != MachineState::kHolding) {
        std::size_t end = i;
        while (cycles_[end].sample.state != MachineState::kResuming) ++end;
        ASSERT_LT(hold, holds.size());
        EXPECT_NEAR(holds[hold]["at_s"], since(r), 1e-6);
        EXPECT_NEAR(holds[hold]["duration_s"], cycles_[end].sample.time - r.time, 1e-6);
        EXPECT_EQ(holds[hold]["reason"], r.interlock == Interlock::kNone ? "operator" : "no coolant flows");
        EXPECT_EQ(holds[hold]["tooth"], pass.tooth + 1);
        EXPECT_EQ(holds[hold++]["pass"], pass.pass + 1);
      }
      if (cycles_[i].has_setpoint) pass = {cycles_[i].setpoint.tooth, cycles_[i].setpoint.pass};
    }
    EXPECT_EQ(hold, holds.size());
    EXPECT_EQ(change, overrides.size());
    EXPECT_GT(hold + change, 0U);
  }
}

TEST_F(JobRecordTest, ReportsJobMachinePlanAndLateCycles) {
  makeCycles();
  JobRecord made(plan_, kNames, {}, false);
  give(made);
  made.addLost(3);
  made.conclude({"done", "", 5});
  EXPECT_EQ(made.record("/grinder", kMachine, kTolerances).head.strokes, 4U);
  const Json record = documentOf(made);
  Json expected = Json::parse(R"({
    "grinder": "/grinder", "job": "short.yaml", "wheel": "wheel.yaml", "dressed": "2026-11-20", "wear_mm": 0.01,
    "tool": "D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 2 teeth", "passes": 4, "lost": 3,
    "outcome": "done", "omitted": 0, "not_ground": ""})");
  expected["digest"] = jobDigest(job_);
  expected["started"] = utcText(cycles_.front().sample.time);
  expected["ended"] = utcText(cycles_.back().sample.time);
  expected["duration_s"] = std::round((timeOf(expected["ended"]) - timeOf(expected["started"])) * 1e3) / 1e3;
  const Json machine = Json::parse(R"({"name": "mill", "software": "1.2.3", "drive": "some/Drive", "period_ms": 1})"),
             planned = Json::parse(R"({"setpoints": 4321, "duration_s": 4.32, "max_deviation_um": 0.5})");
  for (const auto& [part, figures] :
       {std::pair(record, expected), {record["machine"], machine}, {record["planned"], planned}}) {
    for (const auto& figure : figures.items()) EXPECT_EQ(part[figure.key()], figure.value()) << figure.key();
  }
  EXPECT_EQ(record["machine"]["max_velocity"]["z_mm_s"], 3000);
  EXPECT_EQ(record["machine"]["max_acceleration"]["x_mm_s2"], 5000);
  EXPECT_NEAR(record["machine"]["max_following_error"]["a_deg"], 12 * 180 / units::kPi, 1e-9);
  EXPECT_EQ(jobDigest(parseJob(record["job_file"].dump(), "reported")), jobDigest(job_));
  double longest = 0;
  int late = 0;
  for (const Cycle& c : cycles_) {
    longest = std::max(longest, c.sample.period);
    late += c.sample.period > 0.0015;
  }
  EXPECT_GT(late, 0);
  EXPECT_EQ(record["late_cycles"]["count"], late);
  EXPECT_NEAR(record["late_cycles"]["longest_ms"], longest * 1000, 1e-9);
}

TEST_F(JobRecordTest, WithoutTheCheckOfTheZeroPointsItHasNotPassed) {
  makeCycles();
  const auto because = [&](bool said_right) {
    JobRecord record(plan_, {}, {}, said_right);
    for (const Cycle& c : cycles_) record.addCycle(c.sample);
    record.conclude({"done", "", 5});
    Tolerances tolerances = kTolerances;
    tolerances.late_cycles_percent = 100;
    const std::vector<std::string> reasons = record.record("/grinder", kMachine, tolerances).head.because;
    return std::count(reasons.begin(), reasons.end(), kNoOffsetCheck);
  };
  EXPECT_EQ(because(false), 0);
  EXPECT_EQ(because(true), 1);
}

/// Axes that are off by the same everywhere, on a machine with work offsets.
TEST_F(JobRecordTest, KeepsWhereTheWheelWas) {
  const Axes offset(0.01, -0.02, 0.03, 0.4), off(0, 3e-6, -2e-6, 1e-5);
  plan_.program = std::make_shared<const GrindProgram>(ValidJob(job_), config_.machine,
                                                       RunStart(config_.machine.park + offset, {}, offset));
  command_ = config_.machine.park;
  makeCycles();
  Axes reached = config_.machine.park;
  for (Cycle& c : cycles_) {
    c.sample.position = reached + offset + off;
    if (c.has_setpoint) reached = c.setpoint.position;
  }
  const std::vector<RunStroke> strokes = runStrokesFrom(recorded()["ground"]);
  std::size_t count = 0;
  for (const RunStroke& stroke : strokes) {
    if (stroke.move != MoveKind::kStroke || stroke.place.pass != 1) continue;
    ++count;
    for (const PathDeviation& deviation : stroke.deviations) {
      EXPECT_NEAR(deviation.y, off[kY], 2e-9);
      EXPECT_NEAR(deviation.z, off[kZ], 2e-9);
      EXPECT_NEAR(deviation.a, off[kA], 5e-7);
    }
  }
  EXPECT_EQ(count, 2U);
}

TEST_F(JobRecordTest, HeadSaysWhichPartOfItsToolItIs) {
  const auto head = [&](const GrindJob& job, const ToothPass& first) {
    plan_.program =
        std::make_shared<const GrindProgram>(ValidJob(job), config_.machine, RunStart(config_.machine.park, first));
    return JobRecord(plan_, {}, {}, false).record("/grinder", kMachine, kTolerances).head;
  };
  const RecordHead alone = head(job_, {}), flute = head(readJobFile("jobs/end_mill_d10_t4.yaml", "1"), {1, 0});
  EXPECT_EQ(alone.operation, "");
  EXPECT_TRUE(alone.ends_tool);
  EXPECT_FALSE(alone.continues);
  EXPECT_EQ(flute.operation, "flute");
  EXPECT_FALSE(flute.ends_tool);
  EXPECT_TRUE(flute.continues);
}

TEST_F(JobRecordTest, ReportsWhatItLeavesOut) {
  JobRecord record(plan_, {}, {}, false);
  for (int i = 0; i < 10004; ++i) {
    override_ = i % 2 == 0 ? 0.5 : 1;
    record.addCycle(cycle(MachineState::kRunning).sample);
    record.addCycle(cycle(MachineState::kHeld).sample);
    record.addCycle(cycle(MachineState::kHeld).sample);
  }
  const Json reported = documentOf(record);
  EXPECT_EQ(reported["holds"].size(), 10000U);
  EXPECT_EQ(reported["overrides"].size(), 10000U);
  EXPECT_EQ(reported["omitted"], 8);
  EXPECT_NEAR(reported["holds"].back()["duration_s"], cycles_[29999].sample.time - cycles_[29998].sample.time, 0.01);
}

TEST_F(JobRecordTest, OfAJobThatNobodyEndedSaysSo) {
  makeCycles();
  const auto in_stroke = [](const Cycle& c) { return c.setpoint.move == MoveKind::kStroke && c.setpoint.pass == 1; };
  cycles_.erase(std::find_if(cycles_.begin(), cycles_.end(), in_stroke) + 5, cycles_.end());
  {
    History history(folder_.path(), 1 << 20);
    JobRecorder recorder("/grinder", kMachine, kTolerances, history);
    recorder.announce(7, newRecord());
    recorder.announce(8, newRecord());
    give(recorder.of(7));
  }
  ASSERT_EQ(kept().size(), 1U);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / recordName(cycles_.front().sample.time, {})));
  const Json record = kept()[0];
  EXPECT_EQ(record["outcome"], "fault");
  EXPECT_EQ(record["reason"], "the grinder's program ended before the job did");
  EXPECT_FALSE(record["strokes"].back()["complete"]);
  const Json &zeros = record["zero_points"], &x = zeros["x"], &y = zeros["y"];
  EXPECT_TRUE(zeros["said_right"]);
  EXPECT_EQ(x["set_by"], "anna@grinder");
  EXPECT_EQ(x["set_for"]["method"], "probe");
  EXPECT_NEAR(x["set_for"]["swivel_deg"].get<double>(), 30, 1e-12);
  EXPECT_TRUE(y["set_by"].is_null());
  EXPECT_EQ(y["set_for"]["method"], "unknown");
  EXPECT_TRUE(y["set_for"]["end_diameter_mm"].is_null());
}

TEST_F(JobRecordTest, IsKeptWhicheverComesFirst) {
  makeCycles();
  for (const bool result_first : {true, false}) {
    History history(folder_.path(), 1 << 20);
    JobRecorder recorder("/grinder", kMachine, kTolerances, history);
    recorder.announce(1, newRecord());
    give(recorder.of(1), result_first ? 0 : 100);
    if (result_first) recorder.conclude(1, {"canceled", "by hand", 9});
    recorder.end(1);
    if (!result_first) recorder.conclude(1, {"canceled", "by hand", 9});
    recorder.conclude(1, {"fault", "too late", 0});
  }
  ASSERT_EQ(kept().size(), 2U);
  for (const Json& record : kept()) EXPECT_EQ(record["reason"], "by hand");
}

TEST(RecordName, SortsByTheOrderOfWritingAndNamesTheStart) {
  EXPECT_EQ(recordName(kStart, {}), "0000000001_20261122T170413.123Z.json");
  RecordFiles before{{"a/0000000009_20360101T000000.000Z.json"},
                     {"a/0000000041_20261122T170413.123Z.json.new"},
                     {"a/0000000010_20261122T170413.123Z.json"}};
  EXPECT_EQ(recordName(kStart, before), "0000000042_20261122T170413.123Z.json");
  EXPECT_EQ(startOf("a_b/" + recordName(kStart, before)), startText(kStart));
  before.others.emplace_back("a/9999999998_20261122T170413.123Z.json");
  EXPECT_EQ(recordName(kStart, before), "9999999999_20261122T170413.123Z.json");
  before.records.emplace_back("a/9999999999_20261122T170413.123Z.json");
  EXPECT_EQ(test_support::refusalOf<std::runtime_error>([&] { recordName(kStart, before); }),
            "a/9999999999_20261122T170413.123Z.json: has the greatest number; move it elsewhere");
  EXPECT_TRUE(isRecordName(recordName(kStart, {})));
  for (const char* wrong : {"", "0000000001_20261122T170413.123Z.jso", "0000000001_20261122T170413.123Z.json.",
                            "0000000001_2026112xT170413.123Z.json", "20261122T170413.123Z.json"}) {
    EXPECT_FALSE(isRecordName(wrong)) << wrong;
  }
}

TEST(RecordTime, SortsAndReadsBack) {
  EXPECT_EQ(utcText(kStart), "2026-11-22T17:04:13.123Z");
  EXPECT_EQ(startText(kStart), "20261122T170413.123Z");
  EXPECT_NEAR(timeOf(utcText(kStart)), kStart, 1e-3);
  std::mt19937 engine(1);
  double time = kStart;
  for (int i = 0; i < 10000; ++i) {
    const double later = time + std::exp(std::uniform_real_distribution<>(-6, 15)(engine));
    EXPECT_LT(startText(time), startText(later));
    EXPECT_NEAR(timeOf(utcText(later)), later, 1.001e-3);
    time = std::uniform_real_distribution<>(0, 4e9)(engine);
  }
  for (const char* wrong : {"", "2026-11-22", "2026-11-22T17:04:13.12Z", "2026-11-22T17:04:13.123+"}) {
    EXPECT_THROW(timeOf(wrong), std::invalid_argument) << wrong;
  }
}

}  // namespace test_job_record
}  // namespace grinder
