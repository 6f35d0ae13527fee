#include "panel/cutter_section.h"

#include "flute_grinder/tool/ground_job.h"
#include "panel/text_view.h"

#include <QStringList>

#include <algorithm>

namespace grinder {

namespace {

using namespace units;

constexpr std::size_t kRings = 24;     ///< rings of a wall
constexpr std::size_t kColumns = 120;  ///< columns of all lands together

QString line(const QString& text, bool good) {
  return good ? text : QString("<span style=\"color:%1\">%2</span>").arg(kWrong, text);
}

QString figureLine(const GroundFigure& figure, bool good) {
  const ToolFigureRow& row = rowOf(figure.figure);
  QString text = row.words + QString(" ") + QString::fromStdString(groundText(figure));
  text[0] = text[0].toUpper();
  const QString asked = QString::fromStdString(askedText(figure));
  return line(text, good) +
         (asked.isEmpty() ? "" : QString(" (%1 ± %2)").arg(asked).arg(figure.tolerance / shopScale(row.unit)));
}

/// The figures of the end that an operation leaves.
QString figuresOfEnd(const ValidJob& job) {
  QStringList lines;
  for (const GroundFigure& figure : checkGroundCutter(job).figures) lines << figureLine(figure, isAsAsked(figure));
  return lines.join("<br>");
}

/// The faults of a section beyond its figures.
QStringList faults(const CutterSection& section) {
  const std::vector<ToothSection>& teeth = section.ground.teeth;
  const auto none = [&](const auto& has) { return std::none_of(teeth.begin(), teeth.end(), has); };
  QStringList said;
  if (isRelief(section.job->process().kind)) {
    if (none([](const auto& t) { return t.relief && t.relief->clearance; })) said << "No relief is ground here";
    return said;
  }
  if (none([](const auto& t) { return t.rake.has_value(); })) {
    said << "No flute is ground here";
  } else if (!std::all_of(teeth.begin(), teeth.end(), [](const auto& t) { return t.complete; })) {
    said << "Flute not complete";
  }
  const auto without = std::find_if(teeth.begin(), teeth.end(), [&](const auto& t) { return !section.hasLand(t); });
  if (without != teeth.end()) said << QString("No land on tooth %1").arg(without - teeth.begin() + 1);
  if (section.outline.empty()) said << "Core cut through";
  return said;
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
  if (job.isStraight()) {
    CutterSection made{job, {}};
    made.end = endView(cutter, endVolumesOf(job));
    return made;
  }
  CutterSection made{job, cutter.section(x)};
  made.asked_core = std::max(0.0, made.ground.radius - askedDepth(*job, x));
  const std::size_t teeth = job->tooth_angles.size();
  if (!(made.ground.core_radius >= kMinCore)) return made;
  made.outline = sectionOutline(cutter, x, made.ground.radius, {teeth, kRings, kColumns / teeth + 1});
  return made;
}

QString figuresText(const CutterSection& section) {
  if (section.job.isStraight()) return figuresOfEnd(section.job);
  const auto is_within = [&](ToolFigure figure) {
    for (std::size_t i = 0; i < section.ground.teeth.size(); ++i) {
      if (!section.isWithin(figure, i)) return false;
    }
    return true;
  };
  QStringList lines;
  for (const QString& fault : faults(section)) lines << line(fault, false);
  for (const GroundFigure& figure : figuresOf(section.job, {section.ground})) {
    // Only the figures of this operation: there is no room for all.
    if (rowOf(figure.figure).of == rowOf(section.job->process().kind).form) {
      lines << figureLine(figure, is_within(figure.figure));
    }
  }
  return lines.join("<br>");
}

}  // namespace grinder
