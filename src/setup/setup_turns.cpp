#include "flute_grinder/setup/setup_turns.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/tool/ground_job.h"

#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

namespace grinder {

namespace {

constexpr double kInset = 1.0 / 15;  ///< of the flute's length, from its ends to the first and last judged section

/// What the wheel removes in the deepest stroke of a tooth, with a set-up that is off.
WheelSweep sweepOffBy(const ValidJob& job, int tooth, const Turns& off) {
  const double wear = job.wearOfTeeth()[static_cast<std::size_t>(tooth)];
  GrindStroke stroke = strokeOf(job, tooth, job.deepest(), wear);
  stroke.y += off[indexOf(SetupTurn::kY)];
  stroke.y_per_x -= off[indexOf(SetupTurn::kEndDepth)] / job->cutter.flute_length;
  WheelSetup setup = setupOf(job, tooth);
  setup.height += off[indexOf(SetupTurn::kZ)];
  setup.swivel += off[indexOf(SetupTurn::kSwivel)];
  setup.x_shift += off[indexOf(SetupTurn::kShift)];
  return {ConicalCutter(job.strokeLaw(tooth).cutter), wheelOf(*job).worn(wear), job->process().wheel_diameter / 2,
          setup, stroke};
}

/// The first tooth, and of a relief the others too, ground with a set-up that is off.
GroundCutter cutterOffBy(const ValidJob& job, const Turns& off) {
  const double rake_depth = job->cutter.chordal_rake_depth;
  if (job->process().kind == OperationKind::kFlute) {
    return {ConicalCutter(job->cutter), {{sweepOffBy(job, 0, off)}}, {{0, 0}}, {}, rake_depth};
  }
  const GroundCutter before = groundBefore(job);
  std::vector<Reliefs> reliefs(before.flutes().size());
  for (std::size_t tooth = 0; tooth < before.teeth().size(); ++tooth) {
    Reliefs& own = reliefs[before.teeth()[tooth].flute];
    if (!own.empty()) continue;  // a tooth that shares the flute has added it
    own = before.reliefs(tooth);
    own.push_back({sweepOffBy(job, static_cast<int>(tooth), off)});
  }
  return {before.cutter(), before.flutes(), before.teeth(), std::move(reliefs), rake_depth};
}

/// The figures of an operation that depend on its own set-up alone.
std::vector<ToolFigure> ownFigures(OperationKind kind) {
  switch (kind) {
    case OperationKind::kFlute: return {ToolFigure::kRake, ToolFigure::kCoreDiameter};
    case OperationKind::kPrimaryRelief: return {ToolFigure::kClearance, ToolFigure::kEdgeDiameter};
    case OperationKind::kSecondaryRelief: return {ToolFigure::kSecondClearance, ToolFigure::kPrimary};
    default: return {};
  }
}

/// The slope of a figure from its values a step below, at, and a step above a turn; NaN if it has none.
double slopeOf(OperationKind kind, double below, double at, double above, double step) {
  if (kind == OperationKind::kFlute) return (above - below) / (2 * step);
  const double falling = (at - below) / step, rising = (above - at) / step;
  if (std::isnan(falling) || std::isnan(rising)) return std::isnan(falling) ? rising : falling;
  return std::abs(falling) > std::abs(rising) ? falling : rising;
}

/// Measures the sections of some figures, each once.
class Sections {
 public:
  explicit Sections(GroundCutter cutter) : cutter_(std::move(cutter)) {}

  const GroundSection& at(double x) {
    const auto found = sections_.find(x);
    if (found != sections_.end()) return found->second;
    GroundSection section = cutter_.section(x);
    // A stroke that ends a micrometre early still forms the face that is measured.
    for (ToothSection& tooth : section.teeth) tooth.complete = true;
    return sections_.emplace(x, std::move(section)).first->second;
  }

 private:
  GroundCutter cutter_;
  std::map<double, GroundSection> sections_;
};

}  // namespace

std::string text(const FigureAt& at) { return format("%s@%g", toString(at.figure), at.x / units::kMillimetre); }

bool isCorrectable(OperationKind kind) noexcept {
  return kind == OperationKind::kFlute || kind == OperationKind::kPrimaryRelief ||
         kind == OperationKind::kSecondaryRelief;
}

std::vector<FigureAt> judgedFigures(const GrindJob& job) {
  std::vector<FigureAt> figures;
  for (const ToolFigure figure : ownFigures(job.process().kind)) {
    for (const double part : {kInset, 0.5, 1 - kInset}) figures.push_back({figure, part * job.cutter.flute_length});
  }
  return figures;
}

Eigen::VectorXd figuresOffBy(const ValidJob& job, const std::vector<FigureAt>& figures, const Turns& off) {
  Sections sections(cutterOffBy(job, off));
  Eigen::VectorXd values(figures.size());
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const FigureValue value = measured(figures[i].figure, {job, sections.at(figures[i].x), 0});
    values[static_cast<Eigen::Index>(i)] = value.value_or(std::numeric_limits<double>::quiet_NaN());
  }
  return values;
}

FigureModel figureModel(const ValidJob& job, const std::vector<FigureAt>& figures) {
  const auto count = static_cast<Eigen::Index>(figures.size());
  FigureModel model{figures, figuresOffBy(job, figures, Turns::Zero()), Eigen::VectorXd(count), Eigen::VectorXd(count),
                    Eigen::Matrix<double, Eigen::Dynamic, kSetupTurnCount>(count, kSetupTurnCount)};
  for (const SetupTurnRow& row : kSetupTurns) {
    const Turns step = row.step * Turns::Unit(indexOf(row.value));
    const Eigen::VectorXd below = figuresOffBy(job, figures, -step), above = figuresOffBy(job, figures, step);
    for (Eigen::Index i = 0; i < count; ++i) {
      model.slope(i, indexOf(row.value)) = slopeOf(job->process().kind, below[i], model.planned[i], above[i], row.step);
    }
  }
  Sections sections(cutterOffBy(job, Turns::Zero()));
  for (Eigen::Index i = 0; i < count; ++i) {
    const FigureAt& at = figures[static_cast<std::size_t>(i)];
    const FigurePlace place{job, sections.at(at.x), 0};
    const FigureValue asks = asked(at.figure, place);
    if (!asks) throw std::invalid_argument(text(at) + " is not asked of this tool, so nothing can be set by it");
    model.asked[i] = *asks;
    model.tolerance[i] = tolerance(at.figure, place);
    if (!model.slope.row(i).allFinite() || !std::isfinite(model.planned[i])) {
      throw std::invalid_argument(text(at) + ": the planned tool has no such figure there");
    }
  }
  return model;
}

}  // namespace grinder
