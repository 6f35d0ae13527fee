#include "cli/csv.h"
#include "cli/json_output.h"
#include "cli/last_job.h"
#include "cli/offsets.h"
#include "cli/time_text.h"
#include "refusal.h"
#include "temp_folder.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <time.h>

#include <fstream>

// What commands print and write, without a machine.
namespace grinder {
namespace test_texts {

TEST(TimeText, IsToTheSecond) {
  setenv("TZ", "Europe/Berlin", 1);
  tzset();
  // 20 780 days after the epoch, 17:04:13.
  const double time = 20780 * 86400.0 + 17 * 3600 + 4 * 60 + 13.9;
  EXPECT_EQ(timeText(time, true), "2026-11-23T17:04:13Z");
  EXPECT_EQ(timeText(time, false), "2026-11-23 18:04:13");
}

TEST(TimeOfDate, IsOfTheClocksHereOrOfUtc) {
  setenv("TZ", "Europe/Berlin", 1);
  tzset();
  const double day = 20780 * 86400.0;  // 2026-11-23 in UTC, an hour later than here
  EXPECT_DOUBLE_EQ(timeOfDate("2026-11-23Z", false), day);
  EXPECT_DOUBLE_EQ(timeOfDate("2026-11-23", false), day - 3600);
  EXPECT_DOUBLE_EQ(timeOfDate("2026-11-23", true), day - 3600 + 86400 - 0.001);
  EXPECT_DOUBLE_EQ(timeOfDate("2026-11-23T17:04", false), day - 3600 + 17 * 3600 + 4 * 60);
  EXPECT_DOUBLE_EQ(timeOfDate("2026-11-23T17:04Z", true), day + 17 * 3600 + 5 * 60 - 0.001);
  EXPECT_DOUBLE_EQ(timeOfDate("2026-11-23T17:04:13Z", true), day + 17 * 3600 + 4 * 60 + 13.999);
  EXPECT_DOUBLE_EQ(timeOfDate("2026-11-23T17:04:13.123Z", true), day + 17 * 3600 + 4 * 60 + 13.123);
  EXPECT_DOUBLE_EQ(timeOfDate("2026-07-01", false), (20780 - 145) * 86400.0 - 7200);  // summer time
  for (const char* wrong :
       {"", "Z", "yesterday", "2026-11", "2026-11-23T17", "2026-11-23 17:04", "2026-02-29", "2026-11-23T25:00"}) {
    EXPECT_THROW(timeOfDate(wrong, false), std::invalid_argument) << wrong;
  }
}

flute_grinder::JobProgress progress() {
  flute_grinder::JobProgress progress;
  progress.job_name = "mill";
  progress.job_digest = "0123456789abcdef";
  progress.cutter.end_diameter = 0.012;
  progress.cutter.flute_length = 0.0625;
  progress.cutter.tooth_angles = {0, 1, 2};
  progress.tooth = 1;
  progress.pass = 4;
  progress.x = 0.0123456;
  return progress;
}

TEST(LastJob, SaysHowFarItGot) {
  flute_grinder::JobProgress job = progress();
  EXPECT_EQ(lastJob(job),
            "mill (D 12 mm, cone 0 deg, spiral 0 deg, rake 0 deg, 3 teeth): tooth 2, pass 5 not finished, X 12.346 mm "
            "(0123456789ab)");
  job.operation = "primary relief";
  EXPECT_EQ(lastJob(job).substr(0, 27), "mill, primary relief (D 12 ");
  job.finished = 1;
  job.job_name.clear();
  job.operation.clear();
  EXPECT_EQ(lastJob(job),
            "a job without a name (D 12 mm, cone 0 deg, spiral 0 deg, rake 0 deg, 3 teeth): finished (0123456789ab)");
}

TEST(StatusJson, CountsFromOneAndInShopUnits) {
  flute_grinder::GrinderState state;
  state.state_name = "running";
  state.state = flute_grinder::GrinderState::RUNNING;
  state.swivel = 0.5;
  state.enabled = state.homed = state.coolant_commanded = state.wheel_in_work = 1;
  state.position = {0.001, 0, 0, 0};
  state.work_position = {0, 0.004, 0, 0};
  state.distance_to_go = {0, 0, 0.008, 0};
  state.feed = 0.01;
  state.override = 0.75;
  state.tooth = 2;
  state.progress = progress();
  state.progress.cutter.cone_angle = state.progress.cutter.spiral_angle = state.progress.cutter.rake_angle = 0.5;
  const Json json = toJson("/left", state, nullptr);
  EXPECT_EQ(json["grinder"], "/left");
  EXPECT_NEAR(json["swivel_deg"].get<double>(), 90 / M_PI, 1e-12);
  EXPECT_NEAR(json["feed_mm_min"].get<double>(), 600, 1e-9);
  EXPECT_EQ(json["override_percent"], 75);
  EXPECT_EQ(json["tooth"], 3);
  EXPECT_EQ(json["pass"], 1);
  EXPECT_TRUE(json["zero_points"].is_null());
  for (const char* set : {"enabled", "homed", "coolant_commanded", "wheel_in_work"}) {
    EXPECT_EQ(json[set], true) << set;
  }
  for (const char* unset :
       {"spindle_at_speed", "coolant_on", "spindle_commanded", "emergency_stop", "swivel_measured", "power_stays_on"}) {
    EXPECT_EQ(json[unset], false) << unset;
  }
  EXPECT_EQ(json["machine"]["x_mm"], 1);
  EXPECT_EQ(json["work"]["y_mm"], 4);
  EXPECT_EQ(json["to_go"]["z_mm"], 8);
  EXPECT_EQ(json["last_job"]["pass"], 5);
  EXPECT_NEAR(json["last_job"]["x_mm"].get<double>(), 12.3456, 1e-9);
  EXPECT_EQ(json["last_job"]["cutter"]["teeth"], 3);
  EXPECT_EQ(json["last_job"]["cutter"]["flute_length_mm"], 62.5);
  for (const char* angle : {"cone_angle_deg", "spiral_angle_deg", "rake_angle_deg"}) {
    EXPECT_NEAR(json["last_job"]["cutter"][angle].get<double>(), 90 / M_PI, 1e-12) << angle;
  }
  state.state = flute_grinder::GrinderState::READY;
  state.progress.job_digest.clear();
  EXPECT_TRUE(toJson("/left", state, nullptr)["tooth"].is_null());
  EXPECT_TRUE(toJson("/left", state, nullptr)["last_job"].is_null());
}

TEST(OffsetArgument, IsAnAxisAndAFiniteNumber) {
  for (const char* good : {"x=0", "y=45.2", "z=-1e-3", "a=.5"}) EXPECT_EQ(offsetRefusal(good), "") << good;
  for (const char* wrong : {"", "x", "x=", "b=1", "xy=1", "x:1", "x=nan", "x=inf", "x=1 mm", "x=one"}) {
    EXPECT_EQ(offsetRefusal(wrong).find(std::string(wrong) + "; allowed: AXIS=VALUE"), 0U) << wrong;
  }
}

class Csv : public ::testing::Test {
 protected:
  std::string path(const char* name) const { return folder_.path() / name; }

 private:
  test_support::TempFolder folder_;
};

TEST_F(Csv, HasEveryBit) {
  TableCsv table(path("table.csv"));
  CurvePoint point;
  point.x = 1e-3 / 3;
  point.a = 0.1;
  table.write(7, point, 0.3);
  table.close();
  double x = 0, a = 0, theory = 0, error = 0;
  const std::string text = test_support::readFile(path("table.csv"));
  const std::string head = "point,x_mm,a_rad,a_theory_rad,error_rad\n7,";
  ASSERT_EQ(text.substr(0, head.size()), head);
  ASSERT_EQ(std::sscanf(text.c_str() + head.size(), "%lf,%lf,%lf,%lf", &x, &a, &theory, &error), 4);
  EXPECT_EQ(x, 1e-3 / 3 / 1e-3);
  EXPECT_EQ(a, 0.1);
  EXPECT_EQ(theory, 0.3);
  EXPECT_EQ(error, 0.3 - 0.1);
}

TEST_F(Csv, OfNothingLeavesTheFilesAsTheyWere) {
  std::ofstream(path("old.csv")) << "old";
  {
    const TableCsv kept(path("old.csv"));
    const TableCsv none(path("new.csv"));
  }
  EXPECT_EQ(test_support::readFile(path("old.csv")), "old");
  EXPECT_FALSE(std::filesystem::exists(path("new.csv")));
  TableCsv(path("old.csv")).close();
  EXPECT_EQ(test_support::readFile(path("old.csv")), "point,x_mm,a_rad,a_theory_rad,error_rad\n");
}

TEST_F(Csv, ThatCannotBeWrittenIsNamed) {
  EXPECT_EQ(test_support::refusalOf([&] { TableCsv(path("no/such.csv")); }),
            path("no/such.csv") + ": cannot be written: No such file or directory");
  EXPECT_EQ(test_support::refusalOf<WriteError>([] { TableCsv("/dev/full").close(); }),
            "/dev/full: write failed: No space left on device");
}

}  // namespace test_texts
}  // namespace grinder
