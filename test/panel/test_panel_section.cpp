// The panel's section of the ground cutter, against figures in closed form.

#include "stage.h"

#include <QRegularExpression>

#include <cmath>

namespace grinder::test_panel_section {

const std::string kRed = "<span style=\"color:#b00020\">";

class SectionOnStage : public Staged {
 protected:
  static void openSection(Panel& panel) {
    panel.openTab("Section");
    ASSERT_TRUE(panel.isVisible("section_x"));
  }
  static double x(Panel& panel) { return panel.the<QDoubleSpinBox>("section_x").value(); }
  /// Switches it on or off.
  static void follow(Panel& panel, bool on = true) {
    panel.tick("follow_wheel");
    ASSERT_EQ(panel.the<QCheckBox>("follow_wheel").isChecked(), on);
  }
  void standAt(double x) { stage.standAt({x, 0, 0, 0}); }
  static ::testing::AssertionResult shows(Panel& panel, const std::string& text) {
    return panel.shows("section_figures", text);
  }
  /// The numbers of the text, in their order.
  static std::vector<double> numbers(Panel& panel) {
    std::vector<double> found;
    const QString text = QString::fromStdString(panel.label("section_figures")).remove(QRegularExpression("<[^>]*>"));
    auto matches = QRegularExpression(R"(\d+\.\d+)").globalMatch(text);
    while (matches.hasNext()) found.push_back(matches.next().captured().toDouble());
    return found;
  }

  const QTemporaryDir folder;
};

TEST_F(SectionOnStage, FiguresOfAStraightFluteAreThoseOfTheClosedForm) {
  // The upper face of a wheel of 3 mm passes a cylinder's axis at 5 mm sin 8 deg; its surface leaves a flat floor 1.6
  // mm deep, which ends at the wheel's lower face.
  const double face = 5 * std::sin(8 * M_PI / 180);
  Panel panel("cell/stage", changedJob(kPaper, folder.filePath("cylinder.yaml"),
                                       {{"cone_angle_deg: 5", "cone_angle_deg: 0"},
                                        {"spiral_angle_deg: 30", "spiral_angle_deg: 0"},
                                        {"core_diameter_mm: 7.1", "core_diameter_mm: 6.8"},
                                        {"core_diameter_end_mm: 12.4", "core_diameter_end_mm: 6.8"},
                                        {"overtravel_mm: [1, 7]", "overtravel_mm: [20, 20]"},
                                        {"swivel_deg: 31.769, height_mm: 2.788",
                                         "swivel_deg: 0, height_mm: " + QByteArray::number(face - 1.5, 'g', 12)}}));
  openSection(panel);
  WAIT_FOR(shows(panel, "Rake "));
  EXPECT_EQ(x(panel), 15) << "the middle";
  // The rake face is a plane, so that the chord has its angle.
  EXPECT_TRUE(shows(panel,
                    "Rake 8.00 deg, asked 7.50 to 8.50 deg, chordal 8.00 deg<br>"
                    "Core 6.800 mm, asked 6.800 within 0.1 mm<br>Spiral "));
  const double land = 360 - 8 - std::asin((3 - face) / 5) * 180 / M_PI;
  const std::vector<double> shown = numbers(panel);
  ASSERT_EQ(shown.size(), 11U) << panel.label("section_figures");
  EXPECT_NEAR(shown[9], land, 0.0051);
  EXPECT_NEAR(shown[10], 5 * land * M_PI / 180, 0.0051);
  EXPECT_FALSE(shows(panel, kRed));
}

TEST_F(SectionOnStage, AReliefHasItsClearanceAndWidth) {
  Panel panel("cell/stage", QString(kPaper).replace("test/jobs/paper", "jobs/taper_reamer_d6_t6"));
  stage.be("ready");
  openSection(panel);
  WAIT_FOR(shows(panel, "none of its operations is"));
  panel.openTab("Job");
  auto& operation = panel.the<QComboBox>("operation");
  QTest::keyClick(&operation, Qt::Key_Down);
  QTest::keyClick(&operation, Qt::Key_Down);
  openSection(panel);
  // The path is such that the clearance is the one asked.
  WAIT_FOR(shows(panel, "Clearance 10.00, asked 9.50 to 10.50 deg<br>Rake 6.00 deg, asked 5.50 to 6.50 deg"));
  EXPECT_FALSE(shows(panel, "Primary relief")) << "it ends on the land, until the secondary one is ground";
  panel.picture("section_primary");
  panel.openTab("Job");
  QTest::keyClick(&operation, Qt::Key_Down);
  openSection(panel);
  WAIT_FOR(shows(panel, "deg<br>Primary relief "));
  // As wide as asked at the small end, and wider with the diameter.
  const double width = 0.3 * (6 + 2 * 8 * std::tan(2 * M_PI / 180)) / 6;
  EXPECT_NEAR(numbers(panel).at(3), width, 0.0051) << panel.label("section_figures");
  EXPECT_FALSE(shows(panel, kRed));
  panel.picture("section_secondary");
}

TEST_F(SectionOnStage, LandsDifferAsThePitchesDo) {
  Panel panel("cell/stage", QString(kPaper).replace("test/jobs/paper", "jobs/unequal_d12_t4"));
  stage.be("ready", panel);
  openSection(panel);
  WAIT_FOR(shows(panel, "Land "));
  const std::vector<double> shown = numbers(panel);
  ASSERT_EQ(shown.size(), 14U) << panel.label("section_figures");
  EXPECT_NEAR(shown[11] - shown[10], 92 - 88, 0.02);
  panel.picture("section_of_a_tool");
}

TEST_F(SectionOnStage, WhatIsNotAsAskedIsRed) {
  // Wider than the pitch of eight teeth lets be.
  Panel narrow("cell/stage", changedJob(kPaper, folder.filePath("narrow.yaml"),
                                        {{"teeth: 1", "teeth: 8"}, {"width_mm: 3", "width_mm: 8"}}));
  openSection(narrow);
  WAIT_FOR(shows(narrow, kRed + "No land on tooth 1</span>"));
  narrow.picture("section_without_land");
  // Another swivel than the one that makes the rake.
  Panel panel("cell/stage", changedJob(kPaper, folder.filePath("swivel.yaml"),
                                       {{"swivel_deg: 31.769", "swivel_deg: 20"}, {"teeth: 1", "teeth: 2"}}));
  openSection(panel);
  WAIT_FOR(shows(panel, kRed + "Rake "));
  EXPECT_GT(std::abs(numbers(panel).at(0) - 8), 0.5) << panel.label("section_figures");
  panel.picture("section_wrong_rake");
}

TEST_F(SectionOnStage, CoreSpiralAndChordHaveTheirTolerances) {
  Panel off("cell/stage", changedJob(kPaper, folder.filePath("off.yaml"),
                                     {{"core_diameter_mm: 7.1", "core_diameter_mm: 7.4"},
                                      {"spiral_tolerance_deg: 4", "spiral_tolerance_deg: 0.001"},
                                      {"chordal_rake_tolerance_deg: 6", "chordal_rake_tolerance_deg: 1"}}));
  openSection(off);
  WAIT_FOR(shows(off, "Core "));
  off.the<QDoubleSpinBox>("section_x").setValue(0);
  WAIT_FOR(shows(off, "asked 7.400 within 0.1 mm"));
  for (const char* figure : {"Core 7.0", "Spiral ", ", chordal "}) EXPECT_TRUE(shows(off, kRed + figure));
  off.picture("section_core_off");
}

TEST_F(SectionOnStage, ItFollowsTheWheel) {
  Panel panel("cell/stage", kPaper);
  stage.change([&] { stage.state.progress.job_digest = digestOf(kPaper); });
  stage.be("running");
  standAt(0.012345);
  openSection(panel);
  follow(panel);
  WAIT_FOR(x(panel) == 12.35 || x(panel) == 12.34);
  EXPECT_FALSE(panel.enabled("section_x"));
  const double core = 7.1 + (12.4 - 7.1) * 12.345 / 30;  // that the job asks for
  WAIT_FOR(numbers(panel).size() == 11 && std::abs(numbers(panel)[5] - core) < 0.003);
  EXPECT_TRUE(shows(panel, " deg, asked 30.00 within 4 deg"));
  EXPECT_FALSE(shows(panel, kRed)) << "all is within its tolerance";
  standAt(-0.05);
  WAIT_FOR(x(panel) == 0);
  standAt(0.2);
  WAIT_FOR(x(panel) == 30);
  stage.change([&] { stage.joints.position.clear(); });
  WAIT_FOR(shows(panel, "No position comes from the grinder."));
}

TEST_F(SectionOnStage, ItSaysWhatItCannotShow) {
  stage.change([&] {
    stage.state.progress.job_digest = std::string(64, 'a');
    stage.state.progress.job_name = "published.yaml";
    stage.state.progress.cutter = goalFromFile(kPaper.toStdString()).cutter;
  });
  stage.be("running");
  standAt(0.01);
  {
    Panel without("cell/stage");
    openSection(without);
    WAIT_FOR(shows(without, "No job is chosen"));
  }
  Panel panel("cell/stage", kPaper);
  openSection(panel);
  WAIT_FOR(shows(panel, "Rake "));
  const auto hold = [&] { return panel.the<QWidget>("hold").pos(); };
  const QPoint place = hold();
  follow(panel);
  WAIT_FOR(shows(panel, "The grinder runs published.yaml (D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth)"));
  EXPECT_TRUE(shows(panel, "not the chosen job"));
  EXPECT_FALSE(panel.isVisible("section"));
  panel.picture("section_of_another_job");
  EXPECT_EQ(hold(), place);
  follow(panel, false);
  WAIT_FOR(shows(panel, "Rake "));
}

}  // namespace grinder::test_panel_section
