#include "flute_grinder/job/wheel_file.h"

#include "flute_grinder/job/job_fields.h"

#include "job/good_job.h"
#include "random_cases.h"
#include "refusal.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

/// @file
/// A job gets the wheel of a wheel file as it would get it from keys of its own, and a wheel file's mistakes are
/// reported with its own name and lines.

namespace grinder {
namespace test_wheel_file {

using test_support::refusalOf;
using test_support::with;

// Line numbers in the rows below are those of this text.
const char* const kWheel =
    "# 1V1\n"                         // 1
    "profile: angled\n"               // 2
    "diameter_mm: 100\n"              // 3
    "width_mm: 8\n"                   // 4
    "angle_deg: 20\n"                 // 5
    "side: lower\n"                   // 6
    "corner_radius_mm: [0.1, 0.2]\n"  // 7
    "measured:\n"                     // 8
    "  date: 2026-11-20\n"            // 9
    "  diameter_mm: 99.4\n"           // 10
    "  width_mm: 7.9\n"               // 11
    "  by: anna@grinder-2\n";         // 12

std::string errorOf(const std::string& text) {
  return refusalOf([&] { parseWheel(text, "wheel.yaml"); });
}

/// A job whose wheel's keys are these lines, from line 27 on.
std::string jobText(const std::string& wheel) {
  return with(
      "    diameter_mm: 100\n    width_mm: 8\n    wear_mm: 0.3\n    profile: angled\n    angle_deg: 20\n"
      "    side: lower\n    corner_radius_mm: [0.1, 0.2]\n",
      wheel);
}

/// A folder with a folder for jobs and one for wheels.
class WheelOfAJob : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_ + "/jobs");
    std::filesystem::create_directory(folder_ + "/wheels");
  }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ + "/" + name) << text;
    return folder_ + "/" + name;
  }

  static std::string jobErrorOf(const std::string& path) {
    return refusalOf([&] { readJobFile(path); });
  }

  const test_support::TempFolder temp_;
  const std::string folder_ = temp_.path();
};

/// Equal to the last bit.
void expectSame(const GrindJob& a, const GrindJob& b) {
  visitJobFields([&](const JobField& field, auto of) { EXPECT_EQ(of(a), of(b)) << field.path; });
  visitJobChoices([&](const char* path, int, auto of) { EXPECT_EQ(of(a), of(b)) << path; });
  EXPECT_EQ(a.tooth_angles, b.tooth_angles);
  ASSERT_EQ(a.process().wheel_points.size(), b.process().wheel_points.size());
  for (std::size_t i = 0; i < a.process().wheel_points.size(); ++i) {
    EXPECT_EQ(a.process().wheel_points[i].w, b.process().wheel_points[i].w);
    EXPECT_EQ(a.process().wheel_points[i].radius, b.process().wheel_points[i].radius);
  }
}

TEST(WheelFile, ReadsTheWheelAsItWasMeasured) {
  const WheelFile wheel = parseWheel(kWheel, "wheel.yaml");
  EXPECT_EQ(wheel.process.wheel_profile, WheelShape::kAngled);
  EXPECT_EQ(wheel.process.wheel_side, WheelFace::kLower);
  EXPECT_DOUBLE_EQ(wheel.process.wheel_diameter, 0.1);
  EXPECT_DOUBLE_EQ(wheel.process.wheel_wear, 0.0003);
  EXPECT_DOUBLE_EQ(wheel.diameter(), 0.0994);
  EXPECT_DOUBLE_EQ(wheel.process.wheel_width, 0.0079);
  EXPECT_DOUBLE_EQ(wheel.new_width, 0.008);
  EXPECT_DOUBLE_EQ(wheel.process.wheel_corner_radius_upper, 0.0002);
  EXPECT_TRUE(wheel.measured);
  EXPECT_FALSE(wheel.flange);
  EXPECT_EQ(wheel.date, "2026-11-20");
  EXPECT_EQ(wheel.by, "anna@grinder-2");
}

TEST(WheelFile, HasWhatMayBeLeftOut) {
  const std::string text = kWheel;
  const WheelFile unmeasured = parseWheel(text.substr(0, text.find("measured")), "f");
  EXPECT_FALSE(unmeasured.measured);
  EXPECT_EQ(unmeasured.process.wheel_wear, 0);
  EXPECT_DOUBLE_EQ(unmeasured.process.wheel_width, 0.008);
  EXPECT_DOUBLE_EQ(parseWheel(with("  width_mm: 7.9\n", "", kWheel), "f").process.wheel_width, 0.008);
  EXPECT_EQ(parseWheel(with("  by: anna@grinder-2\n", "", kWheel), "f").by, "");
  EXPECT_EQ(parseWheel(with("2026-11-20", "2026-11-20T08:15:30Z", kWheel), "f").date, "2026-11-20T08:15:30Z");
  const WheelFile on_flange = parseWheel(with("side: lower\n", "side: lower\nflange_mm: -2.5\n", kWheel), "f");
  ASSERT_TRUE(on_flange.flange);
  EXPECT_DOUBLE_EQ(*on_flange.flange, -0.0025);
}

TEST_F(WheelOfAJob, IsTheSameAsWithKeysOfItsOwn) {
  const struct {
    std::string file;  ///< a wheel file
    const char* own;   ///< keys of a job
  } rows[]{{kWheel,
            "    profile: angled\n    diameter_mm: 100\n    width_mm: 7.9\n    angle_deg: 20\n    side: lower\n"
            "    wear_mm: 0.3\n    corner_radius_mm: [0.1, 0.2]\n"},
           {"profile: straight\ndiameter_mm: 100\nwidth_mm: 8\n",
            "    profile: straight\n    diameter_mm: 100\n    width_mm: 8\n    wear_mm: 0\n"},
           {"profile: full_radius\ndiameter_mm: 100\nwidth_mm: 8\n",
            "    profile: full_radius\n    diameter_mm: 100\n    width_mm: 8\n    wear_mm: 0\n"},
           {"profile: points\ndiameter_mm: 100\nwidth_mm: 8\npoints_mm: [[-4, 49], [0, 50], [4, 48.5]]\n",
            "    profile: points\n    diameter_mm: 100\n    width_mm: 8\n    wear_mm: 0\n"
            "    points_mm: [[-4, 49], [0, 50], [4, 48.5]]\n"}};
  for (const auto& row : rows) {
    SCOPED_TRACE(row.file);
    const std::string also = "    wear_per_pass_mm: 0.001\n";
    const GrindJob own = readJobFile(write("jobs/own.yaml", jobText(row.own + also)));
    write("wheels/wheel.yaml", row.file);
    expectSame(readJobFile(write("jobs/named.yaml", jobText("    file: ../wheels/wheel.yaml\n" + also))), own);
    expectSame(readJobFile(write("absolute.yaml", jobText("    file: " + folder_ + "/wheels/wheel.yaml\n" + also))),
               own);
  }
}

TEST_F(WheelOfAJob, HasTheBitsOfTheSameWearInTheJob) {
  std::mt19937 random(20);
  const auto decimal = [](long long nanometres) {
    char text[40];
    std::snprintf(text, sizeof text, "%lld.%06lld", nanometres / 1000000, nanometres % 1000000);
    return std::string(text);
  };
  for (int i = 0, cases = test_support::randomCases(100); i < cases; ++i) {
    const long long wear = random() % 20'000'000, diameter = 60'000'000 + random() % 340'000'000;  // [nm]
    write("wheels/wheel.yaml",
          "profile: straight\ndiameter_mm: " + decimal(diameter) +
              "\nwidth_mm: 3\nmeasured: {date: 2026-11-20, diameter_mm: " + decimal(diameter - 2 * wear) + "}\n");
    const std::string named = write("jobs/named.yaml", jobText("    file: ../wheels/wheel.yaml\n"));
    const std::string own =
        write("jobs/own.yaml", jobText("    profile: straight\n    diameter_mm: " + decimal(diameter) +
                                       "\n    width_mm: 3\n    wear_mm: " + decimal(wear) + "\n"));
    const GrindProcess a = readJobFile(named).process(), b = readJobFile(own).process();
    ASSERT_EQ(a.wheel_wear, b.wheel_wear) << decimal(diameter);
    ASSERT_EQ(a.wheel_diameter, b.wheel_diameter) << decimal(diameter);
  }
}

TEST_F(WheelOfAJob, StandsAloneInTheJob) {
  write("wheels/wheel.yaml", kWheel);
  for (const char* key : {"diameter_mm: 100", "width_mm: 8", "profile: straight", "wear_mm: 0", "angle_deg: 20",
                          "side: upper", "corner_radius_mm: [0, 0]", "points_mm: [[-1, 2], [1, 2]]", "colour: red"}) {
    SCOPED_TRACE(key);
    const std::string path = write("jobs/job.yaml", jobText(std::string("    file: ../wheels/wheel.yaml\n    ") + key +
                                                            "\n    wear_per_pass_mm: 0\n"));
    const std::string name = std::string(key).substr(0, std::string(key).find(':'));
    EXPECT_EQ(jobErrorOf(path), path + ":28: process.wheel." + name +
                                    " stands beside process.wheel.file; allowed beside it: "
                                    "process.wheel.wear_per_pass_mm");
  }
}

TEST_F(WheelOfAJob, IsRefusedAtTheJobsLine) {
  write("wheels/wheel.yaml", kWheel);
  const std::pair<const char*, std::string> rows[]{
      {"    file: ../wheels/none.yaml\n",
       ":27: process.wheel.file = ../wheels/none.yaml: " + folder_ +
           "/jobs/../wheels/none.yaml: cannot be read: No such file or directory; allowed: a path from the job file's "
           "folder, " +
           folder_ + "/jobs"},
      {"    file: [1, 2]\n", ":27: process.wheel.file is a list; allowed: the path of a wheel file"},
      {"    ../wheels/wheel.yaml\n",
       ":26: process.wheel = ../wheels/wheel.yaml; allowed: keys of a wheel below it, as file: PATH for a wheel file"},
      {"    file: ../wheels/wheel.yaml\n    wear_per_pass_mm: 2\n",
       ":28: process.wheel.wear_per_pass_mm = 2 mm; allowed: 0 to 1 mm"}};
  for (const auto& [wheel, message] : rows) {
    const std::string path = write("jobs/job.yaml", jobText(wheel));
    EXPECT_EQ(jobErrorOf(path), path + message);
  }
}

TEST_F(WheelOfAJob, ReportsItsMistakesBesideThoseOfTheJob) {
  write("wheels/wheel.yaml", with("diameter_mm: 100", "diameter_mm: large", kWheel));
  const std::string path =
      write("jobs/job.yaml", with("spark_out: 1", "spark_out: x", jobText("    file: ../wheels/wheel.yaml\n")));
  EXPECT_EQ(jobErrorOf(path),
            folder_ + "/jobs/../wheels/wheel.yaml:3: diameter_mm = large is not a number; allowed: 1 to 500 mm\n" +
                path + ":21: process.spark_out = x is not a whole number; allowed: 0 to 100");
}

TEST(WheelFile, OfEveryShippedOneCanBeRead) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("wheels")) {
    SCOPED_TRACE(entry.path());
    EXPECT_NO_THROW(readWheelFile(entry.path().string()));
    ++count;
  }
  EXPECT_GE(count, 3);
}

TEST(WheelFile, ReportsAMistakeWithFileLineKeyAndWhatIsAllowed) {
  const struct {
    const char *piece, *replacement, *message;
  } rows[]{
      {"  by:", "  from:",
       "12: measured.from is not a key of a wheel file; allowed: measured.date, measured.diameter_mm, "
       "measured.width_mm, measured.by"},
      {"angle_deg: 20\n", "angle_deg: 20\nwear_mm: 0.1\n",
       "6: wear_mm is not a key of a wheel file; allowed: diameter_mm, width_mm, angle_deg, corner_radius_mm[0], "
       "corner_radius_mm[1], rim_mm, profile, side, flange_mm, measured.date, measured.diameter_mm, measured.width_mm, "
       "measured.by, dressed"},
      {"angle_deg: 20\n", "angle_deg: 20\ndressed: yesterday\n",
       "6: dressed = yesterday; allowed: YYYY-MM-DD, YYYY-MM-DDThh:mm:ssZ"},
      {"angle_deg: 20", "angle_deg: 0", "5: angle_deg = 0 deg; allowed: more than 0 for this profile"},
      {"99.4", ".nan", "10: measured.diameter_mm = nan mm; allowed: 1 to 100 mm, the diameter to which Y = 0 is set"},
      {"99.4", "100.1",
       "10: measured.diameter_mm = 100.1 mm; allowed: 1 to 100 mm, the diameter to which Y = 0 is set"},
      {"diameter_mm: 100", "diameter_mm: 300",
       "10: measured.diameter_mm = 99.4 mm; allowed: 100 to 300 mm, the diameter to which Y = 0 is set"},
      {"diameter_mm: 100", "diameter_mm: 600", "3: diameter_mm = 600 mm; allowed: 1 to 500 mm"},
      {"width_mm: 7.9", "width_mm: 0.25",
       "7: corner_radius_mm[0] = 0.3 mm; allowed: up to the wheel's width for both corners together, 0.25 mm"},
      // At 20 deg a radius of 2.8 mm is used up over 2.8 mm / tan 20 deg.
      {"diameter_mm: 99.4", "diameter_mm: 5.6",
       "11: measured.width_mm = 7.9 mm; allowed: less than 7.692936774 mm, where the wheel's smaller face closes"},
      {"diameter_mm: 99.4\n  width_mm: 7.9\n", "diameter_mm: 5.6\n",
       "4: width_mm = 8 mm; allowed: less than 7.692936774 mm, where the wheel's smaller face closes"}};
  for (const auto& row : rows) {
    EXPECT_EQ(errorOf(with(row.piece, row.replacement, kWheel)), std::string("wheel.yaml:") + row.message);
  }
}

TEST(WheelFile, OfPointsKeepsTheirWidth) {
  const std::string text =
      "profile: points\ndiameter_mm: 100\nwidth_mm: 8\npoints_mm: [[-4, 49], [0, 50], [4, 48.5]]\n"
      "measured: {date: 2026-11-20, diameter_mm: 99, width_mm: 7}\n";
  EXPECT_EQ(errorOf(text), "wheel.yaml:5: measured.width_mm = 7 mm; allowed: that of its points, 8 mm");
  EXPECT_EQ(errorOf(with("width_mm: 7}", "width_mm: 8}", text)), "");
}

}  // namespace test_wheel_file
}  // namespace grinder
