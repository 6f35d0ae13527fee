#include "panel/cutter_section.h"

#include "flute_grinder/geometry/ground_job.h"
#include "panel/text_view.h"

#include <QStringList>

#include <algorithm>
#include <cmath>
#include <optional>

namespace grinder {

namespace {

using namespace units;

constexpr std::size_t kRings = 24;      ///< of a wall
constexpr std::size_t kColumns = 120;   ///< of all lands together
constexpr double kSameFigure = 0.5e-2;  ///< difference that two digits do not show

/// "8.02" or "7.98 to 8.02"; nothing without values.
std::optional<QString> rangeText(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  const QString from = QString::number(*min, 'f', 2), to = QString::number(*max, 'f', 2);
  return *max - *min < kSameFigure ? to : from + " to " + to;
}

QString line(const QString& text, bool good) {
  return good ? text : QString("<span style=\"color:%1\">%2</span>").arg(kWrong, text);
}

QString rakeLine(const CutterSection& section) {
  std::vector<double> rakes, chords;
  bool good = true, chords_good = true, complete = true;
  for (const ToothSection& tooth : section.ground.teeth) {
    if (tooth.rake) rakes.push_back(*tooth.rake / kDegree);
    if (tooth.chordal_rake) chords.push_back(*tooth.chordal_rake / kDegree);
    chords_good = chords_good && section.chordIsWithin(tooth);
    good = good && tooth.rake && section.rakeIsWithin(tooth);
    complete = complete && tooth.complete;
  }
  const CutterGeometry& c = section.job->cutter;
  const auto rake = rangeText(rakes);
  if (!rake) return line("No flute is ground here", false);
  return line(QString("Rake %1 deg, asked %2 to %3 deg")
                  .arg(*rake)
                  .arg((c.rake_angle - c.rake_tolerance) / kDegree, 0, 'f', 2)
                  .arg((c.rake_angle + c.rake_tolerance) / kDegree, 0, 'f', 2),
              good) +
         (chords.empty() ? "" : line(", chordal " + *rangeText(chords) + " deg", chords_good)) +
         line(complete ? "" : "; flute not complete", complete);
}

QString coreLine(const CutterSection& section) {
  const auto shown = [](double diameter) { return QString::number(diameter / kMillimetre, 'f', 3); };
  return line(section.outline.empty() ? "Core cut through" : "Core " + shown(2 * section.ground.core_radius) + " mm",
              section.coreIsWithin()) +
         QString(", asked %1 within %2 mm")
             .arg(shown(2 * section.asked_core))
             .arg(section.job->cutter.core_tolerance / kMillimetre);
}

QString spiralLine(const CutterSection& section) {
  std::vector<double> spirals, asked;
  bool good = true;
  for (std::size_t i = 0; i < section.ground.teeth.size(); ++i) {
    good = good && section.spiralIsWithin(i);
    asked.push_back(section.job.cutterOf(static_cast<int>(i)).spiral_angle / kDegree);
    if (section.ground.teeth[i].spiral) spirals.push_back(*section.ground.teeth[i].spiral / kDegree);
  }
  const auto spiral = rangeText(spirals);
  if (!spiral) return "";
  return line("Spiral " + *spiral + " deg", good) +
         QString(", asked %1 within %2 deg").arg(*rangeText(asked)).arg(section.job->cutter.spiral_tolerance / kDegree);
}

QString reliefLine(const CutterSection& section) {
  std::vector<double> clearances, widths, heels;
  bool good = true;
  for (const ToothSection& tooth : section.ground.teeth) {
    good = good && section.clearanceIsWithin(tooth);
    const ReliefSection relief = tooth.relief.value_or(ReliefSection{});
    if (relief.clearance) clearances.push_back(*relief.clearance / kDegree);
    if (relief.land) widths.push_back(*relief.land / kMillimetre);
    if (relief.heel) heels.push_back(*relief.heel / kMillimetre);
  }
  const CutterGeometry& c = section.job->cutter;
  const auto clearance = rangeText(clearances), width = rangeText(widths), heel = rangeText(heels);
  if (!clearance) return line("No relief is ground here", false);
  return line(QString("Clearance %1, asked %2 to %3 deg")
                  .arg(*clearance)
                  .arg((c.clearance - c.clearance_tolerance) / kDegree, 0, 'f', 2)
                  .arg((c.clearance + c.clearance_tolerance) / kDegree, 0, 'f', 2),
              good) +
         (width ? "<br>Primary relief " + *width + " mm" : "") + (width && heel ? ", heel at " + *heel + " mm" : "");
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

bool CutterSection::coreIsWithin() const {
  const double off = 2 * std::abs(ground.core_radius - asked_core);
  return !outline.empty() && off <= job->cutter.core_tolerance;
}

bool CutterSection::spiralIsWithin(std::size_t tooth) const {
  const ToothSection& measured = ground.teeth[tooth];
  if (!measured.complete || !measured.spiral) return true;
  return std::abs(*measured.spiral - job.cutterOf(static_cast<int>(tooth)).spiral_angle) <=
         job->cutter.spiral_tolerance;
}

bool CutterSection::rakeIsWithin(const ToothSection& tooth) const {
  return !tooth.rake || std::abs(*tooth.rake - job->cutter.rake_angle) <= job->cutter.rake_tolerance;
}

bool CutterSection::chordIsWithin(const ToothSection& tooth) const {
  if (!tooth.complete || !tooth.chordal_rake) return true;
  return std::abs(*tooth.chordal_rake - job->cutter.rake_angle) <= job->cutter.chordal_rake_tolerance;
}

bool CutterSection::clearanceIsWithin(const ToothSection& tooth) const {
  return tooth.relief && tooth.relief->clearance &&
         std::abs(*tooth.relief->clearance - job->cutter.clearance) <= job->cutter.clearance_tolerance;
}

bool CutterSection::hasLand(const ToothSection& tooth) const { return !tooth.flute || tooth.land; }

CutterSection cutterSection(const ValidJob& job, double x) {
  const GroundCutter cutter = groundCutterOf(job);
  CutterSection made{job, cutter.section(x)};
  made.asked_core = std::max(0.0, made.ground.radius - askedDepth(*job, x));
  const std::size_t teeth = job->tooth_angles.size();
  if (!(made.ground.core_radius >= kMinCore)) return made;
  made.outline = sectionOutline(cutter, x, made.ground.radius, {teeth, kRings, kColumns / teeth + 1});
  return made;
}

QString figuresText(const CutterSection& section) {
  // There is no room for all, and the flutes' are those of another operation.
  QStringList lines{rakeLine(section)};
  if (isRelief(section.job->process.kind)) {
    lines.prepend(reliefLine(section));
  } else {
    lines << coreLine(section) << spiralLine(section) << landLine(section);
  }
  lines.removeAll("");
  return lines.join("<br>");
}

}  // namespace grinder
