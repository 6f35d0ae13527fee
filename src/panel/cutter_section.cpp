#include "panel/cutter_section.h"

#include "flute_grinder/geometry/ground_job.h"
#include "panel/text_view.h"

#include <QStringList>

#include <algorithm>
#include <cmath>
#include <optional>

namespace flute_grinder {

namespace {

using namespace units;

constexpr std::size_t kRings = 24;      ///< of a wall
constexpr std::size_t kColumns = 120;   ///< of all lands together
constexpr double kSameFigure = 0.5e-2;  ///< difference that two digits do not show

/// "8.02" or "7.98 to 8.02"; nothing without values.
std::optional<QString> rangeText(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  const QString from = QString::number(*least, 'f', 2), to = QString::number(*largest, 'f', 2);
  return *largest - *least < kSameFigure ? to : from + " to " + to;
}

QString line(const QString& text, bool good) {
  return good ? text : QString("<span style=\"color:%1\">%2</span>").arg(kWrong, text);
}

QString rakeLine(const CutterSection& section) {
  std::vector<double> rakes;
  bool good = true, complete = true;
  for (const ToothSection& tooth : section.ground.teeth) {
    if (tooth.rake) rakes.push_back(*tooth.rake / kDegree);
    good = good && tooth.rake && section.rakeIsWithin(tooth);
    complete = complete && tooth.complete;
  }
  const auto rake = rangeText(rakes);
  if (!rake) return line("No flute is ground here", false);
  return line(QString("Rake %1 deg, asked %2 to %3 deg")
                  .arg(*rake)
                  .arg((section.asked_rake - section.rake_tolerance) / kDegree, 0, 'f', 2)
                  .arg((section.asked_rake + section.rake_tolerance) / kDegree, 0, 'f', 2),
              good) +
         line(complete ? "" : "; flute not complete", complete);
}

QString coreLine(const CutterSection& section) {
  const bool whole = !section.outline.empty();
  return line(whole ? QString("Core %1 mm").arg(2 * section.ground.core_radius / kMillimetre, 0, 'f', 3)
                    : QString("Core cut through"),
              whole) +
         QString(", asked %1 mm").arg(2 * section.asked_core / kMillimetre, 0, 'f', 3);
}

QString landLine(const CutterSection& section) {
  const std::vector<ToothSection>& teeth = section.ground.teeth;
  const auto without = std::find_if(teeth.begin(), teeth.end(), [&](const auto& t) { return !section.hasLand(t); });
  if (without != teeth.end()) return line(QString("No land on tooth %1").arg(without - teeth.begin() + 1), false);
  std::vector<double> degrees, lengths;
  for (const ToothSection& tooth : teeth) {
    if (!tooth.land) continue;
    degrees.push_back(*tooth.land / kDegree);
    lengths.push_back(*tooth.land * section.ground.radius / kMillimetre);
  }
  const auto angle = rangeText(degrees), length = rangeText(lengths);
  return angle ? QString("Land %1 deg, %2 mm").arg(*angle, *length) : QString();
}

}  // namespace

bool CutterSection::rakeIsWithin(const ToothSection& tooth) const {
  return !tooth.rake || std::abs(*tooth.rake - asked_rake) <= rake_tolerance;
}

bool CutterSection::hasLand(const ToothSection& tooth) const { return !tooth.flute || tooth.land; }

CutterSection cutterSection(const GrindJob& job, double x) {
  const GroundCutter cutter = groundCutterOf(job);
  CutterSection made;
  made.ground = cutter.section(x);
  made.cut = job.cutter.cut;
  made.asked_rake = job.cutter.rake_angle;
  made.rake_tolerance = job.cutter.rake_tolerance;
  made.asked_core = std::max(0.0, made.ground.radius - askedDepth(job, x));
  if (!(made.ground.core_radius >= kMinCore)) return made;
  const std::size_t teeth = job.tooth_angles.size();
  made.outline = sectionOutline(cutter, x, made.ground.radius, {teeth, kRings, kColumns / teeth + 1});
  return made;
}

QString figuresText(const CutterSection& section) {
  return QStringList{rakeLine(section), coreLine(section), landLine(section)}.join("<br>");
}

}  // namespace flute_grinder
