#include "cli/correct.h"

#include "cli/history.h"
#include "cli/json_output.h"
#include "cli/machine_file.h"
#include "cli/online.h"
#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/motion/work_offsets.h"
#include "flute_grinder/record/measured.h"
#include "flute_grinder/setup/setup_estimate.h"
#include "flute_grinder/tool/z_law.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace grinder {

namespace {

using units::kDegree;
using units::kMillimetre;

constexpr std::size_t kMostTools = 100;  ///< how many tools are looked back on; older ones say nothing of today's wheel
constexpr double kMostSwivel = kDegree;  ///< largest correction of the swivel: more is another set-up

/// The axes whose zero points are corrected, with their turns.
struct CorrectedAxis {
  int axis;
  SetupTurn turn;
};
constexpr CorrectedAxis kAxes[] = {{kY, SetupTurn::kY}, {kZ, SetupTurn::kZ}};

/// What a record says of a tool.
struct MeasuredTool {
  std::uint64_t number = 0;
  Turns offset = Turns::Zero();       ///< work offsets of Y and Z [m]
  std::array<std::string, 2> set_at;  ///< when they were set; empty if never
  std::array<bool, 2> by_hand{};      ///< whether a person changed them by a figure
  std::vector<MeasuredFigure> figures;
};

MeasuredTool measuredTool(const ToolNumber& tool) {
  const Record record = readRecord(tool.path);
  try {
    MeasuredTool measured;
    measured.number = tool.number;
    for (std::size_t i = 0; i < std::size(kAxes); ++i) {
      const char letter = axisLetter(kAxes[i].axis) - 'A' + 'a';
      const Json& zero = record.body.at("zero_points").at(std::string(1, letter));
      const Json& offset = record.body.at("work_offsets").at(std::string(1, letter) + "_mm");
      measured.offset[indexOf(kAxes[i].turn)] = offset.get<double>() * kMillimetre;
      if (zero.at("set_at").is_string()) measured.set_at[i] = zero.at("set_at");
      measured.by_hand[i] = zero.at("set_for").at("method") == toString(OffsetMethod::kByHand);
    }
    measured.figures = measuredOf(record);
    return measured;
  } catch (const std::exception& error) {
    throw FileError(tool.path + ": " + error.what());
  }
}

/// Whether the zero points were found anew between two tools, by touching off or the like, so that what was known of
/// their errors does not count any longer.
bool isSetAnew(const MeasuredTool& before, const MeasuredTool& now) {
  for (std::size_t i = 0; i < std::size(kAxes); ++i) {
    if (before.set_at[i] != now.set_at[i] && !now.by_hand[i]) return true;
  }
  return false;
}

bool isAt(const FigureAt& at, const MeasuredFigure& measured) {
  return at.figure == measured.figure && std::abs(at.x - measured.x) < units::kMicrometre;
}

/// The judged figures, and all that were measured and are asked.
std::vector<FigureAt> figuresOf(const ValidJob& job, const std::vector<MeasuredTool>& tools) {
  std::vector<FigureAt> all = judgedFigures(job->cutter);
  for (const MeasuredTool& tool : tools) {
    for (const MeasuredFigure& one : tool.figures) {
      const bool known = std::any_of(all.begin(), all.end(), [&](const FigureAt& at) { return isAt(at, one); });
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
    for (const MeasuredFigure& one : tool.figures) {
      if (isAt(model.figures[i], one)) values[static_cast<Eigen::Index>(i)] = one.value;
    }
  }
  return values;
}

/// What the tools say together.
struct Findings {
  FigureModel model;
  SetupEstimate estimate{usualSpread()};
  std::uint64_t since = 0;            ///< the first tool that counts
  int tools = 0, measured = 0;        ///< tools that count; measured tools among them that were not left out
  MeasuredTool last;                  ///< the last tool
  std::vector<std::string> left_out;  ///< tools that are not believed, in words
  bool alarm = false;                 ///< whether the last measured tool is one of them
  Correction correction;
};

double scaleOf(const FigureAt& at) { return shopScale(rowOf(at.figure).unit); }
const char* unitOf(const FigureAt& at) { return rowOf(at.figure).unit == Unit::kRadian ? "deg" : "mm"; }

std::string text(const MeasuredTool& tool, const Surprise& surprise, const FigureModel& model) {
  const FigureAt& at = model.figures[static_cast<std::size_t>(surprise.figure)];
  const double scale = scaleOf(at), value = valuesOf(tool, model)[surprise.figure] / scale;
  return format("tool %ju: %s@%g = %.6g %s; allowed: %.4f to %.4f, by what is known of the set-up",
                std::uintmax_t{tool.number}, toString(at.figure), at.x / kMillimetre, value, unitOf(at),
                (surprise.expected - 4 * surprise.spread) / scale, (surprise.expected + 4 * surprise.spread) / scale);
}

/// Goes through the tools in the order of grinding.
Findings findingsOf(const ValidJob& job, const std::vector<MeasuredTool>& tools) {
  Findings found;
  found.model = figureModel(job, figuresOf(job, tools));
  Eigen::VectorXd gauge(found.model.planned.size());
  for (Eigen::Index i = 0; i < gauge.size(); ++i) {
    gauge[i] = gaugeSpread(found.model.figures[static_cast<std::size_t>(i)].figure);
  }
  for (const MeasuredTool& tool : tools) {
    if (found.tools > 0 && isSetAnew(found.last, tool)) {
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
    if (surprise) found.left_out.push_back(text(tool, *surprise, found.model));
    if (!surprise) ++found.measured;
  }
  return found;
}

Turns mostOf(const CorrectOptions& options) {
  const MachineConfig config = readMachineFiles({options.parameters}, options.urdf).config;
  Turns most = Turns::Zero();
  for (const CorrectedAxis& one : kAxes) most[indexOf(one.turn)] = config.offset_change_limit[one.axis];
  most[indexOf(SetupTurn::kSwivel)] = kMostSwivel;
  return most;
}

double turned(const Turns& turns, SetupTurn turn) { return turns[indexOf(turn)] / shopScale(rowOf(turn).unit); }

/// The figure of a row with the set-up as it is expected, and after the correction, in shop units.
struct ShownFigure {
  double asked, tolerance, planned, now, after;
};
ShownFigure shown(const Findings& found, std::size_t row) {
  const auto i = static_cast<Eigen::Index>(row);
  const FigureModel& model = found.model;
  const double scale = scaleOf(model.figures[row]), tolerance = model.tolerance[i];
  return {model.asked[i] / scale, tolerance / scale, model.planned[i] / scale,
          (model.planned[i] + found.correction.now[i] * tolerance) / scale,
          (model.planned[i] + found.correction.after[i] * tolerance) / scale};
}

Json toJson(const Turns& turns) {
  return {{"y_mm", turned(turns, SetupTurn::kY)},
          {"z_mm", turned(turns, SetupTurn::kZ)},
          {"swivel_deg", turned(turns, SetupTurn::kSwivel)}};
}

Json toJson(const Findings& found) {
  Json figures = Json::array();
  for (std::size_t i = 0; i < found.model.figures.size(); ++i) {
    const FigureAt& at = found.model.figures[i];
    const ShownFigure figure = shown(found, i);
    const std::string unit = std::string("_") + unitOf(at);
    figures.push_back({{"figure", toString(at.figure)},
                       {"x_mm", at.x / kMillimetre},
                       {"asked" + unit, figure.asked},
                       {"tolerance" + unit, figure.tolerance},
                       {"planned" + unit, figure.planned},
                       {"now" + unit, figure.now},
                       {"after" + unit, figure.after},
                       {"seen", isSeen(at.figure, found.model.tolerance[static_cast<Eigen::Index>(i)])}});
  }
  const Turns offset = found.last.offset + found.correction.turn;
  return {{"alarm", found.alarm},
          {"left_out", found.left_out},
          {"since", found.since},
          {"tools", found.tools},
          {"measured", found.measured},
          {"last", found.last.number},
          {"off", toJson(found.estimate.expected())},
          {"wear_mm", found.estimate.wear() / kMillimetre},
          {"figures", figures},
          {"in_dead_band", found.correction.in_dead_band},
          {"turn", toJson(found.correction.turn)},
          {"offsets", {{"y_mm", turned(offset, SetupTurn::kY)}, {"z_mm", turned(offset, SetupTurn::kZ)}}}};
}

void printFigures(const Findings& found) {
  std::printf("%-14s %8s %10s %10s %10s %10s %10s\n", "figure", "at X", "asked", "tolerance", "planned", "now",
              "after");
  for (std::size_t i = 0; i < found.model.figures.size(); ++i) {
    const FigureAt& at = found.model.figures[i];
    const ShownFigure figure = shown(found, i);
    std::printf("%-14s %8.3f %10.4f %10.4f %10.4f %10.4f %10.4f %s%s\n", toString(at.figure), at.x / kMillimetre,
                figure.asked, figure.tolerance, figure.planned, figure.now, figure.after, unitOf(at),
                isSeen(at.figure, found.model.tolerance[static_cast<Eigen::Index>(i)])
                    ? ""
                    : "; tolerance too narrow for a gauge");
  }
}

void printSettings(const Findings& found, const CorrectOptions& options) {
  if (found.correction.in_dead_band) {
    std::printf("nothing to set: no figure would change by 0.15 of its tolerance\n");
    return;
  }
  const std::string of =
      " --job " + options.job + (options.operation.empty() ? "" : " --operation " + options.operation);
  for (const CorrectedAxis& one : kAxes) {
    const double by = turned(found.correction.turn, one.turn), to = turned(found.last.offset, one.turn) + by;
    std::printf("%c by %+.4f mm: grind offsets --set %s=%.4f%s\n", axisLetter(one.axis), by, toString(one.turn), to,
                of.c_str());
  }
  if (!found.correction.by_swivel) return;
  std::printf("the swivel by %+.3f deg, at its scale or stop; then 'grind correct --since' with the next tool\n",
              turned(found.correction.turn, SetupTurn::kSwivel));
}

void printTable(const Findings& found, const CorrectOptions& options) {
  const Turns off = found.estimate.expected();
  std::printf("since tool %ju: %d ground, %d measured; zero points of tool %ju\n", std::uintmax_t{found.since},
              found.tools, found.measured, std::uintmax_t{found.last.number});
  std::printf("the set-up is off by Y %+.4f mm, Z %+.4f mm, swivel %+.3f deg; Y drifts by %+.4f mm a tool\n",
              turned(off, SetupTurn::kY), turned(off, SetupTurn::kZ), turned(off, SetupTurn::kSwivel),
              found.estimate.wear() / kMillimetre);
  printFigures(found);
  printSettings(found, options);
}

}  // namespace

int printCorrection(const std::string& node, const CorrectOptions& options) {
  const GrindJob asked = readJobFile(options.job, options.operation);
  if (asked.process().kind != OperationKind::kFlute) {
    throw std::invalid_argument("operation = " + std::string(toString(asked.process().kind)) +
                                "; allowed: flute, the only one whose set-up can be corrected by measured tools");
  }
  std::vector<ToolNumber> numbers = toolsOf(node, options.folder, asked);
  if (options.since > 0) {
    const auto before = [&](const ToolNumber& tool) { return tool.number < options.since; };
    numbers.erase(std::remove_if(numbers.begin(), numbers.end(), before), numbers.end());
  }
  if (numbers.size() > kMostTools) numbers.erase(numbers.begin(), numbers.end() - kMostTools);
  toolOf(numbers, 0);  // there is one
  std::vector<MeasuredTool> tools;
  for (const ToolNumber& tool : numbers) tools.push_back(measuredTool(tool));
  Findings found = findingsOf(withLaws(ValidJob(asked)), tools);
  for (const std::string& tool : found.left_out) std::fprintf(stderr, "%s\n", tool.c_str());
  if (found.measured == 0 && !found.alarm) {
    throw std::invalid_argument(
        "no tool has been measured since its zero points were found; run 'grind measured' first");
  }
  const Turns most = found.alarm ? Turns(Turns::Zero()) : mostOf(options);
  found.correction = correctionOf(found.model, found.estimate.expected(), most);
  if (options.json) print(toJson(found));
  if (found.alarm) {
    return fail(
        "no correction: measure the tool again and enter it with 'grind measured'; if the machine has changed, find "
        "out "
        "why, and use 'grind correct --since' with the next tool");
  }
  if (!options.json) printTable(found, options);
  return 0;
}

}  // namespace grinder
