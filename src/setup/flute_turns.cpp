#include "flute_grinder/setup/flute_turns.h"

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

/// The flute of the first tooth, ground with a set-up that is off.
GroundCutter cutterOffBy(const ValidJob& job, const Turns& off) {
  const double wear = job.wearOfTeeth().front();
  GrindStroke stroke = strokeOf(job, 0, job.deepest(), wear);
  stroke.y += off[indexOf(SetupTurn::kY)];
  stroke.y_per_x -= off[indexOf(SetupTurn::kEndDepth)] / job->cutter.flute_length;
  WheelSetup setup = setupOf(job, 0);
  setup.height += off[indexOf(SetupTurn::kZ)];
  setup.swivel += off[indexOf(SetupTurn::kSwivel)];
  setup.x_shift += off[indexOf(SetupTurn::kShift)];
  const WheelSweep sweep(ConicalCutter(job.strokeLaw(0).cutter), wheelOf(*job).worn(wear),
                         job->process().wheel_diameter / 2, setup, stroke);
  return {ConicalCutter(job->cutter), {{sweep}}, {{0, 0}}, {}, job->cutter.chordal_rake_depth};
}

std::string nameOf(const FigureAt& at) { return format("%s@%g", toString(at.figure), at.x / units::kMillimetre); }

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

std::vector<FigureAt> judgedFigures(const CutterGeometry& cutter) {
  std::vector<FigureAt> figures;
  for (const ToolFigure figure : {ToolFigure::kRake, ToolFigure::kCoreDiameter}) {
    for (const double part : {kInset, 0.5, 1 - kInset}) figures.push_back({figure, part * cutter.flute_length});
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
    model.slope.col(indexOf(row.value)) =
        (figuresOffBy(job, figures, step) - figuresOffBy(job, figures, -step)) / (2 * row.step);
  }
  Sections sections(cutterOffBy(job, Turns::Zero()));
  for (Eigen::Index i = 0; i < count; ++i) {
    const FigureAt& at = figures[static_cast<std::size_t>(i)];
    const FigurePlace place{job, sections.at(at.x), 0};
    const FigureValue asks = asked(at.figure, place);
    if (!asks) throw std::invalid_argument(nameOf(at) + " is not asked of this tool, so nothing can be set by it");
    model.asked[i] = *asks;
    model.tolerance[i] = tolerance(at.figure, place);
    if (!model.slope.row(i).allFinite() || !std::isfinite(model.planned[i])) {
      throw std::invalid_argument(nameOf(at) + ": the planned tool has no such figure there");
    }
  }
  return model;
}

}  // namespace grinder
