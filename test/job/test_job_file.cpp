#include "flute_grinder/job/job_file.h"

#include "flute_grinder/base/read_file.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/rounded_job.h"
#include "flute_grinder/job/setup_file.h"

#include "job/good_job.h"
#include "refusal.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace grinder {
namespace test_job_file {

using test_support::kGoodJob;
using test_support::refusalOf;
using test_support::with;

constexpr double kPi = 3.141592653589793238462643383279502884;

/// What is wrong with a text; empty where nothing is.
std::string errorOf(const std::string& text) {
  return refusalOf([&] { parseJob(text, "job.yaml"); });
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
  const GrindJob job = parseJob(kGoodJob, "job.yaml");
  const CutterGeometry& c = job.cutter;
  const GrindProcess& p = job.process();
  const std::vector<double> lengths{c.end_diameter,
                                    c.flute_length,
                                    c.shank_diameter,
                                    p.depth,
                                    p.infeed,
                                    p.finish_infeed,
                                    p.clearance,
                                    p.overtravel_end,
                                    p.overtravel_shank,
                                    p.wheel_diameter,
                                    p.wheel_width,
                                    p.wheel_wear,
                                    p.wheel_corner_radius_lower,
                                    p.wheel_corner_radius_upper,
                                    p.setup_height,
                                    job.interpolation.tolerance};
  const std::vector<double> millimetres{6, 25, 10, 1.5, 0.5, 0.05, 5, 1, 2, 100, 8, 0.3, 0.1, 0.2, 1.25, 0.002};
  for (std::size_t i = 0; i < lengths.size(); ++i) EXPECT_DOUBLE_EQ(lengths[i], millimetres.at(i) / 1000) << i;
  const std::vector<double> angles{c.cone_angle,     c.spiral_angle, c.rake_angle,
                                   c.rake_tolerance, p.wheel_angle,  p.setup_swivel};
  const std::vector<double> degrees{-1, -45, 12, 0.25, 20, -46};
  for (std::size_t i = 0; i < angles.size(); ++i) EXPECT_DOUBLE_EQ(angles[i], degrees.at(i) * kPi / 180) << i;
  EXPECT_DOUBLE_EQ(p.feed, 0.2 / 60);
  EXPECT_DOUBLE_EQ(job.interpolation.rotary_scale, 0.0015);
  EXPECT_EQ(p.spark_out, 1);
  EXPECT_EQ(c.cut, CutDirection::kLeftHand);
  EXPECT_EQ(p.order, GrindOrder::kPassMajor);
  EXPECT_EQ(p.direction, StrokeDirection::kToEnd);
  EXPECT_EQ(p.wheel_profile, WheelShape::kAngled);
  EXPECT_EQ(p.wheel_side, WheelFace::kLower);
  EXPECT_EQ(job.interpolation.even_step, EvenStepRule::kThirdOrder);
}

GrindJob jobWith(const std::string& piece, const std::string& replacement) {
  return parseJob(with(piece, replacement), "job.yaml");
}

TEST(JobFile, ReadsWhatMayBeLeftOut) {
  const GrindJob plain = parseJob(kGoodJob, "job.yaml");
  EXPECT_EQ(plain.process().depth_end, 0);
  EXPECT_EQ(plain.process().depthEnd(), plain.process().depth);
  EXPECT_FALSE(plain.process().incomplete_ok);
  EXPECT_TRUE(plain.spiral_angles.empty());
  EXPECT_EQ(plain.process().wheel_wear_per_pass, 0);
  EXPECT_EQ(jobWith("    corner_radius_mm: [0.1, 0.2]\n", "").process().wheel_corner_radius_upper, 0);
  EXPECT_DOUBLE_EQ(jobWith("  infeed_mm", "  depth_end_mm: 1.75\n  infeed_mm").process().depthEnd(), 0.00175);
  EXPECT_TRUE(jobWith("  order:", "  incomplete_ok: true\n  order:").process().incomplete_ok);
  const GrindProcess wearing = jobWith("wear_mm: 0.3\n", "wear_mm: 0.3\n    wear_per_pass_mm: 0.004\n").process();
  EXPECT_DOUBLE_EQ(wearing.wheel_wear_per_pass, 4e-6);
  EXPECT_DOUBLE_EQ(wearing.wheel_wear, 0.0003);
}

const char* const kAngled = "    profile: angled\n    angle_deg: 20\n    side: lower\n";

TEST(JobFile, ReadsItsLists) {
  GrindJob job = jobWith("spiral_angle_deg: -45", "spiral_angles_deg: [-45, -44, -43, -42]");
  EXPECT_DOUBLE_EQ(job.cutter.spiral_angle, -kPi / 4);
  ASSERT_EQ(job.spiral_angles.size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(ValidJob(job).cutterOf(i).spiral_angle, (i - 45) * kPi / 180);
  const std::vector<double> angles = jobWith("teeth: 4", "tooth_angles_deg: [0, 88, 180, 268]").tooth_angles;
  const std::vector<double> degrees{0, 88, 180, 268};
  ASSERT_EQ(angles.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_DOUBLE_EQ(angles[i], degrees[i] * kPi / 180);
  job = jobWith(kAngled, "    profile: points\n    points_mm: [[-4, 49], [0, 50], [4, 48.5]]\n");
  ASSERT_EQ(job.process().wheel_points.size(), 3u);
  EXPECT_DOUBLE_EQ(job.process().wheel_points[0].w, -0.004);
  EXPECT_DOUBLE_EQ(job.process().wheel_points[2].radius, 0.0485);
}

TEST(JobFile, SpacesEveryAllowedCountOfTeethEvenly) {
  for (int teeth = 1; teeth <= kMaxTeeth; ++teeth) {
    const GrindJob job = jobWith("teeth: 4", "teeth: " + std::to_string(teeth));
    ASSERT_EQ(job.tooth_angles.size(), static_cast<std::size_t>(teeth));
    for (int i = 0; i < teeth; ++i)
      EXPECT_NEAR(job.tooth_angles[static_cast<std::size_t>(i)], 2 * kPi * i / teeth, 1e-14);
  }
}

/// What the one message of a mistake must have, as for hasLine().
TEST(JobFile, ReportsAMistakeOnceWithFileLineKeyAndWhatIsAllowed) {
  const struct {
    const char *piece, *replacement, *message;
  } rows[]{
      {"  depth_mm: 1.5\n", "  depth_mm: 1.5\n  detph_mm: 1.5\n",
       "job.yaml:19 ... process.detph_mm is not a key of a job file; did you mean 'process.depth_mm'?"},
      {"  teeth: 4\n", "  teeth: 4\n  colour: red\n",
       "job.yaml:8 ... cutter.colour is not a key of a job file; allowed: cutter."},
      {"interpolation:", "paint: 3\ninterpolation:", "job.yaml:35 ... paint"},
      {"  teeth: 4\n", "  teeth: 4\n  colour: []\n", "job.yaml:8 ... cutter.colour"},
      {"  teeth: 4\n", "  teeth: 4\n  colour: {}\n", "job.yaml:8 ... cutter.colour"},
      {"[1, 2]", "[1, 2, 3]", "job.yaml:23 ... process.overtravel_mm[2]"},
      {"  depth_mm: 1.5\n", "  depth_mm: 1.5\n  depth_mm: 1.6\n", "job.yaml:19 ... process.depth_mm ... appears twice"},
      {"feed_mm_min: 200", "feed_mm_min:", "job.yaml:17 ... process.feed_mm_min ... (nothing) ... 0.1 to 10000 mm/min"},
      {"teeth: 4", "teeth: 4.5", "job.yaml:7 ... cutter.teeth = 4.5 is not a whole number; allowed: 1 to 64"},
      {"spiral_angle_deg: -45", "spiral_angle_deg: 30,5",
       "job.yaml:4 ... cutter.spiral_angle_deg = 30,5 is not a number; allowed: -60 to 60 deg"},
      {"teeth: 4", "teeth: 0.5", "job.yaml:7 ... cutter.teeth = 0.5 is not a whole number; allowed: 1 to 64"},
      {"depth_mm: 1.5", "depth_mm: 1-2",
       "job.yaml:18 ... process.depth_mm = 1-2 is not a number; allowed: 0.001 to 50 mm"},
      {"feed_mm_min: 200", "feed_mm_min: \"\"", "job.yaml:17 ... process.feed_mm_min =  is not a number"},
      {"teeth: 4", "teeth: 010", "job.yaml:7 ... cutter.teeth = 010 ... octal ... 1 to 64"},
      {"teeth: 4", "teeth: +04", "job.yaml:7 ... cutter.teeth = +04 ... octal ... 1 to 64"},
      {"teeth: 4", "teeth: -4", "job.yaml:7 ... cutter.teeth = -4; allowed: 1 to 64"},
      {"spark_out: 1", "spark_out: []", "job.yaml:21 ... process.spark_out = (not a value) is not a whole number"},
      {"depth_mm: 1.5", "depth_mm: 1e999",
       "job.yaml:18 ... process.depth_mm = 1e999 is out of range ... 0.001 to 50 mm"},
      {"teeth: 4", "teeth: 0o10", "job.yaml:7 ... cutter.teeth = 0o10 ... octal"},
      {"teeth: 4", "teeth: 0x10", "job.yaml:7 ... cutter.teeth = 0x10 ... hexadecimal"},
      {"teeth: 4", "teeth: 99999999999", "job.yaml:7 ... cutter.teeth = 99999999999 is out of range ... 1 to 64"},
      {"depth_mm: 1.5", "depth_mm: 0x1", "job.yaml:18 ... process.depth_mm = 0x1 ... 0.001 to 50 mm"},
      {"interpolation:", "---\ninterpolation:", "job.yaml:35 ... a second document begins here ... allowed: one"},
      {"rotary_scale_mm_per_rad: 1.5\n", "rotary_scale_mm_per_rad: 1.5\n---\n",
       "job.yaml:39 ... a second document begins here"},
      {"depth_mm: 1.5", "depth_mm: &deep 1.5", "job.yaml:18 ... anchor ... allowed: none"},
      {"cutter:", "cutter: &cutter", "job.yaml: ... anchor ... allowed: none"},
      {"depth_mm: 1.5", "depth_mm: *deep", "job.yaml:18 ... anchor"},
      {"pass_major", "\"pass\\nmajor\"", "job.yaml:24 ... process.order = pass\\nmajor"},
      {"depth_mm: 1.5", "depth_mm: .nan", "job.yaml:18 ... process.depth_mm ... nan ... 0.001 to 50 mm"},
      {"  teeth: 4\n", "  teeth: 4\n  tooth_angles_deg: [0, 90]\n",
       "job.yaml:7 ... cutter.teeth ... cutter.tooth_angles_deg ... one of the two"},
      {"  teeth: 4\n", "  teeth: 4\n  tooth_angles_deg: []\n", "job.yaml: ... cutter.t"},
      {"teeth: 4", "tooth_angles_deg: [0, half]", "job.yaml:7 ... cutter.tooth_angles_deg[1] ... half ... ascending"},
      {"    profile: angled\n    angle_deg: 20\n", "    profile: straight\n",
       "job.yaml:31 ... process.wheel.side ... not a key"},
      {kAngled, "    profile: straight\n    angle_deg: 20\n",
       "job.yaml:31 ... process.wheel.angle_deg ... 20 deg ... 0 for this profile"},
      {"    angle_deg: 20\n", "", "job.yaml ... process.wheel.angle_deg ... 0 deg ... more than 0 for this profile"},
      {"[0.1, 0.2]", "[4, 4.5]",
       "job.yaml:33 ... process.wheel.corner_radius_mm[0] ... 8.5 mm ... wheel's width ... 8 mm"},
      {kAngled, "    profile: full_radius\n",
       "job.yaml:31 ... process.wheel.corner_radius_mm[0] ... 0.3 mm ... allowed: 0 for this profile"},
      {"[0.1, 0.2]", "[0.1]", "job.yaml ... process.wheel.corner_radius_mm[1] ... missing"},
      {kAngled, "    profile: points\n", "job.yaml ... process.wheel.points_mm ... [w, radius]"},
      {kAngled, "    profile: points\n    points_mm: [[-3, 50], [3, 49]]\n",
       "job.yaml:28 ... process.wheel.width_mm ... 8 mm ... its points ... 6 mm"},
      {kAngled, "    profile: points\n    points_mm: [[-4, 50], [-4, 49], [4, 50]]\n",
       "job.yaml:31 ... process.wheel.points_mm ... -4 mm ... ascending"},
      {kAngled, "    profile: points\n    points_mm: [[-4, 50], [4]]\n",
       "job.yaml:31 ... process.wheel.points_mm[1] ... not a pair"},
      {kAngled, "    profile: points\n    points_mm: [[-4]]\n",
       "job.yaml:31 ... process.wheel.points_mm[0] ... not a pair"},
      {"  spiral_angle_deg: -45\n", "  spiral_angle_deg: -45\n  spiral_angles_deg: [-45, -44, -45, -44]\n",
       "job.yaml:4 ... cutter.spiral_angle_deg ... cutter.spiral_angles_deg ... one of the two"},
      {"spiral_angle_deg: -45", "spiral_angles_deg: [-45, -44]",
       "job.yaml:4 ... cutter.spiral_angles_deg ... 2 ... as many as teeth, 4"},
      {"spiral_angle_deg: -45", "spiral_angles_deg: [-45, -44, -61, -44]",
       "job.yaml:4 ... cutter.spiral_angles_deg ... -61 deg ... -60 to 60 deg"}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.replacement);
    const std::string error = errorOf(with(row.piece, row.replacement));
    EXPECT_TRUE(hasLine(error, row.message)) << "got: " << error << "\nwanted: " << row.message;
    EXPECT_EQ(linesOf(error), 1) << error;
  }
}

TEST(JobFile, RefusesWhatIsNoTreeOfWords) {
  const struct {
    std::string text;
    const char* message;  ///< as for hasLine()
  } rows[]{{with("  clearance_mm: 5\n", "process:\n  clearance_mm: 5\n"), "job.yaml:22 ... process"},
           {with("process:\n  feed_mm_min: 200\n", "process.feed_mm_min: 200\nprocess:\n"),
            "job.yaml ... process.feed_mm_min"},
           {with("[0.1, 0.2]", "[{lower: 0.1}, 0.2]"), "job.yaml ... process.wheel.corner_radius_mm[0] is missing"},
           {with("teeth: 4", "teeth: [4"), "job.yaml:"},
           {"cutter:\n  teeth: 4\n bad: : :\n", "job.yaml:3"},
           {kGoodJob + "? [1, 2]\n: 3\n", "job.yaml:39"},
           {"3", "job.yaml:1 ... not a map"},
           {"", "job.yaml:1 ... not a map"},
           {"# a comment only\n", "job.yaml:1 ... not a map"}};
  for (const auto& row : rows) {
    const std::string error = errorOf(row.text);
    EXPECT_TRUE(hasLine(error, row.message)) << row.text << "\ngot: " << error << "\nwanted: " << row.message;
  }
}

/// A file with the good text; and what is said of reading a file, nothing where it was read.
class JobFileOnDisk : public ::testing::Test {
 protected:
  JobFileOnDisk() { std::ofstream(path_) << kGoodJob; }

  static std::string fileErrorOf(const std::string& path) {
    return refusalOf([&] { readJobFile(path); });
  }

  const test_support::TempFolder folder_;
  const std::string path_ = folder_.path() / "job.yaml";
};

TEST_F(JobFileOnDisk, ThatIsNoneIsNamed) {
  EXPECT_EQ(fileErrorOf("jobs"), "jobs: cannot be read: Is a directory");
  std::ofstream(path_).close();
  EXPECT_EQ(fileErrorOf(path_), path_ + ": is empty");
  std::filesystem::remove(path_);
  EXPECT_EQ(fileErrorOf(path_), path_ + ": cannot be read: No such file or directory");
}

TEST_F(JobFileOnDisk, ThatIsTooLong) {
  const std::string most = kGoodJob + std::string(kMaxYamlFile - kGoodJob.size(), '#');
  std::ofstream(path_) << most;
  EXPECT_EQ(fileErrorOf(path_), "");
  std::ofstream(path_) << most << '#';
  EXPECT_EQ(fileErrorOf(path_), path_ + ": is too long; allowed: 65536 bytes");
}

TEST(JobFile, ReportsTheFirstOfManyErrorsAndHowManyMoreAndCutsALongOne) {
  std::string text;
  for (int i = 1; i <= 21; ++i) text += "key_" + std::to_string(i) + ": 1\n";
  const std::string error = errorOf(kGoodJob + text);
  EXPECT_EQ(linesOf(error), 21) << error;
  EXPECT_EQ(error.substr(error.rfind('\n') + 1), "job.yaml: and 1 more");
  EXPECT_LT(errorOf(with("pass_major", std::string(60000, 'x'))).size(), 3000u);
}

TEST(JobFile, RefusesALaughBeforeItIsBuilt) {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 60; ++i) {
    const std::string last = "*a" + std::to_string(i - 1), name = "a" + std::to_string(i);
    text += name + ": &" + name + " [" + last + ", " + last + ", " + last + "]\n";
  }
  EXPECT_EQ(errorOf(text), "job.yaml:1: has an anchor; allowed: none, and no aliases");
}

TEST(JobFile, RefusesTheDeepest) {
  for (const std::size_t depth : {7U, 400U, 30000U}) {
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
  std::string text = kGoodJob;
  for (std::size_t i = 0, count = 1 + dice() % 2; i < count; ++i) {
    text.replace(dice() % text.size(), dice() % 6, pieces[dice() % pieces.size()]);
  }
  return text;
}

TEST(JobFile, AnyTextIsAJobOrIsRefusedByItsLines) {
  std::mt19937 dice(1);
  int read = 0;
  for (int i = 0; i < 1500; ++i) {
    const std::string text = spoiled(dice);
    const std::string error = errorOf(text);
    std::istringstream lines(error);
    int reported = 0;
    for (std::string line; std::getline(lines, line); ++reported)
      EXPECT_EQ(line.rfind("job.yaml:", 0), 0u) << text << error;
    EXPECT_LE(reported, 21) << text;
    read += reported == 0 ? 1 : 0;
  }
  EXPECT_GT(read, 3);
  EXPECT_LT(read, 750);
}

TEST(JobFile, ReadsEveryChoice) {
  EXPECT_EQ(jobWith("pass_major", "tooth_major").process().order, GrindOrder::kToothMajor);
  EXPECT_EQ(jobWith("to_end", "from_end").process().direction, StrokeDirection::kFromEnd);
  EXPECT_EQ(jobWith("third_order", "published").interpolation.even_step, EvenStepRule::kPublished);
  EXPECT_EQ(jobWith("third_order", "exact").interpolation.even_step, EvenStepRule::kExact);
}

TEST(JobFile, ReportsAllOfSeveralErrors) {
  const std::string cut = std::string(kGoodJob).substr(0, std::string(kGoodJob).find("interpolation:"));
  const struct {
    std::string text;
    std::vector<const char*> messages;  ///< as for hasLine()
  } rows[]{
      {with("depth_mm: 1.5", "depth_mm: deep", with("pass_major", "any")) + "extra: 1\n",
       {"job.yaml:18 ... process.depth_mm ... deep", "job.yaml:24 ... process.order ... any", "job.yaml:39 ... extra"}},
      {with("depth_mm: 1.5", "depth_mm: 51", with("feed_mm_min: 200", "feed_mm_min: 0")),
       {"job.yaml:18 ... process.depth_mm ... 51 mm", "job.yaml:17 ... process.feed_mm_min ... 0 mm/min"}},
      {cut + "interpolation: exact\n",
       {"job.yaml:35 ... interpolation", "interpolation.tolerance_um ... missing",
        "interpolation.rotary_scale_mm_per_rad ... missing", "interpolation.even_step ... missing"}}};
  for (const auto& row : rows) {
    const std::string error = errorOf(row.text);
    EXPECT_EQ(linesOf(error), static_cast<std::ptrdiff_t>(row.messages.size())) << error;
    for (const char* message : row.messages) EXPECT_TRUE(hasLine(error, message)) << message << "\ngot: " << error;
  }
}

TEST(JobFile, OfAWholeMillReportsAMistakeWithWhatIsAllowedThere) {
  const struct {
    const char *operation, *piece, *replacement, *message;
  } rows[]{
      {"flute", "  - kind: chamfer\n", "  - kind: bevel\n",
       "jobs/mill.yaml:76: operations[6].kind = bevel; allowed: flute, relief, gash, end, chamfer"},
      {"secondary", "    relief: secondary\n    feed_mm_min: 400\n    roughing_passes: 3\n",
       "    relief: third\n    feed_mm_min: 400\n    roughing_passes: 3\n",
       "jobs/mill.yaml:48: operations[2].relief = third; allowed: primary, secondary"},
      {"secondary", "    relief: secondary\n    feed_mm_min: 400\n    roughing_passes: 3\n",
       "    relief: \"\"\n    feed_mm_min: 400\n    roughing_passes: 3\n",
       "jobs/mill.yaml:48: operations[2].relief = ; allowed: primary, secondary"},
      {"secondary", "    feed_mm_min: 400\n    roughing_passes: 3\n", "    roughing_passes: 3\n",
       "jobs/mill.yaml:1: operations[2].feed_mm_min is missing; allowed: 0.1 to 10000 mm/min"},
      {"secondary",
       "    roughing_passes: 3\n    finish_infeed_mm: 0.02\n    wheel: {file: ../wheels/straight_d100_w6.yaml}\n    "
       "setup: {",
       "    roughing_passes: 3\n    finish_infeed_mm: 0.02\n    wheel: {file: ../wheels/straight_d100_w6.yaml}\n    "
       "setup: {height_mm: 3, ",
       "jobs/mill.yaml:53: operations[2].setup.height_mm stands beside operations[2].setup.file; allowed beside it: "
       "operations[2].setup.swivel_deg"},
      {"gash", "a45.yaml}\n    setup: {", "a45.yaml}\n    setup: {swivel_deg: 3, ",
       "jobs/mill.yaml:61: operations[3].setup.swivel_deg stands beside operations[3].setup.file; allowed beside it: "
       "none"},
  };
  const std::string mill = test_support::readFile("jobs/end_mill_d10_t4.yaml");
  for (const auto& row : rows) {
    const std::string text = with(row.piece, row.replacement, mill);
    EXPECT_EQ(refusalOf([&] { parseJob(text, "jobs/mill.yaml", row.operation); }), row.message) << row.replacement;
  }
}

TEST(JobFile, RefusesAnotherOperationThanThereAreKinds) {
  const std::string end = "interpolation:\n";
  const std::string text = with(end, "  - kind: chamfer\n" + end, test_support::readFile("jobs/end_mill_d10_t4.yaml"));
  const std::string error = refusalOf([&] { parseJob(text, "jobs/mill.yaml", "flute"); });
  EXPECT_TRUE(hasLine(error, "jobs/mill.yaml:82 ... operations[7].kind is not a key of a job file")) << error;
}

TEST(RoundedJob, HasTheNineDigitsOfItsFile) {
  GrindJob job = parseJob(kGoodJob, "job.yaml");
  job.operations.push_back(job.process());
  GrindJob noisy = job;
  for (noisy.operation = 1; noisy.operation >= 0; --noisy.operation) {
    visitJobFields([&](const JobField&, auto of) { of(noisy) *= 1 + 1e-12; });
  }
  for (double& angle : noisy.tooth_angles) angle *= 1 + 1e-12;
  noisy.operation = 1;
  const GrindJob rounded = roundedOff(noisy);
  EXPECT_EQ(rounded.operation, 1);
  EXPECT_EQ(rounded.tooth_angles, job.tooth_angles);
  for (const int operation : {0, 1}) {
    const GrindJob is = rounded.ofOperation(operation), was = job.ofOperation(operation);
    visitJobFields([&](const JobField& field, auto of) { EXPECT_EQ(of(is), of(was)) << field.path; });
  }
}

/// The set-up file of the shipped paper's job, which ends with what it was solved for, and what is said of it.
class SetupOfAJob : public ::testing::Test {
 protected:
  std::string errorOf(const std::string& text) {
    return refusalOf([&] { takeSetup(text, "setup.yaml", job_); });
  }

  const std::string text_ = test_support::readFile("jobs/paper.setup.yaml");
  GrindJob job_ = readJobFile("jobs/paper.yaml");
};

TEST_F(SetupOfAJob, IsRefusedWhereItHasLessOrMore) {
  EXPECT_EQ(errorOf(text_), "");
  EXPECT_EQ(errorOf(with("    - process.z_law = published\n", "", text_)),
            "setup.yaml:1: solved for nothing; the job now has process.z_law = published");
  EXPECT_EQ(errorOf(with("  depth_mm:", "  colour: red\n  depth_mm:", text_))
                .find("setup.yaml:4: flute.colour is not a key of a set-up file; allowed: flute."),
            0u);
}

TEST_F(SetupOfAJob, IsNotWrittenOverANumber) {
  EXPECT_EQ(refusalOf([&] { withSetup("3\n", "setup.yaml", "paper.yaml", job_); }),
            "setup.yaml: not a set-up file, and not written over; name a file of its own in paper.yaml");
}

TEST_F(SetupOfAJob, IsSoughtFromATenthOfTheWayToTheApexOn) {
  job_.cutter.end_diameter = 0.6e-3;
  job_.cutter.cone_angle = kPi / 6;
  clearSetup(job_);
  EXPECT_NEAR(job_.process().overtravel_end, 0.03e-3 * std::sqrt(3), 1e-15);
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

}  // namespace test_job_file
}  // namespace grinder
