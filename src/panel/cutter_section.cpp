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
  for (std::size_t i = 0; i < section.ground.teeth.size(); ++i) {
    const ToothSection& tooth = section.ground.teeth[i];
    if (tooth.rake) rakes.push_back(*tooth.rake / kDegree);
    if (tooth.chordal_rake) chords.push_back(*tooth.chordal_rake / kDegree);
    chords_good = chords_good && section.isWithin(ToolFigure::kChordalRake, i);
    good = good && tooth.rake && section.isWithin(ToolFigure::kRake, i);
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
              section.isWithin(ToolFigure::kCoreDiameter)) +
         QString(", asked %1 within %2 mm")
             .arg(shown(2 * section.asked_core))
             .arg(section.job->cutter.core_tolerance / kMillimetre);
}

QString spiralLine(const CutterSection& section) {
  std::vector<double> spirals, asked;
  bool good = true;
  for (std::size_t i = 0; i < section.ground.teeth.size(); ++i) {
    good = good && section.isWithin(ToolFigure::kSpiral, i);
    asked.push_back(section.job.cutterOf(static_cast<int>(i)).spiral_angle / kDegree);
    if (section.ground.teeth[i].spiral) spirals.push_back(*section.ground.teeth[i].spiral / kDegree);
  }
  const auto spiral = rangeText(spirals);
  if (!spiral) return "";
  return line("Spiral " + *spiral + " deg", good) +
         QString(", asked %1 within %2 deg").arg(*rangeText(asked)).arg(section.job->cutter.spiral_tolerance / kDegree);
}

QString reliefLine(const CutterSection& section) {
  std::vector<double> clearances, seconds, widths, heels;
  bool good = true, second_good = true, width_good = true;
  for (std::size_t i = 0; i < section.ground.teeth.size(); ++i) {
    good = good && section.isWithin(ToolFigure::kClearance, i);
    second_good = second_good && section.isWithin(ToolFigure::kSecondClearance, i);
    width_good = width_good && section.isWithin(ToolFigure::kPrimary, i);
    const ReliefSection relief = section.ground.teeth[i].relief.value_or(ReliefSection{});
    if (relief.clearance) clearances.push_back(*relief.clearance / kDegree);
    if (relief.second_clearance) seconds.push_back(*relief.second_clearance / kDegree);
    if (relief.land) widths.push_back(*relief.land / kMillimetre);
    if (relief.heel) heels.push_back(*relief.heel / kMillimetre);
  }
  const CutterGeometry& c = section.job->cutter;
  const auto clearance = rangeText(clearances), second = rangeText(seconds);
  const auto width = rangeText(widths), heel = rangeText(heels);
  if (!clearance) return line("No relief is ground here", false);
  return line(QString("Clearance %1, asked %2 to %3 deg")
                  .arg(*clearance)
                  .arg((c.clearance - c.clearance_tolerance) / kDegree, 0, 'f', 2)
                  .arg((c.clearance + c.clearance_tolerance) / kDegree, 0, 'f', 2),
              good) +
         (second ? line(QString("<br>Second clearance %1, asked %2 deg").arg(*second).arg(c.second_clearance / kDegree),
                        second_good)
                 : "") +
         (width ? line("<br>Primary relief " + *width + " mm", width_good) : "") +
         (width && heel ? ", heel at " + *heel + " mm" : "");
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

bool CutterSection::isWithin(ToolFigure figure, std::size_t tooth) const {
  if (figure == ToolFigure::kCoreDiameter && outline.empty()) return false;
  const FigurePlace place{job, ground, tooth};
  if (isAsAsked(figure, place)) return true;
  return rowOf(figure).of_complete && (!place.tooth().complete || !measured(figure, place));
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
