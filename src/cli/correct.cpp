#include "cli/correct.h"

#include "cli/history.h"
#include "cli/json_output.h"
#include "cli/machine_file.h"
#include "cli/offsets.h"
#include "cli/online.h"
#include "cli/waiting.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/client/latest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/record/correction.h"
#include "flute_grinder/tool/z_law.h"

#include <cstdio>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

using units::kMillimetre;

Turns mostOf(const CorrectOptions& options) {
  return mostTurns(readMachineFiles({options.parameters}, options.urdf).config.offset_change_limit);
}

double scaleOf(const FigureAt& at) { return shopScale(rowOf(at.figure).unit); }
const char* unitNameOf(const FigureAt& at) { return shopUnit(rowOf(at.figure).unit); }
double turned(const Turns& turns, SetupTurn turn) { return turns[indexOf(turn)] / shopScale(rowOf(turn).unit); }

Json toJson(const Turns& turns) {
  return {{"y_mm", turned(turns, SetupTurn::kY)},
          {"z_mm", turned(turns, SetupTurn::kZ)},
          {"swivel_deg", turned(turns, SetupTurn::kSwivel)}};
}

Json toJson(const CorrectedFigure& figure) {
  const double scale = scaleOf(figure.at);
  const std::string unit = std::string("_") + unitNameOf(figure.at);
  return {{"figure", toString(figure.at.figure)},     {"x_mm", figure.at.x / kMillimetre},
          {"asked" + unit, figure.asked / scale},     {"tolerance" + unit, figure.tolerance / scale},
          {"planned" + unit, figure.planned / scale}, {"now" + unit, figure.now / scale},
          {"after" + unit, figure.after / scale},     {"seen", figure.seen}};
}

Json toJson(const SetupFindings& found, const Correction& correction) {
  Json figures = Json::array();
  for (const CorrectedFigure& figure : correctedFigures(found.model, correction)) figures.push_back(toJson(figure));
  const Turns offset = found.last.offset + correction.turn;
  return {{"alarm", found.alarm},
          {"left_out", found.left_out},
          {"since", found.since},
          {"tools", found.tools},
          {"measured", found.measured},
          {"last", found.last.number},
          {"off", toJson(found.estimate.expected())},
          {"wear_mm", found.estimate.wear() / kMillimetre},
          {"figures", figures},
          {"in_dead_band", correction.in_dead_band},
          {"turn", toJson(correction.turn)},
          {"offsets", {{"y_mm", turned(offset, SetupTurn::kY)}, {"z_mm", turned(offset, SetupTurn::kZ)}}}};
}

void printFigures(const std::vector<CorrectedFigure>& figures) {
  std::printf("%-14s %8s %10s %10s %10s %10s %10s\n", "figure", "at X", "asked", "tolerance", "planned", "now",
              "after");
  for (const CorrectedFigure& figure : figures) {
    const double scale = scaleOf(figure.at);
    std::string values;
    for (const double value : {figure.asked, figure.tolerance, figure.planned, figure.now, figure.after}) {
      values += format(" %10s", fixed(value / scale, 4).c_str());
    }
    std::printf("%-14s %8.3f%s %s%s\n", toString(figure.at.figure), figure.at.x / kMillimetre, values.c_str(),
                unitNameOf(figure.at), figure.seen ? "" : "; tolerance too narrow for a gauge");
  }
}

void printTable(const SetupFindings& found, const Correction& correction, bool applies) {
  const Turns off = found.estimate.expected();
  std::printf("since tool %ju: %d ground, %d measured; zero points of tool %ju\n", std::uintmax_t{found.since},
              found.tools, found.measured, std::uintmax_t{found.last.number});
  std::printf("the set-up is off by Y %+.4f mm, Z %+.4f mm, swivel %+.3f deg; Y drifts by %+.4f mm a tool\n",
              turned(off, SetupTurn::kY), turned(off, SetupTurn::kZ), turned(off, SetupTurn::kSwivel),
              found.estimate.wear() / kMillimetre);
  printFigures(correctedFigures(found.model, correction));
  std::printf("%s\n", settingsText(found, correction).c_str());
  if (!applies && !correction.in_dead_band) std::printf("nothing is set yet: --apply sets the work offsets\n");
}

/// Sets the zero points as corrected. What is set does not depend on what was set of it before, so a command that was
/// interrupted can be given again. @return the exit status.
int apply(const std::string& node, const CorrectOptions& options, const SetupFindings& found,
          const Correction& correction) {
  ros::NodeHandle nh(node);
  const Latest<flute_grinder::WorkOffsets> offsets(nh, "offsets");
  if (!await(kPatience, [&] { return offsets.newest() != nullptr; })) return noGrinder(nh);
  const OffsetBasis basis = basisOf(goalFromFile(options.job, options.operation), OffsetMethod::kCorrection);
  const std::string refused = notCorrectable(found.last, fromMessage(*offsets.newest()), basis);
  if (!refused.empty()) return fail(refused);
  const OffsetValues values = offsetsOf(found.last.offset + correction.turn);
  if (const int status = setWorkOffsets(nh, values, basis, options.answers)) return status;
  if (options.json) return 0;
  const std::string by_hand = byHandText(correction);
  return succeed("the work offsets of Y and Z are set" + (by_hand.empty() ? "" : "; before the next tool, " + by_hand));
}

}  // namespace

int correct(const std::string& node, const CorrectOptions& options) {
  const GrindJob asked = readJobFile(options.job, options.operation);
  const SetupFindings found =
      findingsOf(withLaws(ValidJob(asked)), toolsOf(node, options.folder, asked), options.since);
  for (const std::string& tool : found.left_out) std::fprintf(stderr, "%s\n", tool.c_str());
  const Correction correction = found.correction(found.isKnown() ? mostOf(options) : Turns(Turns::Zero()));
  if (!found.isKnown() && !found.alarm) throw std::invalid_argument(settingsText(found, correction));
  if (options.json) print(toJson(found, correction));
  if (found.alarm) return fail(settingsText(found, correction));
  if (!options.json) printTable(found, correction, options.apply);
  return options.apply && !correction.in_dead_band ? apply(node, options, found, correction) : 0;
}

}  // namespace grinder
