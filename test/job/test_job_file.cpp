#include "flute_grinder/job/job_file.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/grind_job.h"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace grinder {
namespace test_job_file {

constexpr double kPi = 3.141592653589793238462643383279502884;

// Line numbers in the rows below are those of this text.
const char* const kGood =
    "cutter:\n"                                      // 1
    "  end_diameter_mm: 6\n"                         // 2
    "  cone_angle_deg: -1\n"                         // 3
    "  spiral_angle_deg: -45\n"                      // 4
    "  rake_angle_deg: 12\n"                         // 5
    "  flute_length_mm: 25\n"                        // 6
    "  teeth: 4\n"                                   // 7
    "  cut: left_hand\n"                             // 8
    "  rake_tolerance_deg: 0.25\n"                   // 9
    "  chordal_rake_tolerance_deg: 5\n"              // 10
    "  spiral_tolerance_deg: 0.5\n"                  // 11
    "  core_diameter_mm: 3.5\n"                      // 12
    "  core_diameter_end_mm: 3\n"                    // 13
    "  core_tolerance_mm: 0.05\n"                    // 14
    "  shank_diameter_mm: 10\n"                      // 15
    "process:\n"                                     // 16
    "  feed_mm_min: 200\n"                           // 17
    "  depth_mm: 1.5\n"                              // 18
    "  infeed_mm: 0.5\n"                             // 19
    "  finish_infeed_mm: 0.05\n"                     // 20
    "  spark_out: 1\n"                               // 21
    "  clearance_mm: 5\n"                            // 22
    "  overtravel_mm: [1, 2]\n"                      // 23
    "  order: pass_major\n"                          // 24
    "  direction: to_end\n"                          // 25
    "  wheel:\n"                                     // 26
    "    diameter_mm: 100\n"                         // 27
    "    width_mm: 8\n"                              // 28
    "    wear_mm: 0.3\n"                             // 29
    "    profile: angled\n"                          // 30
    "    angle_deg: 20\n"                            // 31
    "    side: lower\n"                              // 32
    "    corner_radius_mm: [0.1, 0.2]\n"             // 33
    "  setup: {swivel_deg: -46, height_mm: 1.25}\n"  // 34
    "interpolation:\n"                               // 35
    "  even_step: third_order\n"                     // 36
    "  tolerance_um: 2\n"                            // 37
    "  rotary_scale_mm_per_rad: 1.5\n";              // 38

/// The good text with one piece of it replaced.
std::string with(const std::string& piece, const std::string& replacement) {
  std::string text = kGood;
  const auto at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  return text.replace(at, piece.size(), replacement);
}

/// What is wrong with a text; empty where nothing is.
std::string errorOf(const std::string& text) {
  try {
    parseJob(text, "job.yaml");
  } catch (const JobFileError& error) {
    return error.what();
  }
  return "";
}

std::ptrdiff_t linesOf(const std::string& text) {
  return text.empty() ? 0 : 1 + std::count(text.begin(), text.end(), '\n');
}

/// @return whether a line of `text` has all parts of `wanted`, in their order: "job.yaml:3 ... cutter.teeth ... 1 to
/// 64".
bool hasLine(const std::string& text, const std::string& wanted) {
  const std::string gap = " ... ";
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::size_t at = 0;
    for (std::size_t from = 0; from < wanted.size() && at != std::string::npos;) {
      const std::size_t to = std::min(wanted.find(gap, from), wanted.size());
      at = line.find(wanted.substr(from, to - from), at);
      from = to + gap.size();
    }
    if (at != std::string::npos) return true;
  }
  return false;
}

TEST(JobFile, TurnsEveryFigureIntoSi) {
  const GrindJob job = parseJob(kGood, "job.yaml");
  EXPECT_DOUBLE_EQ(job.cutter.end_diameter, 0.006);
  EXPECT_DOUBLE_EQ(job.cutter.cone_angle, -kPi / 180);
  EXPECT_DOUBLE_EQ(job.cutter.spiral_angle, -kPi / 4);
  EXPECT_DOUBLE_EQ(job.cutter.rake_angle, kPi / 15);
  EXPECT_DOUBLE_EQ(job.cutter.flute_length, 0.025);
  EXPECT_DOUBLE_EQ(job.process.feed, 0.2 / 60);
  EXPECT_DOUBLE_EQ(job.process.depth, 0.0015);
  EXPECT_DOUBLE_EQ(job.process.infeed, 0.0005);
  EXPECT_DOUBLE_EQ(job.process.finish_infeed, 0.00005);
  EXPECT_EQ(job.process.spark_out, 1);
  EXPECT_DOUBLE_EQ(job.process.clearance, 0.005);
  EXPECT_DOUBLE_EQ(job.process.overtravel_end, 0.001);
  EXPECT_DOUBLE_EQ(job.process.overtravel_shank, 0.002);
  EXPECT_EQ(job.process.order, GrindOrder::kPassMajor);
  EXPECT_EQ(job.process.direction, StrokeDirection::kToEnd);
  EXPECT_DOUBLE_EQ(job.process.wheel_diameter, 0.1);
  EXPECT_DOUBLE_EQ(job.process.wheel_width, 0.008);
  EXPECT_DOUBLE_EQ(job.process.wheel_wear, 0.0003);
  EXPECT_EQ(job.cutter.cut, CutDirection::kLeftHand);
  EXPECT_DOUBLE_EQ(job.cutter.rake_tolerance, kPi / 720);
  EXPECT_DOUBLE_EQ(job.cutter.shank_diameter, 0.01);
  EXPECT_EQ(job.process.wheel_profile, WheelShape::kAngled);
  EXPECT_DOUBLE_EQ(job.process.wheel_angle, kPi / 9);
  EXPECT_EQ(job.process.wheel_side, WheelFace::kLower);
  EXPECT_DOUBLE_EQ(job.process.wheel_corner_radius_lower, 0.0001);
  EXPECT_DOUBLE_EQ(job.process.wheel_corner_radius_upper, 0.0002);
  EXPECT_DOUBLE_EQ(job.process.setup_swivel, -46 * kPi / 180);
  EXPECT_DOUBLE_EQ(job.process.setup_height, 0.00125);
  EXPECT_EQ(job.interpolation.even_step, EvenStepRule::kThirdOrder);
  EXPECT_DOUBLE_EQ(job.interpolation.tolerance, 2e-6);
  EXPECT_DOUBLE_EQ(job.interpolation.rotary_scale, 0.0015);
}

TEST(JobFile, ReadsWhatMayBeLeftOut) {
  const GrindJob plain = parseJob(kGood, "job.yaml");
  EXPECT_EQ(plain.process.depth_end, 0);
  EXPECT_EQ(plain.process.depthEnd(), plain.process.depth);
  EXPECT_FALSE(plain.process.incomplete_ok);
  EXPECT_TRUE(plain.spiral_angles.empty());
  EXPECT_EQ(parseJob(with("    corner_radius_mm: [0.1, 0.2]\n", ""), "f").process.wheel_corner_radius_upper, 0);
  EXPECT_DOUBLE_EQ(
      parseJob(with("  depth_mm: 1.5\n", "  depth_mm: 1.5\n  depth_end_mm: 1.75\n"), "f").process.depthEnd(), 0.00175);
  EXPECT_TRUE(parseJob(with("  order:", "  incomplete_ok: true\n  order:"), "f").process.incomplete_ok);
}

const std::vector<std::string> kUnsolved{"process.setup_swivel", "process.setup_height", "process.depth"};

TEST(JobFile, LeavesOutTheSetUpThatIsYetToBeFound) {
  const std::string setup = "  setup: {swivel_deg: -46, height_mm: 1.25}\n";
  GrindJob job = parseJob(with(setup, ""), "job.yaml", kUnsolved);
  EXPECT_EQ(job.process.setup_swivel, 0);
  EXPECT_EQ(job.process.setup_height, 0);
  EXPECT_DOUBLE_EQ(job.process.depth, 0.0015);
  job = parseJob(with(", height_mm: 1.25", ""), "job.yaml", kUnsolved);
  EXPECT_DOUBLE_EQ(job.process.setup_swivel, -46 * kPi / 180);
  EXPECT_THROW(parseJob(with(", height_mm: 1.25", ""), "job.yaml", {"process.setup_swivel"}), JobFileError);
}

TEST(JobFile, LeavesOutADepthThatIsToBeFound) {
  const std::string text = with("  depth_mm: 1.5\n", "");
  EXPECT_DOUBLE_EQ(parseJob(text, "job.yaml", kUnsolved).process.depth, 0.00125);
  EXPECT_THROW(parseJob(text, "job.yaml"), JobFileError);
}

TEST(JobFile, NamesTheKeyThatIsNearestToAnUnknownOne) {
  EXPECT_NE(errorOf(with("  depth_mm: 1.5\n", "  detph_mm: 1.5\n"))
                .find("process.detph_mm is not a key of a job file; did you mean 'process.depth_mm'?"),
            std::string::npos);
  EXPECT_NE(errorOf(with("  depth_mm: 1.5\n", "  depth_mm: 1.5\n  colour: red\n"))
                .find("process.colour is not a key of a job file; allowed: process."),
            std::string::npos);
}

TEST(JobFile, ReadsASpiralAnglePerTooth) {
  const GrindJob job = parseJob(with("spiral_angle_deg: -45", "spiral_angles_deg: [-45, -44, -43, -42]"), "job.yaml");
  EXPECT_DOUBLE_EQ(job.cutter.spiral_angle, -kPi / 4);
  ASSERT_EQ(job.spiral_angles.size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(ValidJob(job).cutterOf(i).spiral_angle, (i - 45) * kPi / 180);
}

TEST(JobFile, ReadsAWheelOfPoints) {
  const GrindJob job = parseJob(with("    profile: angled\n    angle_deg: 20\n    side: lower\n",
                                     "    profile: points\n    points_mm: [[-4, 49], [0, 50], [4, 48.5]]\n"),
                                "job.yaml");
  ASSERT_EQ(job.wheel_points.size(), 3u);
  EXPECT_DOUBLE_EQ(job.wheel_points[0].w, -0.004);
  EXPECT_DOUBLE_EQ(job.wheel_points[2].radius, 0.0485);
}

TEST(JobFile, SpacesEveryAllowedCountOfTeethEvenly) {
  for (int teeth = 1; teeth <= kMaxTeeth; ++teeth) {
    const GrindJob job = parseJob(with("teeth: 4", "teeth: " + std::to_string(teeth)), "job.yaml");
    ASSERT_EQ(job.tooth_angles.size(), static_cast<std::size_t>(teeth));
    for (int i = 0; i < teeth; ++i)
      EXPECT_NEAR(job.tooth_angles[static_cast<std::size_t>(i)], 2 * kPi * i / teeth, 1e-14);
  }
}

TEST(JobFile, ReadsUnequalTeeth) {
  const GrindJob job = parseJob(with("teeth: 4", "tooth_angles_deg: [0, 88, 180, 268]"), "job.yaml");
  const std::vector<double> degrees{0, 88, 180, 268};
  ASSERT_EQ(job.tooth_angles.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(job.tooth_angles[i], degrees[i] * kPi / 180);
}

TEST(JobFile, ReadsTheWearPerPassWhereItIsGiven) {
  EXPECT_EQ(parseJob(kGood, "job.yaml").process.wheel_wear_per_pass, 0);
  const GrindJob job = parseJob(with("wear_mm: 0.3\n", "wear_mm: 0.3\n    wear_per_pass_mm: 0.004\n"), "job.yaml");
  EXPECT_DOUBLE_EQ(job.process.wheel_wear_per_pass, 4e-6);
  EXPECT_DOUBLE_EQ(job.process.wheel_wear, 0.0003);
}

TEST(JobFile, ReadsEveryChoice) {
  EXPECT_EQ(parseJob(with("pass_major", "tooth_major"), "f").process.order, GrindOrder::kToothMajor);
  EXPECT_EQ(parseJob(with("to_end", "from_end"), "f").process.direction, StrokeDirection::kFromEnd);
  EXPECT_EQ(parseJob(with("third_order", "published"), "f").interpolation.even_step, EvenStepRule::kPublished);
  EXPECT_EQ(parseJob(with("third_order", "exact"), "f").interpolation.even_step, EvenStepRule::kExact);
}

/// A mistake in a job file and what its one message must have.
struct Mistake {
  const char* name;
  const char* piece;
  const char* replacement;
  const char* message;  ///< as for hasLine()
};

std::ostream& operator<<(std::ostream& out, const Mistake& mistake) { return out << mistake.name; }

class JobFileMistake : public ::testing::TestWithParam<Mistake> {};

TEST_P(JobFileMistake, IsReportedOnceWithFileLineKeyAndWhatIsAllowed) {
  const Mistake& mistake = GetParam();
  const std::string error = errorOf(with(mistake.piece, mistake.replacement));
  EXPECT_TRUE(hasLine(error, mistake.message)) << "got: " << error;
  EXPECT_EQ(linesOf(error), 1) << error;
}

INSTANTIATE_TEST_SUITE_P(
    All, JobFileMistake,
    ::testing::Values(
        Mistake{"UnknownKey", "  teeth: 4\n", "  teeth: 4\n  colour: red\n", "job.yaml:8 ... cutter.colour"},
        Mistake{"UnknownSection", "interpolation:", "paint: 3\ninterpolation:", "job.yaml:35 ... paint"},
        Mistake{"UnknownEmptyMap", "  teeth: 4\n", "  teeth: 4\n  colour: {}\n", "job.yaml:8 ... cutter.colour"},
        Mistake{"UnknownEmptyList", "  teeth: 4\n", "  teeth: 4\n  colour: []\n", "job.yaml:8 ... cutter.colour"},
        Mistake{"UnknownEmptyValue", "  teeth: 4\n", "  teeth: 4\n  colour:\n", "job.yaml:8 ... cutter.colour"},
        Mistake{"ThirdOvertravel", "[1, 2]", "[1, 2, 3]", "job.yaml:23 ... process.overtravel_mm[2]"},
        Mistake{"MissingKey", "  depth_mm: 1.5\n", "", "job.yaml ... process.depth_mm ... missing ... 0.001 to 50 mm"},
        Mistake{"DuplicateKey", "  depth_mm: 1.5\n", "  depth_mm: 1.5\n  depth_mm: 1.6\n",
                "job.yaml:19 ... process.depth_mm ... appears twice"},
        Mistake{"DuplicateKeySameValue", "  depth_mm: 1.5\n", "  depth_mm: 1.5\n  depth_mm: 1.5\n",
                "job.yaml:19 ... process.depth_mm ... appears twice"},
        Mistake{"NoValue", "feed_mm_min: 200",
                "feed_mm_min:", "job.yaml:17 ... process.feed_mm_min ... (nothing) ... 0.1 to 10000 mm/min"},
        Mistake{"BrokenTeeth", "teeth: 4", "teeth: 4.5",
                "job.yaml:7 ... cutter.teeth = 4.5 is not a whole number; allowed: 1 to 64"},
        Mistake{"DecimalComma", "spiral_angle_deg: -45", "spiral_angle_deg: 30,5",
                "job.yaml:4 ... cutter.spiral_angle_deg = 30,5 is not a number; allowed: -60 to 60 deg"},
        Mistake{"OctalTeeth", "teeth: 4", "teeth: 010", "job.yaml:7 ... cutter.teeth = 010 ... octal ... 1 to 64"},
        Mistake{"OctalZeroTeeth", "teeth: 4", "teeth: +04", "job.yaml:7 ... cutter.teeth = +04 ... octal ... 1 to 64"},
        Mistake{"OctalTeethOfYaml12", "teeth: 4", "teeth: 0o10", "job.yaml:7 ... cutter.teeth = 0o10 ... octal"},
        Mistake{"HexadecimalTeeth", "teeth: 4", "teeth: 0x10", "job.yaml:7 ... cutter.teeth = 0x10 ... hexadecimal"},
        Mistake{"TooManyTeethToCount", "teeth: 4", "teeth: 99999999999",
                "job.yaml:7 ... cutter.teeth = 99999999999 is out of range ... 1 to 64"},
        Mistake{"HexadecimalFigure", "depth_mm: 1.5", "depth_mm: 0x1",
                "job.yaml:18 ... process.depth_mm = 0x1 ... 0.001 to 50 mm"},
        Mistake{"SecondDocument", "interpolation:", "---\ninterpolation:",
                "job.yaml:35 ... a second document begins here ... allowed: one"},
        Mistake{"EmptySecondDocument", "rotary_scale_mm_per_rad: 1.5\n", "rotary_scale_mm_per_rad: 1.5\n---\n",
                "job.yaml:39 ... a second document begins here"},
        Mistake{"Anchor", "depth_mm: 1.5", "depth_mm: &deep 1.5", "job.yaml:18 ... anchor ... allowed: none"},
        Mistake{"AnchorOfASection", "cutter:", "cutter: &cutter", "job.yaml: ... anchor ... allowed: none"},
        Mistake{"Alias", "depth_mm: 1.5", "depth_mm: *deep", "job.yaml:18 ... anchor"},
        Mistake{"TwoLinesInAValue", "pass_major", "\"pass\\nmajor\"", "job.yaml:24 ... process.order = pass?major"},
        Mistake{"NotANumber", "depth_mm: 1.5", "depth_mm: .nan",
                "job.yaml:18 ... process.depth_mm ... nan ... 0.001 to 50 mm"},
        Mistake{"TooLargeForANumber", "depth_mm: 1.5", "depth_mm: 1e999",
                "job.yaml:18 ... process.depth_mm ... 0.001 to 50 mm"},
        Mistake{"TwoWaysOfTeeth", "  teeth: 4\n", "  teeth: 4\n  tooth_angles_deg: [0, 90]\n",
                "job.yaml:7 ... cutter.teeth ... cutter.tooth_angles_deg ... one of the two"},
        Mistake{"EmptyTeethBesideTeeth", "  teeth: 4\n", "  teeth: 4\n  tooth_angles_deg: []\n",
                "job.yaml: ... cutter.t"},
        Mistake{"ToothOfAWord", "teeth: 4", "tooth_angles_deg: [0, half]",
                "job.yaml:7 ... cutter.tooth_angles_deg[1] ... half ... ascending"},
        Mistake{"SideOfAStraightWheel", "    profile: angled\n    angle_deg: 20\n", "    profile: straight\n",
                "job.yaml:31 ... process.wheel.side ... not a key"},
        Mistake{"AngleOfAStraightWheel", "    profile: angled\n    angle_deg: 20\n    side: lower\n",
                "    profile: straight\n    angle_deg: 20\n",
                "job.yaml:31 ... process.wheel.angle_deg ... 20 deg ... 0 for this profile"},
        Mistake{"AngledWithoutAnAngle", "    angle_deg: 20\n", "",
                "job.yaml ... process.wheel.angle_deg ... 0 deg ... more than 0 for this profile"},
        Mistake{"CornersWiderThanTheWheel", "[0.1, 0.2]", "[4, 4.5]",
                "job.yaml:33 ... process.wheel.corner_radius_mm[0] ... 8.5 mm ... wheel's width ... 8 mm"},
        Mistake{"CornerOfARoundedWheel", "    profile: angled\n    angle_deg: 20\n    side: lower\n",
                "    profile: full_radius\n",
                "job.yaml:31 ... process.wheel.corner_radius_mm[0] ... 0.3 mm ... allowed: 0 for this profile"},
        Mistake{"OneCorner", "[0.1, 0.2]", "[0.1]", "job.yaml ... process.wheel.corner_radius_mm[1] ... missing"},
        Mistake{"PointsWithoutPoints", "    profile: angled\n    angle_deg: 20\n    side: lower\n",
                "    profile: points\n", "job.yaml ... process.wheel.points_mm ... [w, radius]"},
        Mistake{"PointsOfAnotherWidth", "    profile: angled\n    angle_deg: 20\n    side: lower\n",
                "    profile: points\n    points_mm: [[-3, 50], [3, 49]]\n",
                "job.yaml:28 ... process.wheel.width_mm ... 8 mm ... its points ... 6 mm"},
        Mistake{"PointsNotAscending", "    profile: angled\n    angle_deg: 20\n    side: lower\n",
                "    profile: points\n    points_mm: [[-4, 50], [-4, 49], [4, 50]]\n",
                "job.yaml:31 ... process.wheel.points_mm ... -4 mm ... ascending"},
        Mistake{"HalfAPoint", "    profile: angled\n    angle_deg: 20\n    side: lower\n",
                "    profile: points\n    points_mm: [[-4, 50], [4]]\n",
                "job.yaml:31 ... process.wheel.points_mm[1] ... not a pair"},
        Mistake{"TwoWaysOfSpirals", "  spiral_angle_deg: -45\n",
                "  spiral_angle_deg: -45\n  spiral_angles_deg: [-45, -44, -45, -44]\n",
                "job.yaml:4 ... cutter.spiral_angle_deg ... cutter.spiral_angles_deg ... one of the two"},
        Mistake{"SpiralsOfSomeTeeth", "spiral_angle_deg: -45", "spiral_angles_deg: [-45, -44]",
                "job.yaml:4 ... cutter.spiral_angles_deg ... 2 ... as many as teeth, 4"},
        Mistake{"SpiralOutOfRange", "spiral_angle_deg: -45", "spiral_angles_deg: [-45, -44, -61, -44]",
                "job.yaml:4 ... cutter.spiral_angles_deg ... -61 deg ... -60 to 60 deg"},
        Mistake{"DeeperThanTheCutter", "depth_mm: 1.5", "depth_mm: 2.8",
                "job.yaml:18 ... process.depth_mm ... 2.8 mm ... less than 2.56 ... radius at the flute's end"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(JobFile, ReportsAllOfSeveralErrors) {
  std::string text = with("depth_mm: 1.5", "depth_mm: deep");
  text.replace(text.find("pass_major"), 10, "any");
  text += "extra: 1\n";
  const std::string error = errorOf(text);
  EXPECT_EQ(linesOf(error), 3) << error;
  EXPECT_TRUE(hasLine(error, "job.yaml:18 ... process.depth_mm ... deep"));
  EXPECT_TRUE(hasLine(error, "job.yaml:24 ... process.order ... any"));
  EXPECT_TRUE(hasLine(error, "job.yaml:39 ... extra"));
}

TEST(JobFile, ReportsAllFiguresOutOfRange) {
  std::string text = with("depth_mm: 1.5", "depth_mm: 51");
  text.replace(text.find("feed_mm_min: 200"), 16, "feed_mm_min: 0");
  const std::string error = errorOf(text);
  EXPECT_EQ(linesOf(error), 2) << error;
  EXPECT_TRUE(hasLine(error, "job.yaml:18 ... process.depth_mm ... 51 mm"));
  EXPECT_TRUE(hasLine(error, "job.yaml:17 ... process.feed_mm_min ... 0 mm/min"));
}

TEST(JobFile, RefusesASectionThatStandsTwice) {
  const std::string error = errorOf(with("  clearance_mm: 5\n", "process:\n  clearance_mm: 5\n"));
  EXPECT_TRUE(hasLine(error, "job.yaml:22 ... process")) << "got: " << error;
}

TEST(JobFile, RefusesAPathAsAKey) {
  const std::string error = errorOf(with("process:\n  feed_mm_min: 200\n", "process.feed_mm_min: 200\nprocess:\n"));
  EXPECT_TRUE(hasLine(error, "job.yaml ... process.feed_mm_min")) << "got: " << error;
}

TEST(JobFile, RefusesWhatIsNotAMap) {
  for (const char* text : {"3", "[1, 2]", "just words", "", "# a comment only\n", "~"}) {
    SCOPED_TRACE(text);
    EXPECT_TRUE(hasLine(errorOf(text), "job.yaml:1 ... not a map"));
  }
}

TEST(JobFile, RefusesASectionThatIsNotAMap) {
  const std::string text =
      std::string(kGood).substr(0, std::string(kGood).find("interpolation:")) + "interpolation: exact\n";
  const std::string error = errorOf(text);
  EXPECT_TRUE(hasLine(error, "job.yaml:35 ... interpolation")) << error;
  EXPECT_TRUE(hasLine(error, "interpolation.tolerance_um ... missing")) << error;
}

TEST(JobFile, ReportsWhereYamlIsBroken) {
  EXPECT_TRUE(hasLine(errorOf(with("teeth: 4", "teeth: [4")), "job.yaml:"));
  EXPECT_TRUE(hasLine(errorOf("cutter:\n  teeth: 4\n bad: : :\n"), "job.yaml:3"));
}

TEST(JobFile, RefusesAKeyThatIsNotAWord) {
  const std::string error = errorOf(std::string(kGood) + "? [1, 2]\n: 3\n");
  EXPECT_EQ(error.find("job.yaml:39"), 0u) << error;
}

TEST(JobFile, ReadsACarriageReturnAndAByteOrderMark) {
  std::string text = "\xEF\xBB\xBF";
  for (const char* c = kGood; *c != 0; ++c) text += *c == '\n' ? std::string("\r\n") : std::string(1, *c);
  EXPECT_EQ(errorOf(text), "");
}

/// A message of reading a file; empty where it was read.
std::string fileErrorOf(const std::string& path) {
  try {
    readJobFile(path);
  } catch (const JobFileError& error) {
    return error.what();
  }
  return "";
}

/// A file of this test, removed at its end.
class JobFileOnDisk : public ::testing::Test {
 protected:
  void SetUp() override { std::ofstream(path_) << kGood; }
  void TearDown() override { std::filesystem::remove(path_); }

  std::string path_ = ::testing::TempDir() + "flute_grinder_job_" + std::to_string(::getpid()) + ".yaml";
};

TEST_F(JobFileOnDisk, ThatIsNoneIsNamed) {
  EXPECT_EQ(fileErrorOf("jobs"), "jobs: cannot be read: Is a directory");
  std::ofstream(path_).close();
  EXPECT_EQ(fileErrorOf(path_), path_ + ": is empty");
  std::filesystem::remove(path_);
  EXPECT_EQ(fileErrorOf(path_), path_ + ": cannot be read: No such file or directory");
}

TEST_F(JobFileOnDisk, ThatMayNotBeRead) {
  std::filesystem::permissions(path_, std::filesystem::perms::none);
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    // root may read everything.
    constexpr uid_t nobody = 65534;
    const bool other = ::geteuid() != 0 || ::setuid(nobody) == 0;
    const std::string error = other ? fileErrorOf(path_) : "cannot be another user than root";
    ::_exit(::write(ends[1], error.data(), error.size()) < 0 ? 1 : 0);
  }
  ::close(ends[1]);
  std::array<char, 1000> error{};
  EXPECT_GE(::read(ends[0], error.data(), error.size() - 1), 0);
  ::close(ends[0]);
  EXPECT_EQ(::waitpid(child, nullptr, 0), child);
  EXPECT_EQ(std::string(error.data()), path_ + ": cannot be read: Permission denied");
}

TEST_F(JobFileOnDisk, ThatIsTooLong) {
  const std::string most = kGood + std::string(kMaxYamlFile - std::string(kGood).size(), '#');
  std::ofstream(path_) << most;
  EXPECT_EQ(fileErrorOf(path_), "");
  std::ofstream(path_) << most << '#';
  EXPECT_EQ(fileErrorOf(path_), path_ + ": is too long; allowed: 65536 bytes");
}

TEST(JobFile, ReportsTheFirstOfManyErrorsAndHowManyMore) {
  std::string text;
  for (int i = 1; i <= 25; ++i) text += "key_" + std::to_string(i) + ": 1\n";
  const std::string error = errorOf(kGood + text);
  EXPECT_EQ(linesOf(error), 21) << error;
  EXPECT_EQ(error.substr(error.rfind('\n') + 1), "job.yaml: and 5 more");
}

TEST(JobFile, CutsALongError) { EXPECT_LT(errorOf(with("pass_major", std::string(60000, 'x'))).size(), 3000u); }

TEST(JobFile, RefusesALaughBeforeItIsBuilt) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 60; ++i) {
    const std::string last = "*a" + std::to_string(i - 1), name = "a" + std::to_string(i);
    text += name + ": &" + name + " [" + last + ", " + last + ", " + last + "]\n";
  }
  EXPECT_EQ(errorOf(text), "job.yaml:1: has an anchor; allowed: none, and no aliases");
}

TEST(JobFile, RefusesTheDeepest) {
  for (const std::size_t depth : {6U, 400U, 30000U}) {
    const std::string error = errorOf("a: " + std::string(depth, '[') + std::string(depth, ']') + "\n");
    EXPECT_EQ(error.rfind("job.yaml:1: ", 0), 0u) << depth;
    EXPECT_EQ(linesOf(error), 1) << depth;
  }
}

/// A text with some pieces of it replaced by what YAML knows.
std::string spoiled(std::mt19937& dice) {
  const std::vector<std::string> pieces{"\n",   ": ",     "- ",     "[",           "]",    "{",     "}",    "&a ",
                                        "*a",   "!!int ", "---\n",  "...\n",       "\t",   "\"",    "'",    "|\n",
                                        "? ",   "#",      "~",      "0x1",         "010",  "1e999", ".nan", "\0",
                                        "\x1b", "\xff",   "\u00b0", "%YAML 1.2\n", "<<: ", "@"};
  std::string text = kGood;
  for (std::size_t i = 0, count = 1 + dice() % 2; i < count; ++i) {
    text.replace(dice() % text.size(), dice() % 6, pieces[dice() % pieces.size()]);
  }
  return text;
}

TEST(JobFile, AnyTextIsAJobOrIsRefusedByItsLines) {
  std::mt19937 dice(1);
  int read = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string text = spoiled(dice);
    const std::string error = errorOf(text);
    std::istringstream lines(error);
    int reported = 0;
    for (std::string line; std::getline(lines, line); ++reported)
      EXPECT_EQ(line.rfind("job.yaml:", 0), 0u) << text << error;
    EXPECT_LE(reported, 21) << text;
    read += reported == 0 ? 1 : 0;
  }
  EXPECT_GT(read, 10);
  EXPECT_LT(read, 2000);
}

}  // namespace test_job_file
}  // namespace grinder
