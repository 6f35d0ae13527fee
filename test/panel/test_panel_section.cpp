// The panel's section of the ground cutter, against figures in closed form.

#include "stage.h"

#include <QRegularExpression>

#include <cmath>

namespace grinder::test_panel_section {

const std::string kRed = "<span style=\"color:#b00020\">";
const QRegularExpression kNumber(R"(\d+\.\d+)");

class SectionOnStage : public Staged {
 protected:
  static void openSection(Panel& panel) {
    panel.openTab("Section");
    ASSERT_TRUE(panel.isVisible("section_x"));
  }
  static double x(Panel& panel) { return panel.the<QDoubleSpinBox>("section_x").value(); }
  void standAt(double x) { stage.standAt({x, 0, 0, 0}); }
  static ::testing::AssertionResult shows(Panel& panel, const std::string& text) {
    return panel.shows("section_figures", text);
  }
  /// The numbers of the text, in their order.
  static std::vector<double> numbers(Panel& panel) {
    std::vector<double> found;
    const QString text = QString::fromStdString(panel.label("section_figures")).remove(QRegularExpression("<[^>]*>"));
    auto matches = kNumber.globalMatch(text);
    while (matches.hasNext()) found.push_back(matches.next().captured().toDouble());
    return found;
  }

  const QTemporaryDir folder;
};

TEST_F(SectionOnStage, AReliefHasItsClearanceAndWidth) {
  Panel panel("cell/stage", QString(kPaper).replace("test/jobs/paper", "jobs/taper_reamer_d6_t6"));
  stage.be("ready");
  openSection(panel);
  WAIT_FOR(shows(panel, "none of its operations is"));
  panel.openTab("Job");
  panel.chooseOperation("2 primary relief");
  openSection(panel);
  // The path is such that the clearance is the one asked.
  WAIT_FOR(shows(panel, " deg (10 ± 0.5)<br>Edge diameter "));
  EXPECT_FALSE(shows(panel, "Primary relief")) << "it ends on the land, until the secondary one is ground";
  panel.picture("section_primary");
  panel.openTab("Job");
  panel.chooseOperation("3 secondary relief");
  openSection(panel);
  // As wide as asked at the small end, and wider with the diameter.
  WAIT_FOR(shows(panel, "<br>Primary relief 0.32"));
  EXPECT_FALSE(shows(panel, kRed));
  panel.picture("section_secondary");
}

TEST_F(SectionOnStage, OfAnOperationOnTheEndIsItsEnd) {
  Panel panel("cell/stage", QString(kPaper).replace("test/jobs/paper", "jobs/end_mill_d10_t4"));
  stage.be("ready");
  const auto pixels = [&](const char* colour) {
    const QImage image = panel.the<QWidget>("section").grab().toImage();
    int count = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) count += image.pixelColor(x, y) == QColor(colour) ? 1 : 0;
    }
    return count;
  };
  const char *gash = "#8d9bb0", *secondary = "#b9c6d6", *chamfer = "#e0c978";
  const auto open = [&](const char* operation) {
    panel.openTab("Job");
    panel.chooseOperation(operation);
    openSection(panel);
  };
  open("1 flute");
  WAIT_FOR(panel.enabled("section_x") && shows(panel, "Rake "));
  open("4 gash");
  WAIT_FOR(shows(panel, "Gash rake 3.000 deg") && pixels(gash) > 100);
  EXPECT_FALSE(panel.enabled("section_x"));
  EXPECT_FALSE(panel.enabled("follow_wheel"));
  EXPECT_EQ(pixels(secondary), 0);
  open("7 chamfer");
  WAIT_FOR(shows(panel, "Chamfer width") && pixels(chamfer) > 0);
  EXPECT_GT(pixels(secondary), pixels(gash)) << "it took most of it";
  panel.picture("section_end");
}

TEST_F(SectionOnStage, LandsDifferAsThePitchesDo) {
  Panel panel("cell/stage", QString(kPaper).replace("test/jobs/paper", "jobs/unequal_d12_t4"));
  stage.be("ready", panel);
  openSection(panel);
  WAIT_FOR(shows(panel, "Land "));
  const std::vector<double> shown = numbers(panel);
  ASSERT_GE(shown.size(), 2U);
  const double radius = 6 + x(panel) * std::tan(5 * M_PI / 180);
  EXPECT_NEAR((shown.back() - shown.end()[-2]) / radius, (92 - 88) * M_PI / 180, 1e-3);
  panel.picture("section_of_a_tool");
}

TEST_F(SectionOnStage, WhatIsNotAsAskedIsRed) {
  struct Wrong {
    const char* picture;
    std::vector<std::pair<QByteArray, QByteArray>> changes;
    Names red;
  };
  for (const Wrong& wrong :
       // Wider than the pitch of eight teeth lets be; another swivel than the one that makes the rake.
       {Wrong{"section_without_land",
              {{"teeth: 1", "teeth: 8"}, {"width_mm: 3", "width_mm: 8"}},
              {"No land on tooth 1</span>"}},
        {"section_wrong_rake", {{"swivel_deg: 31.769", "swivel_deg: 20"}, {"teeth: 1", "teeth: 2"}}, {"Rake -"}},
        {"section_core_off",
         {{"core_diameter_mm: 7.1", "core_diameter_mm: 7.4"},
          {"spiral_tolerance_deg: 4", "spiral_tolerance_deg: 0.001"},
          {"chordal_rake_tolerance_deg: 6", "chordal_rake_tolerance_deg: 1"}},
         {"Core diameter 7.0", "Spiral angle ", "Chordal rake "}}}) {
    SCOPED_TRACE(wrong.picture);
    Panel panel("cell/stage", changedJob(kPaper, folder.filePath("job.yaml"), wrong.changes));
    openSection(panel);
    WAIT_FOR(x(panel) == 15);
    panel.the<QDoubleSpinBox>("section_x").setValue(0);
    for (const std::string& figure : wrong.red) WAIT_FOR(shows(panel, kRed + figure));
    panel.picture(wrong.picture);
  }
}

TEST_F(SectionOnStage, ItFollowsTheWheel) {
  Panel panel("cell/stage", kPaper);
  stage.change([&] { stage.state.progress.job_digest = digestOf(kPaper); });
  stage.be("running");
  standAt(0.012345);
  openSection(panel);
  WAIT_FOR(x(panel) == 15);  // the middle
  panel.tick("follow_wheel");
  WAIT_FOR(x(panel) == 12.35 || x(panel) == 12.34);
  EXPECT_FALSE(panel.enabled("section_x"));
  const double core = 7.1 + (12.4 - 7.1) * 12.345 / 30;  // that the job asks for
  WAIT_FOR(numbers(panel).size() == 8 && std::abs(numbers(panel)[5] - core) < 0.003);
  EXPECT_EQ(QString::fromStdString(panel.label("section_figures")).replace(kNumber, "#").toStdString(),
            "Rake # deg (8 ± #)<br>Chordal rake # deg (8 ± 6)<br>Spiral angle # deg (30 ± 4)<br>"
            "Core diameter # mm (# ± #)<br>Land # mm");
  const std::vector<double> shown = numbers(panel);
  EXPECT_NEAR(shown[4], core, 0.1);
  EXPECT_EQ(shown[6], 0.1);
  standAt(-0.05);
  WAIT_FOR(x(panel) == 0);
  standAt(0.2);
  WAIT_FOR(x(panel) == 30);
  stage.change([&] { stage.joints.position.clear(); });
  WAIT_FOR(shows(panel, "No position comes from the grinder."));
}

TEST_F(SectionOnStage, ItSaysWhatItCannotShow) {
  stage.leave(changedJob(kPaper, folder.filePath("published.yaml"), {{"spark_out: 0", "spark_out: 1"}}));
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
  panel.tick("follow_wheel");
  WAIT_FOR(shows(panel, "The grinder runs published.yaml (D 10 mm, cone 5 deg, spiral 30 deg, rake 8 deg, 1 tooth)"));
  EXPECT_TRUE(shows(panel, "not the chosen job"));
  EXPECT_FALSE(panel.isVisible("section"));
  panel.picture("section_of_another_job");
  EXPECT_EQ(hold(), place);
  panel.tick("follow_wheel");
  WAIT_FOR(shows(panel, "Rake "));
}

}  // namespace grinder::test_panel_section
