#include "flute_grinder/record/correction.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/machine/offset_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

constexpr double kMostSwivel = units::kDegree;

/// The judged figures, and all that were measured and are asked.
std::vector<FigureAt> figuresToWeigh(const ValidJob& job, const std::vector<MeasuredTool>& tools) {
  std::vector<FigureAt> all = judgedFigures(*job);
  for (const MeasuredTool& tool : tools) {
    for (const MeasuredFigure& one : tool.figures) {
      const auto is_this = [&](const FigureAt& at) { return tool.find(at) == &one; };
      const bool known = std::any_of(all.begin(), all.end(), is_this);
      if (!known && askedAt(job, one.figure, one.x)) all.push_back({one.figure, one.x});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const FigureAt& a, const FigureAt& b) {
    return std::pair(a.figure, a.x) < std::pair(b.figure, b.x);
  });
  return all;
}

/// The measured figures in the order of a model; NaN for the others.
Eigen::VectorXd valuesOf(const MeasuredTool& tool, const FigureModel& model) {
  Eigen::VectorXd values = Eigen::VectorXd::Constant(model.planned.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t i = 0; i < model.figures.size(); ++i) {
    const MeasuredFigure* measured = tool.find(model.figures[i]);
    if (measured != nullptr) values[static_cast<Eigen::Index>(i)] = measured->value;
  }
  return values;
}

std::string surpriseText(const MeasuredTool& tool, const Surprise& surprise, const FigureModel& model) {
  const FigureAt& at = model.figures[static_cast<std::size_t>(surprise.figure)];
  const Unit unit = rowOf(at.figure).unit;
  return "tool " + std::to_string(tool.number) + ": " + text(at) + " = " +
         text(Quantity{valuesOf(tool, model)[surprise.figure], unit}) +
         "; allowed: " + text({surprise.allowed.from, unit}, {surprise.allowed.to, unit}) +
         ", by what is known of the set-up";
}

}  // namespace

Turns mostTurns(const Axes& offset_change_limit) {
  Turns most = Turns::Zero();
  for (const CorrectedAxis& one : kCorrectedAxes) most[indexOf(one.turn)] = offset_change_limit[one.axis];
  most[indexOf(SetupTurn::kSwivel)] = kMostSwivel;
  return most;
}

SetupFindings findingsOf(const ValidJob& job, std::vector<ToolNumber> tools, std::uint64_t since) {
  if (!isCorrectable(job->process().kind)) {
    throw std::invalid_argument(
        "operation = " + std::string(toString(job->process().kind)) +
        "; allowed: flute, primary, secondary, whose set-ups can be corrected by measured tools");
  }
  const auto before = [&](const ToolNumber& tool) { return tool.number < since; };
  const std::uint64_t newest = toolOf(tools, 0).number;
  if (newest < since) {
    throw std::invalid_argument("--since " + std::to_string(since) + "; allowed: up to " + std::to_string(newest) +
                                ", the last tool");
  }
  tools.erase(std::remove_if(tools.begin(), tools.end(), before), tools.end());
  const std::vector<MeasuredTool> measured = measuredTools(tools);

  SetupFindings found;
  found.model = figureModel(job, figuresToWeigh(job, measured));
  Eigen::VectorXd gauge(found.model.planned.size());
  for (Eigen::Index i = 0; i < gauge.size(); ++i) {
    gauge[i] = gaugeSpread(found.model.figures[static_cast<std::size_t>(i)].figure);
  }
  for (const MeasuredTool& tool : measured) {
    if (found.tools > 0 && !haveSameZeros(found.last, tool)) {
      found.estimate = SetupEstimate(usualSpread());
      found.tools = found.measured = 0, found.alarm = false, found.left_out.clear();
    }
    if (found.tools++ == 0) {
      found.since = tool.number;
    } else {
      found.estimate.turn(tool.offset - found.last.offset);
    }
    found.last = tool;
    found.estimate.nextTool();
    const Eigen::VectorXd values = valuesOf(tool, found.model);
    if (values.array().isNaN().all()) continue;
    const auto surprise = found.estimate.take(found.model, values, gauge);
    found.alarm = surprise.has_value();
    if (surprise) found.left_out.push_back(surpriseText(tool, *surprise, found.model));
    if (!surprise) ++found.measured;
  }
  return found;
}

std::string byHandText(const Correction& correction) {
  if (!correction.by_swivel) return "";
  return "turn the swivel by " + format("%+.3f", correction.turn[indexOf(SetupTurn::kSwivel)] / units::kDegree) +
         " deg, at its scale or stop, and confirm the job's angle again";
}

std::string settingsText(const SetupFindings& found, const Correction& correction) {
  if (found.alarm) {
    return "no correction: measure the tool again and enter it anew; if the machine has changed, find out why, and use "
           "'grind correct --since' with the next tool";
  }
  if (!found.isKnown()) return "no tool has been measured since its zero points were found; measure one first";
  if (correction.in_dead_band) return "nothing to set: no figure would change by 0.15 of its tolerance";
  std::string lines;
  for (const CorrectedAxis& one : kCorrectedAxes) {
    const double by = correction.turn[indexOf(one.turn)], to = found.last.offset[indexOf(one.turn)] + by;
    if (!lines.empty()) lines += "\n";
    lines += std::string("work offset of ") + axisLetter(one.axis) + ": " + format("%+.4f", by / units::kMillimetre) +
             " mm, to " + format("%.4f", to / units::kMillimetre) + " mm";
  }
  return correction.by_swivel ? lines + "\n" + byHandText(correction) + "; then use 'grind correct --since'" : lines;
}

OffsetValues offsetsOf(const Turns& offset) {
  OffsetValues values;
  for (const CorrectedAxis& one : kCorrectedAxes) values[one.axis] = offset[indexOf(one.turn)];
  return values;
}

std::string notCorrectable(const MeasuredTool& last, const WorkOffsets& offsets, const OffsetBasis& job) {
  for (std::size_t i = 0; i < kCorrectedAxes.size(); ++i) {
    const WorkOffset& now = offsets.axes[static_cast<std::size_t>(kCorrectedAxes[i].axis)];
    const std::string refused = correctionRefusal(offsets, kCorrectedAxes[i].axis, job);
    if (!refused.empty()) return refused;
    if (isSameTime(last.found_at[i], now.found_at)) continue;
    return std::string("the zero point of ") + axisLetter(kCorrectedAxes[i].axis) + " is not the one of tool " +
           std::to_string(last.number) + ", the last one ground: grind and measure a tool with it first";
  }
  return "";
}

}  // namespace grinder
