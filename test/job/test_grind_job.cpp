#include "flute_grinder/job/valid_job.h"

#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "motion/examples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace grinder {
namespace test_grind_job {

using test_support::paperJob;

constexpr double kPi = 3.141592653589793238462643383279502884;
constexpr double kDeg = kPi / 180;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

// A back taper of 3 deg loses 0.0524 mm of radius per mm: D1 2 mm closes at X = 19.08 mm.
void backTaper(GrindJob& j, double length, double shank) {
  j.cutter.end_diameter = 2e-3;
  j.cutter.cone_angle = -3 * kDeg;
  j.cutter.flute_length = length;
  j.process().overtravel_shank = shank;
  j.process().depth = j.process().infeed = 0.01e-3;
}

/// Of the wheel's 50 mm half a millimetre is left, for two teeth in two passes each.
void wearPerPass(GrindJob& j, double wear) {
  j.tooth_angles = {0, 3};
  j.process().spark_out = 1;
  j.process().wheel_wear = 49.5e-3;
  j.process().wheel_wear_per_pass = wear;
}

/// A flute that is 1.5 mm deep, and more at its end.
void chord(GrindJob& j, double depth) {
  j.cutter.core_diameter = 7e-3;
  j.cutter.core_diameter_end = 9e-3;
  j.cutter.chordal_rake_depth = depth;
}

/// A wheel of 100 x 8 mm by its points [mm].
void points(GrindJob& j, const std::vector<std::pair<double, double>>& mm) {
  j.process().wheel_profile = WheelShape::kPoints;
  for (const auto& [w, radius] : mm) j.process().wheel_points.push_back({w * 1e-3, radius * 1e-3});
}

/// A wheel of the profile, as the operations on the end take it.
void wheel(GrindJob& j, WheelShape profile) {
  j.process().wheel_profile = profile;
  j.process().wheel_angle = profile == WheelShape::kAngled ? 20 * kDeg : 0;
  j.process().wheel_rim = 0;
  j.process().wheel_side = profile == WheelShape::kCup ? WheelFace::kLower : WheelFace::kUpper;
}

/// A back taper that closes 1.08 mm beyond the flute, and the shift of the wheel.
void shifted(GrindJob& j, double x_shift, double shank) {
  backTaper(j, 18e-3, shank);
  j.process().setup_x_shift = x_shift;
}

/// Contradictions between the figures of a job, each with its only reason.
TEST(GrindJob, NamesAContradictionOnceWithWhatIsAllowed) {
  const struct {
    std::function<void(GrindJob&)> change;
    const char* reason;
  } rows[]{
      {[](GrindJob& j) { backTaper(j, 25e-3, 0); },
       "cutter.flute_length_mm = 25 mm; allowed: less than 19.08113669 mm, where the cone closes"},
      {[](GrindJob& j) { backTaper(j, 18e-3, 2e-3); },
       "process.overtravel_mm[1] = 2 mm; allowed: less than 1.081136688 mm, where the cone closes"},
      // 10 mm at 5 deg closes at X = -57.15 mm.
      {[](GrindJob& j) { j.process().overtravel_end = 58e-3; },
       "process.overtravel_mm[0] = 58 mm; allowed: less than 57.15026151 mm, where the cone closes"},
      // The shift moves the wheel, but takes nothing back of what closes the cone.
      {[](GrindJob& j) { shifted(j, -1.0812e-3, 0); },
       "process.setup.x_shift_mm = -1.0812 mm; allowed: -1.081136688 to 100 mm"},
      {[](GrindJob& j) { shifted(j, -0.5e-3, 1e-3); },
       "process.overtravel_mm[1] = 1 mm; allowed: less than 0.5811366877 mm, where the cone closes"},
      {[](GrindJob& j) { shifted(j, 0.5e-3, 1.2e-3); },
       "process.overtravel_mm[1] = 1.2 mm; allowed: less than 1.081136688 mm, where the cone closes"},
      {[](GrindJob& j) { j.process().setup_x_shift = 58e-3; },
       "process.setup.x_shift_mm = 58 mm; allowed: less than 57.15026151 mm, where the cone closes"},
      {[](GrindJob& j) { j.process().setup_x_shift = 28e-3, j.process().overtravel_end = 30e-3; },
       "process.overtravel_mm[0] = 30 mm; allowed: less than 29.15026151 mm, where the cone closes"},
      {[](GrindJob& j) { j.process().setup_x_shift = -28e-3, j.process().overtravel_end = 58e-3; },
       "process.overtravel_mm[0] = 58 mm; allowed: less than 57.15026151 mm, where the cone closes"},
      {[](GrindJob& j) { j.process().depth = 5e-3; },
       "process.depth_mm = 5 mm; allowed: less than 5 mm, the cutter's radius at the small end"},
      {[](GrindJob& j) { backTaper(j, 10e-3, 0), j.process().depth = 0.5e-3; },
       "process.depth_mm = 0.5 mm; allowed: less than 0.4759222072 mm, the cutter's radius at the flute's end"},
      {[](GrindJob& j) { j.process().depth_end = 7.63e-3; },
       "process.depth_end_mm = 7.63 mm; allowed: less than 7.624659906 mm, the cutter's radius at the flute's end"},
      {[](GrindJob& j) { chord(j, 1.5e-3); },
       "cutter.chordal_rake_depth_mm = 1.5 mm; allowed: less than 1.5 mm, the asked depth of the flute"},
      {[](GrindJob& j) { chord(j, 1.2e-3), j.cutter.core_diameter_end = 13e-3; },
       "cutter.chordal_rake_depth_mm = 1.2 mm; allowed: less than 1.124659906 mm, the asked depth of the flute"},
      {[](GrindJob& j) { j.spiral_angles = {31 * kDeg}; },
       "cutter.spiral_angles_deg = 31 deg; allowed: first cutter.spiral_angle_deg, 30 deg"},
      {[](GrindJob& j) { j.process().finish_infeed = 0.6e-3; },
       "process.finish_infeed_mm = 0.6 mm; allowed: up to the depth, 0.5 mm"},
      {[](GrindJob& j) { j.process().wheel_wear = 50e-3; },
       "process.wheel.wear_mm = 50 mm; allowed: less than 50 mm, the wheel's radius"},
      {[](GrindJob& j) { j.process().depth = 4e-3, j.process().infeed = 0.1e-6; },
       "process.infeed_mm = 0.0001 mm; allowed: enough for the depth in 10000 passes per tooth, 20000 of all teeth"},
      // 3 times 6667 are 20,001.
      {[](GrindJob& j) {
         j.tooth_angles = {0, 2, 4};
         j.process().depth = 4e-3, j.process().infeed = 4e-3 / 6665;
       },
       "process.infeed_mm = 0.0006001500375 mm; allowed: enough for the depth in 6666 passes per tooth, 20000 of all "
       "teeth"},
      {[](GrindJob& j) { j.cutter.core_diameter = 10e-3; },
       "cutter.core_diameter_mm = 10 mm; allowed: less than 10 mm, the cutter's diameter at the small end"},
      {[](GrindJob& j) { j.cutter.core_diameter_end = 15.25e-3; },
       "cutter.core_diameter_end_mm = 15.25 mm; allowed: less than 15.24931981 mm, the cutter's diameter at the "
       "flute's end"},
      {[](GrindJob& j) {
         j.process().wheel_points = {{0, 50e-3}};
       },
       "process.wheel.points_mm = 1; allowed: 0 to 0"},
      {[](GrindJob& j) { j.tooth_angles.clear(); }, "cutter.teeth = 0; allowed: 1 to 64"},
      {[](GrindJob& j) {
         for (int i = 1; i < 65; ++i) j.tooth_angles.push_back(i * 0.09);
       },
       "cutter.teeth = 65; allowed: 1 to 64"},
      {[](GrindJob& j) { j.process().order = static_cast<GrindOrder>(3); }, "process.order = 3; allowed: 0 to 2"},
      {[](GrindJob& j) { j.process().order = static_cast<GrindOrder>(-1); }, "process.order = -1; allowed: 0 to 2"},
      {[](GrindJob& j) { j.process().infeed = 0; },
       "process.infeed_mm = 0 mm; allowed: 0.0001 to 50 mm, or process.roughing_passes or process.removal_mm3_s in its "
       "place"},
      {[](GrindJob& j) { j.process().infeed = 0.09e-6; },
       "process.infeed_mm = 9e-05 mm; allowed: 0.0001 to 50 mm, or process.roughing_passes or process.removal_mm3_s in "
       "its place"},
      {[](GrindJob& j) { j.process().roughing_passes = 1; },
       "process.roughing_passes = 1; allowed: 0 beside process.infeed_mm = 0.5 mm"},
      {[](GrindJob& j) { j.process().removal = 8e-9; },
       "process.removal_mm3_s = 8 mm^3/s; allowed: 0 beside process.infeed_mm = 0.5 mm"},
      {[](GrindJob& j) { j.process().infeed = 0, j.process().roughing_passes = 4, j.process().removal = 8e-9; },
       "process.roughing_passes = 4; allowed: 0 beside process.removal_mm3_s = 8 mm^3/s"},
      {[](GrindJob& j) { j.process().infeed = 0, j.process().roughing_passes = 201; },
       "process.roughing_passes = 201; allowed: 0 to 200"},
      {[](GrindJob& j) { j.process().infeed = 0, j.process().removal = std::nan(""); },
       "process.removal_mm3_s = nan mm^3/s; allowed: 0 to 10000 mm^3/s"},
      {[](GrindJob& j) { j.process().direction = static_cast<StrokeDirection>(2); },
       "process.direction = 2; allowed: 0 to 1"},
      {[](GrindJob& j) { j.process().z_law = static_cast<ZLaw>(2); }, "process.z_law = 2; allowed: 0 to 1"},
      {[](GrindJob& j) { j.interpolation.even_step = static_cast<EvenStepRule>(3); },
       "interpolation.even_step = 3; allowed: 0 to 2"},
  };
  for (const auto& row : rows) {
    GrindJob job = paperJob();
    row.change(job);
    EXPECT_EQ(text(validate(job)), row.reason);
  }
}

TEST(GrindJob, NamesWhatIsWrongWithThePointsOfAWheel) {
  const struct {
    std::vector<std::pair<double, double>> mm;
    const char* reason;
  } rows[]{
      {{{0, 50}}, "process.wheel.points_mm = 1; allowed: 2 to 100"},
      {std::vector<std::pair<double, double>>(101), "process.wheel.points_mm = 101; allowed: 2 to 100"},
      {{{-4, 50}, {4, 0.0499}}, "process.wheel.points_mm = 0.0499 mm; allowed: 0.05 to 250 mm"},
      {{{-4, 50}, {0, kNan}, {4, 50}}, "process.wheel.points_mm = nan mm; allowed: 0.05 to 250 mm"},
      {{{-3.9995, 50}, {4.0005, 50}},
       "process.wheel.points_mm = -3.9995 mm; allowed: the middle of the width at 0, so -4.0005 mm"},
      {{{-4.0005, 50}, {3.9995, 50}},
       "process.wheel.points_mm = -4.0005 mm; allowed: the middle of the width at 0, so -3.9995 mm"},
      {{{-4, 50.0005}, {4, 49}}, "process.wheel.diameter_mm = 100 mm; allowed: that of its points, 100.001 mm"},
      {{{-4, 49}, {4, 49.9995}}, "process.wheel.diameter_mm = 100 mm; allowed: that of its points, 99.999 mm"},
      {{{-4.0005, 50}, {4.0005, 50}}, "process.wheel.width_mm = 8 mm; allowed: that of its points, 8.001 mm"},
      {{{-3.9995, 50}, {3.9995, 50}}, "process.wheel.width_mm = 8 mm; allowed: that of its points, 7.999 mm"},
  };
  for (const auto& row : rows) {
    GrindJob job = paperJob();
    points(job, row.mm);
    EXPECT_EQ(text(validate(job)), row.reason);
  }
}

TEST(GrindJob, TakesAsMuchAsIsAllowed) {
  std::vector<std::function<void(GrindJob&)>> changes{
      [](GrindJob& j) { j.process().overtravel_end = 57e-3; },
      [](GrindJob& j) { backTaper(j, 18e-3, 1e-3), j.process().overtravel_end = 100e-3; },
      [](GrindJob& j) { shifted(j, -1.081e-3, 0); },
      [](GrindJob& j) { shifted(j, 0.5e-3, 1.08e-3); },
      [](GrindJob& j) { j.process().setup_x_shift = -28e-3, j.process().overtravel_end = 57e-3; },
      [](GrindJob& j) {
        points(j, {{-4, 50}, {0, 0.05}, {4, 49}});
      },
      [](GrindJob& j) {
        points(j, {{-4, 250}, {4, 250}}), j.process().wheel_diameter = 500e-3;
      },
      [](GrindJob& j) { wearPerPass(j, 0.125e-3 * (1 - 1e-6)); },
      [](GrindJob& j) { j.process().depth_end = 7.62e-3; },
      [](GrindJob& j) { chord(j, 1.499e-3); },
      [](GrindJob& j) { j.process().infeed = 0, j.process().removal = 8e-9; },
      [](GrindJob& j) {
        j.tooth_angles = {0, 88 * kDeg, 180 * kDeg, 268 * kDeg, 359.999 * kDeg};
      },
  };
  // The ends of angles, however they were computed.
  for (const double end : {60 * kPi / 180, 60 * kDeg, kPi / 3}) {
    for (const int side : {-1, 1}) changes.emplace_back([=](GrindJob& j) { j.cutter.spiral_angle = side * end; });
    changes.emplace_back([=](GrindJob& j) { j.cutter.cone_angle = end / 2; });
  }
  for (const auto& change : changes) {
    GrindJob job = paperJob();
    change(job);
    EXPECT_EQ(text(validate(job)), "");
  }
}

TEST(GrindJob, RefusesTeethOutOfOrder) {
  const struct {
    std::vector<double> angles;
    const char* value;
  } rows[]{{{36 * kDeg, 1}, "36"},    {{-36 * kDeg, 1}, "-36"},
           {{0, 2, 90 * kDeg}, "90"}, {{0, 90 * kDeg, 90 * kDeg}, "90"},
           {{0, 2 * kPi}, "360"},     {{0, 400 * kDeg}, "400"},
           {{0, kNan}, "nan"},        {{kNan}, "nan"},
           {{0, kInf}, "inf"},        {{0, 0}, "0"}};
  for (const auto& row : rows) {
    GrindJob job = paperJob();
    job.tooth_angles = row.angles;
    EXPECT_EQ(text(validate(job)), std::string("cutter.tooth_angles_deg = ") + row.value +
                                       " deg; allowed: 0 first, then ascending, below 360 deg");
  }
}

TEST(PassDepths, AreThoseByHand) {
  const struct {
    const char* name;
    double depth, infeed, finish;  ///< [mm]
    int spark_out;
    std::vector<double> expected;
  } rows[]{{"one pass", 0.5, 0.5, 0, 0, {0.5}},
           {"infeed above depth", 0.5, 2, 0, 0, {0.5}},
           {"even steps", 1.5, 0.5, 0, 0, {0.5, 1, 1.5}},
           {"smaller last", 1.2, 0.5, 0, 0, {0.5, 1, 1.2}},
           {"rounding makes no pass", 0.9, 0.3, 0, 0, {0.3, 0.6, 0.9}},
           {"finish", 1.5, 0.5, 0.05, 0, {0.5, 1, 1.45, 1.5}},
           {"finish takes it all", 0.05, 0.5, 0.05, 0, {0.05}},
           {"spark-out", 1, 0.5, 0, 2, {0.5, 1, 1, 1}},
           {"finish and spark-out", 1.5, 0.5, 0.05, 1, {0.5, 1, 1.45, 1.5, 1.5}},
           {"finish larger than infeed", 1, 0.25, 0.5, 0, {0.25, 0.5, 1}}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    GrindProcess process;
    process.depth = row.depth * 1e-3;
    process.infeed = row.infeed * 1e-3;
    process.finish_infeed = row.finish * 1e-3;
    process.spark_out = row.spark_out;
    const auto depths = passDepths(process);
    ASSERT_EQ(depths.size(), row.expected.size());
    for (std::size_t i = 0; i < depths.size(); ++i) EXPECT_NEAR(depths[i], row.expected[i] * 1e-3, 1e-15);
  }
}

TEST(ValidJob, HasThePlaceDepthAndWearOfEveryPassInOrder) {
  GrindJob job = paperJob();
  job.tooth_angles = {0, 1, 3};
  job.process().depth = 1.5e-3;
  job.process().infeed = 1e-3;
  job.process().wheel_wear = 0.25e-3;
  job.process().wheel_wear_per_pass = 1e-6;
  const std::pair<GrindOrder, std::vector<ToothPass>> rows[]{
      {GrindOrder::kToothMajor, {{0, 0}, {0, 1}, {1, 0}, {1, 1}, {2, 0}, {2, 1}}},
      {GrindOrder::kPassMajor, {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {1, 1}, {2, 1}}}};
  for (const auto& [order, places] : rows) {
    SCOPED_TRACE(static_cast<int>(order));
    job.process().order = order;
    const ValidJob valid = ValidJob(job);
    ASSERT_EQ(valid.passes().size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const JobPass& pass = valid.passes()[i];
      EXPECT_TRUE(pass.place == places[i]) << i;
      EXPECT_EQ(pass.depth, places[i].pass == 0 ? 1e-3 : 1.5e-3);
      EXPECT_NEAR(pass.wear, 0.25e-3 + static_cast<double>(i) * 1e-6, 1e-18);
    }
  }
}

/// A face that grinds wears from 0 on, since its touch-off has taken up what it wore before.
TEST(ValidJob, OfAFaceHasTheWearSinceItBegan) {
  for (const char* operation : {"gash", "end_primary", "end_secondary", "chamfer"}) {
    SCOPED_TRACE(operation);
    GrindJob job = readJobFile("jobs/end_mill_d10_t4.yaml", operation);
    job.process().wheel_wear = 0.25e-3;
    job.process().wheel_wear_per_pass = 1e-6;
    const bool gash = job.process().kind == OperationKind::kGash;
    const ValidJob valid(job);
    for (const std::size_t i : {std::size_t{0}, valid.passes().size() - 1}) {
      const double worn = static_cast<double>(i) * 1e-6, wear = valid.passes()[i].wear;
      EXPECT_NEAR(wear, gash ? 0.25e-3 + worn : worn, 1e-15);
      const FaceWheel wheel = valid.faceWheel(wear);
      EXPECT_NEAR(wheel.radius, 50e-3 - 0.25e-3 - (gash ? worn : 0), 1e-15);
      EXPECT_NEAR(wheel.face_wear, gash ? 0 : worn, 1e-15);
    }
  }
}

/// What is said of an operation of a shipped job, e.g. "end_mill_d10_t4 gash", after a change; nothing of a good one.
std::string refusalOf(const std::string& operation, const std::function<void(GrindJob&)>& change) {
  static std::map<std::string, GrindJob> read;
  const auto [job, is_new] = read.try_emplace(operation);
  const std::size_t gap = operation.find(' ');
  if (is_new) job->second = readJobFile("jobs/" + operation.substr(0, gap) + ".yaml", operation.substr(gap + 1));
  GrindJob changed = job->second;
  change(changed);
  return text(validate(changed));
}

void evenly(GrindJob& job, int teeth) {
  job.tooth_angles.clear();
  for (int i = 0; i < teeth; ++i) job.tooth_angles.push_back(i * units::kTurn / teeth);
}

/// An operation that comes next to the flutes.
void alone(GrindJob& job) {
  job.operations = {job.operations[0], job.process()};
  job.operation = 1;
}

/// The flutes, before operations of which only the kinds count.
void before(GrindJob& job, std::initializer_list<OperationKind> kinds) {
  job.operations.resize(1);
  for (const OperationKind kind : kinds) job.operations.emplace_back().kind = kind;
}

TEST(GrindJob, HasTeethToTheCentreWhereOthersAreBesideThem) {
  const struct {
    int center;
    const char* is_short;  ///< each tooth
  } rows[]{{0, "0000"}, {1, "01"}, {1, "011"}, {1, "0111"}, {1, "01111"}, {2, "0101"}, {2, "011011"}};
  for (const auto& row : rows) {
    std::string is_short;
    EXPECT_EQ(refusalOf("center_cutting_d10_t4 gash",
                        [&](GrindJob& job) {
                          evenly(job, static_cast<int>(std::string(row.is_short).size()));
                          if (row.center == 0) job.cutter.end_short_from = job.process().gash_short_past = 0;
                          job.cutter.end_center_teeth = row.center;
                          for (int i = 0; i < static_cast<int>(job.tooth_angles.size()); ++i) {
                            is_short += job.isShort(i) ? '1' : '0';
                          }
                        }),
              "");
    EXPECT_EQ(is_short, row.is_short);
  }
}

TEST(GrindJob, AsksForWhatItsOperationsNeed) {
  using Cutter = CutterGeometry;
  const struct {
    const char* operation;
    double Cutter::*figure;
    const char *is_none, *needed;
  } rows[]{
      {"primary", &Cutter::clearance, "cutter.clearance_deg = 0 deg", "a relief"},
      {"primary", &Cutter::clearance_tolerance, "cutter.clearance_tolerance_deg = 0 deg", "a relief"},
      {"secondary", &Cutter::land, "cutter.land_mm = 0 mm", "a secondary relief"},
      {"secondary", &Cutter::second_clearance, "cutter.second_clearance_deg = 0 deg", "a secondary relief"},
      {"gash", &Cutter::end_rake_tolerance, "cutter.end.rake_tolerance_deg = 0 deg", "a gash"},
      {"end_primary", &Cutter::end_clearance, "cutter.end.clearance_deg = 0 deg", "end teeth"},
      {"end_secondary", &Cutter::end_clearance_tolerance, "cutter.end.clearance_tolerance_deg = 0 deg", "end teeth"},
      {"end_secondary", &Cutter::end_land, "cutter.end.land_mm = 0 mm", "secondary flanks of the end"},
      {"end_secondary", &Cutter::end_second_clearance, "cutter.end.second_clearance_deg = 0 deg",
       "secondary flanks of the end"},
      {"chamfer", &Cutter::chamfer_width, "cutter.chamfer.width_mm = 0 mm", "a chamfer"},
      {"chamfer", &Cutter::chamfer_angle, "cutter.chamfer.angle_deg = 0 deg", "a chamfer"},
      {"chamfer", &Cutter::chamfer_clearance, "cutter.chamfer.clearance_deg = 0 deg", "a chamfer"},
      {"chamfer", &Cutter::end_clearance_tolerance, "cutter.end.clearance_tolerance_deg = 0 deg", "a chamfer"},
  };
  for (const auto& row : rows) {
    const auto omit = [&](GrindJob& job) {
      if (isStraight(job.process().kind)) alone(job);
      job.cutter.*row.figure = 0;
    };
    EXPECT_EQ(refusalOf(std::string("end_mill_d10_t4 ") + row.operation, omit),
              std::string(row.is_none) + "; allowed: more than 0 with " + row.needed);
  }
}

TEST(GrindJob, OfAWholeMillNamesWhatItsOperationsNeed) {
  using Kind = OperationKind;
  const char* const of_two =
      "cutter.end.center_teeth = 2; allowed: 0, 1 of 2 or more teeth, or 2 of an even number of them from 4 on";
  const struct {
    const char* operation;  ///< as for refusalOf()
    std::function<void(GrindJob&)> change;
    const char* reason;
  } rows[]{
      {"center_cutting_d10_t4 gash", [](GrindJob& j) { evenly(j, 2); }, of_two},
      {"center_cutting_d10_t4 gash", [](GrindJob& j) { evenly(j, 5); }, of_two},
      {"center_cutting_d10_t4 gash", [](GrindJob& j) { evenly(j, 1), j.cutter.end_center_teeth = 1; },
       "cutter.end.center_teeth = 1; allowed: 0, 1 of 2 or more teeth, or 2 of an even number of them from 4 on"},
      {"center_cutting_d10_t4 gash", [](GrindJob& j) { j.cutter.end_center_teeth = 3; },
       "cutter.end.center_teeth = 3; allowed: 0 to 2"},
      {"center_cutting_d10_t4 gash", [](GrindJob& j) { j.cutter.end_short_from = 0.1e-3; },
       "cutter.end.short_from_mm = 0.1 mm; allowed: at least 0.2 mm"},
      {"center_cutting_d10_t4 gash", [](GrindJob& j) { j.cutter.end_short_from = 5e-3; },
       "cutter.end.short_from_mm = 5 mm; allowed: less than 5 mm, the cutter's radius at the end"},
      {"center_cutting_d10_t4 gash", [](GrindJob& j) { j.process().gash_short_past = -5e-3; },
       "process.short.past_mm = -5 mm; allowed: more than the cutter's radius at the end, -5 mm"},
      {"center_cutting_d10_t4 gash", [](GrindJob& j) { j.process().gash_short_angle = 4 * kDeg; },
       "process.short.angle_deg = 4 deg; allowed: 0, or from 5 deg"},
      {"center_cutting_d10_t4 gash", [](GrindJob& j) { j.process().gash_short_angle = 5 * kDeg; }, ""},
      {"center_cutting_d10_t4 gash", [](GrindJob& j) { j.cutter.end_center_teeth = 0; },
       "cutter.end.short_from_mm = 1.5 mm; allowed: 0 without cutter.end.center_teeth"},
      {"center_cutting_d10_t4 gash", [](GrindJob& j) { j.cutter.end_center_teeth = 0, j.cutter.end_short_from = 0; },
       "process.short.past_mm = -0.5 mm; allowed: 0 without cutter.end.center_teeth"},
      {"end_mill_d10_t4 gash", [](GrindJob& j) { j.process().gash_short_angle = 10 * kDeg; },
       "process.short.angle_deg = 10 deg; allowed: 0 without cutter.end.center_teeth"},
      // From the flutes on.
      {"center_cutting_d10_t4 flute", [](GrindJob& j) { evenly(j, 5); }, of_two},
      {"center_cutting_d10_t4 flute", [](GrindJob& j) { j.cutter.end_center_teeth = 0; },
       "cutter.end.short_from_mm = 1.5 mm; allowed: 0 without cutter.end.center_teeth"},
      {"end_mill_d10_t4 primary", [](GrindJob& j) { alone(j), j.cutter.land = j.cutter.second_clearance = 0; }, ""},
      {"end_mill_d10_t4 end_secondary", [](GrindJob& j) { j.cutter.end_second_clearance = j.cutter.end_clearance; },
       "cutter.end.second_clearance_deg = 8 deg; allowed: more than that of the primary flank, 8 deg"},
      {"end_mill_d10_t4 end_primary", [](GrindJob& j) { alone(j), j.cutter.end_second_clearance = 0; }, ""},
      {"end_mill_d10_t4 chamfer", [](GrindJob& j) { j.cutter.chamfer_width = 5e-3; },
       "cutter.chamfer.width_mm = 5 mm; allowed: less than 5 mm, the cutter's radius at the end"},
      {"end_mill_d10_t4 gash", [](GrindJob& j) { j.process().gash_past = -5e-3; },
       "process.past_mm = -5 mm; allowed: more than the cutter's radius at the end, -5 mm"},
      {"end_mill_d10_t4 flute", [](GrindJob& j) { j.process().gash_past = 1e-3; },
       "process.past_mm = 1 mm; allowed: 0 for this operation"},
      {"end_mill_d10_t4 gash", [](GrindJob& j) { j.process().roughing_passes = 1; },
       "process.roughing_passes = 1; allowed: 0 for this operation"},
      {"end_mill_d10_t4 gash", [](GrindJob& j) { j.process().removal = 8e-9; },
       "process.removal_mm3_s = 8 mm^3/s; allowed: 0 for this operation"},
      {"end_mill_d10_t4 gash", [](GrindJob& j) { j.process().infeed = 0; },
       "process.infeed_mm = 0 mm; allowed: 0.0001 to 50 mm"},
      // Which wheels can grind it.
      {"end_mill_d10_t4 primary", [](GrindJob& j) { wheel(j, WheelShape::kAngled); },
       "process.wheel.profile = 1; allowed: 0, straight, for a relief: its cylinder is what grinds it"},
      {"end_mill_d10_t4 primary", [](GrindJob& j) { wheel(j, WheelShape::kCup); },
       "process.wheel.profile = 3; allowed: 0, straight, for a relief: its cylinder is what grinds it"},
      {"end_mill_d10_t4 gash", [](GrindJob& j) { wheel(j, WheelShape::kCup); },
       "process.wheel.profile = 3; allowed: 0, straight, or 1, angled, for a gash"},
      {"end_mill_d10_t4 gash", [](GrindJob& j) { wheel(j, WheelShape::kStraight); }, ""},
      {"end_mill_d10_t4 gash", [](GrindJob& j) { j.process().wheel_side = WheelFace::kLower; },
       "process.wheel.side = 1; allowed: the upper face, which grinds the rake face of a right-hand gash"},
      {"left_hand_end_mill_d8_t3 gash", [](GrindJob& j) { j.process().wheel_side = WheelFace::kUpper; },
       "process.wheel.side = 0; allowed: the lower face, which grinds the rake face of a left-hand gash"},
      {"end_mill_d10_t4 chamfer", [](GrindJob& j) { wheel(j, WheelShape::kAngled); },
       "process.wheel.profile = 1; allowed: 0, straight, or 3, cup, for a flank of the end or a chamfer"},
      {"end_mill_d10_t4 chamfer", [](GrindJob& j) { wheel(j, WheelShape::kCup); }, ""},
      {"end_mill_d10_t4 chamfer",
       [](GrindJob& j) { wheel(j, WheelShape::kCup), j.process().wheel_side = WheelFace::kUpper; },
       "process.wheel.side = 0; allowed: the lower face, which grinds the flank"},
      {"end_mill_d10_t4 chamfer",
       [](GrindJob& j) {
         wheel(j, WheelShape::kCup), j.process().wheel_wear = 0.5e-3, j.process().wheel_rim = 49.5e-3;
       },
       "process.wheel.rim_mm = 49.5 mm; allowed: less than 49.5 mm, what is left of its radius"},
      {"end_mill_d10_t4 chamfer", [](GrindJob& j) { j.process().wheel_rim = 6e-3; },
       "process.wheel.rim_mm = 6 mm; allowed: 0 for this profile"},
      {"left_hand_end_mill_d8_t3 end_primary", [](GrindJob& j) { wheel(j, WheelShape::kStraight); },
       "process.wheel.profile = 0; allowed: 3, cup, for flanks of a left-hand end"},
      {"left_hand_end_mill_d8_t3 end_primary", [](GrindJob& j) { j.process().wheel_rim = 0; },
       "process.wheel.rim_mm = 0 mm; allowed: more than 0 for flanks of a left-hand end: its inner edge goes round the "
       "next tooth"},
      {"left_hand_end_mill_d8_t3 end_primary", [](GrindJob& j) { j.process().wheel_rim = 46e-3; },
       "process.wheel.rim_mm = 46 mm; allowed: less than 46 mm, what leaves a recess as wide as the cutter"},
      // Which operations there are, and in which order.
      {"end_mill_d10_t4 gash", [](GrindJob& j) { j.operations = {j.process()}, j.operation = 0; },
       "process.kind = 3; allowed: 0 to 0"},
      {"end_mill_d10_t4 flute",
       [](GrindJob& j) {
         before(j, {Kind::kGash, Kind::kPrimaryRelief});
       },
       "process.kind = 1; allowed: more than the kind of the operation before it, each kind once"},
      {"end_mill_d10_t4 flute",
       [](GrindJob& j) {
         before(j, {Kind::kGash, Kind::kGash});
       },
       "process.kind = 3; allowed: 4 to 6"},
      {"end_mill_d10_t4 flute", [](GrindJob& j) { j.operations.resize(8); }, "operations = 8; allowed: 1 to 7"},
      {"end_mill_d10_t4 flute", [](GrindJob& j) { j.operation = 7; }, "operation = 7; allowed: 0 to 6"},
  };
  for (const auto& row : rows) EXPECT_EQ(refusalOf(row.operation, row.change), row.reason) << row.operation;
}

/// What is said of a job where it is made a valid one; its digest where it is.
std::string refusal(const GrindJob& job) {
  try {
    return ValidJob(job).digest();
  } catch (const InvalidJob& refused) {
    return text(refused.reasons());
  }
}

TEST(ValidJob, RefusesMorePassesThanTheWheelLasts) {
  GrindJob flute = paperJob();
  wearPerPass(flute, 0.125e-3 * (1 + 1e-6));
  EXPECT_EQ(refusal(flute),
            "process.wheel.wear_per_pass_mm = 0.125000125 mm; allowed: less than 0.125 mm, what is left of the wheel's "
            "radius, over the passes of all teeth");
  GrindJob end = readJobFile("jobs/end_mill_d10_t4.yaml", "chamfer");  // 6 mm wide
  end.process().wheel_corner_radius_lower = 0.4e-3;
  const std::size_t passes = ValidJob(end).passes().size();
  ASSERT_EQ(passes % 4, 0u);
  end.process().wheel_wear_per_pass = 5.6e-3 / static_cast<double>(passes) * (1 - 1e-9);
  EXPECT_EQ(refusal(end), ValidJob(end).digest());
  end.process().wheel_wear_per_pass *= 1 + 1e-6;
  const std::string why = refusal(end);
  EXPECT_NE(why.find(", the wheel's width between its corners, over the passes of all teeth"), std::string::npos)
      << why;
  end.process().wheel_wear_per_pass = std::nan("");
  EXPECT_THROW(ValidJob{end}, InvalidJob);
  // Without wear, a wheel lasts that is nothing but corners.
  end.process().wheel_wear_per_pass = 0;
  end.process().wheel_corner_radius_lower = end.process().wheel_corner_radius_upper = end.process().wheel_width / 2;
  EXPECT_EQ(refusal(end), jobDigest(end));
}

TEST(ValidJob, CountsThePassesOfAnOperationAfterTheFlutes) {
  GrindJob gash = readJobFile("jobs/end_mill_d10_t4.yaml", "gash");
  // 4 times 4950 roughing passes are 19,800.
  gash.process().infeed = ValidJob(gash).deepest() / 4950;
  gash.process().spark_out = 0;
  EXPECT_EQ(refusal(gash), jobDigest(gash));
  gash.process().spark_out = 100;
  EXPECT_EQ(refusal(gash),
            "process.infeed_mm is too small for a gash as deep as this: more than 20000 passes of all teeth");
}

TEST(ValidJob, RefusesAReliefThatBeginsBeyondTheApex) {
  GrindJob relief = readJobFile("jobs/end_mill_d10_t4.yaml", "primary");
  relief.cutter.cone_angle = 30 * kDeg;
  relief.cutter.end_diameter = 1e-3;
  relief.process().setup_height = -40e-3;
  EXPECT_EQ(refusal(relief), "the stroke of the relief goes beyond where the cone closes");
}

/// All reliefs have the travel that the widest of them needs, with a millimetre at either end to reach the feed.
TEST(ValidJob, OfAReliefHasTheTravelOfAllItsTeeth) {
  const ValidJob flutes(readJobFile("jobs/end_mill_d10_t4.yaml", "flute"));
  GrindJob job = readJobFile("jobs/end_mill_d10_t4.yaml", "primary");
  job.process().direction = StrokeDirection::kFromEnd;
  for (const double first : {34.9 * kDeg, 35.1 * kDeg}) {
    std::vector<EdgeHelix> edges(4, EdgeHelix{35 * kDeg});
    edges[0].spiral_angle = first;
    const ValidJob valid = ValidJob(job).withEdges(flutes, edges);
    double from = kInf, to = -kInf;
    for (int tooth = 0; tooth < 4; ++tooth) {
      const ReliefPath& path = *valid.relief(tooth);
      from = std::min(from, path.xShift() - path.beyondEnd() - 1e-3);
      to = std::max(to, path.xShift() + 22e-3 + path.beyondShank() + 1e-3);
    }
    EXPECT_NE(valid.relief(0)->xShift(), valid.relief(1)->xShift());
    for (int tooth = 0; tooth < 4; ++tooth) {
      EXPECT_NEAR(valid.strokeLaw(tooth).from, from, 1e-15) << tooth;
      EXPECT_NEAR(valid.strokeLaw(tooth).to, to, 1e-15) << tooth;
    }
  }
}

TEST(GrindJob, OfAnOperationThatIsNotThereIsNone) {
  EXPECT_NO_THROW(paperJob().ofOperation(0));
  EXPECT_THROW(paperJob().ofOperation(1), std::out_of_range);
}

TEST(EndTooth, LeavesAsMuchOfTheNextOneAsThatHasOfAnEdge) {
  const GrindJob job = readJobFile("jobs/center_cutting_d10_t4.yaml", "gash");
  for (int tooth = 0; tooth < 4; ++tooth) {
    EXPECT_EQ(endToothOf(job, tooth).next_from, tooth % 2 == 0 ? job.cutter.end_short_from : 0) << tooth;
  }
}

// Of a wheel with nothing but 0, it is that of an empty text, which is well known.
TEST(Digest, IsOfWhatIsNotZero) {
  EXPECT_EQ(wheelDigest(GrindJob{}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

/// Zero points hold for another job that places its teeth alike.
TEST(Digest, OfATaughtToolIsOfWhatPlacesItsTeeth) {
  GrindJob job = paperJob(), other = job;
  other.cutter.core_tolerance *= 2, other.cutter.clearance = 0.1, other.process().feed *= 2;
  EXPECT_EQ(toolDigest(other), toolDigest(job));
  other.process().z_law = job.process().z_law == ZLaw::kPublished ? ZLaw::kConstantRake : ZLaw::kPublished;
  EXPECT_NE(toolDigest(other), toolDigest(job));
}

TEST(ValidJob, FinishesAllTeethAfterTheRoughingOfAll) {
  GrindJob job = paperJob();
  job.tooth_angles = {0, 1};
  job.process().depth = 1.5e-3;
  job.process().infeed = 1e-3;
  job.process().spark_out = 1;
  job.process().wheel_wear_per_pass = 1e-6;
  job.process().order = GrindOrder::kFinishTogether;
  // The finishing passes are two apart, and not four.
  const struct {
    double finish_infeed;  ///< [m]
    std::vector<ToothPass> places;
    double wear_of_teeth[2];
  } rows[]{{0.1e-3, {{0, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}}, {4e-6, 6e-6}},
           {0, {{0, 0}, {0, 1}, {1, 0}, {1, 1}, {0, 2}, {1, 2}}, {1e-6, 3e-6}}};
  for (const auto& row : rows) {
    job.process().finish_infeed = row.finish_infeed;
    const ValidJob valid(job);
    ASSERT_EQ(valid.passes().size(), row.places.size());
    for (std::size_t i = 0; i < row.places.size(); ++i) EXPECT_TRUE(valid.passes()[i].place == row.places[i]) << i;
    for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(valid.wearOfTeeth()[i], row.wear_of_teeth[i], 1e-18);
  }
}

TEST(ValidJob, ByRemovalHasNoPassesBeforeTheyAreMeasured) {
  GrindJob job = paperJob();
  job.process().infeed = 0;
  job.process().finish_infeed = 0.1e-3;
  job.process().spark_out = 1;
  job.process().roughing_passes = 2;
  const ValidJob asked(job);
  EXPECT_FALSE(asked.hasPasses());
  EXPECT_THROW(asked.depths(), std::invalid_argument);
  EXPECT_THROW(asked.passes(), std::invalid_argument);
  const ValidJob roughed = asked.withRoughing({0.3e-3, 0.4e-3});
  EXPECT_EQ(roughed.depths(), (std::vector<double>{0.3e-3, 0.4e-3, 0.5e-3, 0.5e-3}));
  EXPECT_EQ(roughed.passes().size(), 4 * job.tooth_angles.size());
  EXPECT_EQ(roughed.digest(), asked.digest());
  job.process().roughing_passes = 3;
  EXPECT_NE(ValidJob(job).digest(), asked.digest());
  job.process().wheel_wear_per_pass = 0.99e-3;
  job.process().wheel_diameter = 100e-3;
  EXPECT_THROW(ValidJob(job).withRoughing(std::vector<double>(49, 0.4e-3)), InvalidJob);
}

TEST(ShankCut, IsByHowMuchTheShankStandsOut) {
  CutterGeometry cutter{10e-3, 5 * units::kDegree, 0.5, 0, 30e-3};
  cutter.shank_diameter = 16e-3;
  EXPECT_NEAR(shankCut(cutter), 8e-3 - 5e-3 - 30e-3 * std::tan(5 * units::kDegree), 1e-15);
  cutter.shank_diameter = 15e-3;
  EXPECT_EQ(shankCut(cutter), 0);
  cutter.shank_diameter = 16e-3;
  cutter.neck_length = 1e-3;
  EXPECT_EQ(shankCut(cutter), 0);
}

TEST(AskedDepth, IsThatOfTheCore) {
  GrindJob job = paperJob();
  job.cutter.cone_angle = 0;
  job.cutter.end_diameter = 6e-3;
  job.cutter.flute_length = 20e-3;
  job.cutter.core_diameter = 3.9e-3;
  job.cutter.core_diameter_end = 2.9e-3;
  EXPECT_DOUBLE_EQ(askedDepth(job, 0), 1.05e-3);
  EXPECT_DOUBLE_EQ(askedDepth(job, 10e-3), 1.3e-3);
  EXPECT_DOUBLE_EQ(askedDepth(job, 20e-3), 1.55e-3);
}

}  // namespace test_grind_job
}  // namespace grinder
