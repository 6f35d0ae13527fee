#include "cli/setup.h"

#include "cli/json_output.h"
#include "cli/machine_file.h"
#include "cli/working.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/check/planned_job.h"
#include "flute_grinder/setup/setup_sheet.h"
#include "flute_grinder/setup/touch_off.h"
#include "flute_grinder/setup/write_setup.h"

#include <cstdio>

namespace grinder {

namespace {

using units::kDegree;
using units::kMillimetre;

Json placeOf(const Axes& at) { return {at[kX] / kMillimetre, at[kY] / kMillimetre, at[kZ] / kMillimetre}; }

/// Adds what only an operation on the end has.
void addStraight(const JobSetup& setup, Json& json) {
  const JobSetup::Straight& straight = *setup.straight;
  json["a_deg"] = straight.last.to[kA] / kDegree;
  json["from_mm"] = placeOf(straight.last.from);
  json["to_mm"] = placeOf(straight.last.to);
  json["travel_mm"] = placeOf(straight.travel);
  json["travel_a_deg"] = straight.travel[kA] / kDegree;
  json["passes"] = straight.passes;
  json["stock_mm"] = straight.stock / kMillimetre;
  json["past_axis_mm"] = straight.past_axis / kMillimetre;
  if (setup.job.process().kind == OperationKind::kGash) return;
  json["gap_mm"] = kEndGap / kMillimetre;
  json["touch_x_mm"] = touchX(setup.job, setup.job.cutter.end_diameter) / kMillimetre;
}

Json toJson(const JobSetup& setup, const std::optional<double>& above_swivel) {
  const GrindProcess& p = setup.job.process();
  const auto& complete = setup.check.complete;
  const TouchReadings touch = touchReadings(setup.job, above_swivel.value_or(0));
  Json json{{"swivel_deg", p.setup_swivel / kDegree},
            {"height_mm", p.setup_height / kMillimetre},
            {"x_shift_mm", p.setup_x_shift / kMillimetre},
            {"depth_mm", p.depth / kMillimetre},
            {"depth_end_mm", p.depthEnd() / kMillimetre},
            {"overtravel_mm", {setup.overtravel[0] / kMillimetre, setup.overtravel[1] / kMillimetre}},
            {"upper_face_mm", upperFaceHeight(setup.job) / kMillimetre},
            {"lower_face_mm", lowerFaceHeight(setup.job) / kMillimetre},
            {"touch_y_mm", touch.y / kMillimetre},
            {"touch_y_at_z_mm", touch.z_for_y / kMillimetre},
            {"touch_z_mm", touch.z / kMillimetre},
            {"wheel_above_swivel_mm", above_swivel ? Json(*above_swivel / kMillimetre) : Json(nullptr)},
            {"figures", grinder::toJson(setup.check.figures)},
            {"complete_from_mm", complete ? Json(complete->from / kMillimetre) : Json(nullptr)},
            {"complete_to_mm", complete ? Json(complete->to / kMillimetre) : Json(nullptr)},
            {"limit", toString(setup.limit)},
            {"margin", setup.margin}};
  if (!setup.relief && !setup.straight) return json;
  for (const char* key : {"x_shift_mm", "depth_mm", "depth_end_mm", "overtravel_mm", "limit", "margin"})
    json.erase(key);
  if (setup.straight) {
    for (const char* key : {"upper_face_mm", "lower_face_mm", "complete_from_mm", "complete_to_mm"}) json.erase(key);
    addStraight(setup, json);
    return json;
  }
  json["rim_mm"] = setup.relief->rim / kMillimetre;
  json["next_edge_deg"] = setup.relief->next_edge / kDegree;
  const auto& end = setup.relief->land_end_clearance;
  json["land_end_clearance_deg"] = end ? Json{end->from / kDegree, end->to / kDegree} : Json(nullptr);
  return json;
}

/// The plan's refusals of a job that grinds the tool as asked: its motion, and collisions.
std::string otherRefusals(const GrindJob& job, const MachineFiles& files) {
  const Machine& machine = files.config.loop.machine;
  const PlannedJob plan = planWholeJob(ValidJob(job), machine, MachineShapes(files.model), machine.park);
  std::string said;
  for (const Reason& reason : plan.reasons) said += "a plan of it is refused: " + text(reason) + "\n";
  return said;
}

auto solve(const JobToSetUp& asked, const Range& swivel) {
  const Working working("looking for the set-up");
  return solveJobSetup(asked.job, swivel, asked.wanted);
}

}  // namespace

int runSetup(const SetupOptions& options) {
  const JobToSetUp asked = readJobToSetUp(options.job, options.operation);
  if (options.write) requireSetupFile(asked);
  const MachineFiles files = readMachineFiles({options.parameters}, options.urdf);
  const LoopConfig& config = files.config.loop;
  const Range swivel = config.machine.swivel;
  const auto result = solve(asked, swivel);
  if (const auto* refusal = std::get_if<std::string>(&result)) {
    std::fprintf(stderr, "%s\n", refusal->c_str());
    return 1;
  }
  const auto& setup = std::get<JobSetup>(result);
  const std::optional<double> above_swivel = wheelAboveSwivel(asked.wheel, setup.job, config.geometry);
  if (options.json) {
    print(toJson(setup, above_swivel));
  } else {
    std::fputs(setupSheet(setup, swivel, above_swivel).c_str(), stdout);
  }
  const std::string refusal = planRefusal(setup);
  std::fputs(refusal.c_str(), stderr);
  if (!refusal.empty()) {
    if (options.write) std::fprintf(stderr, "%s: nothing was written\n", asked.setup_path.c_str());
    return 1;
  }
  if (options.write) writeSetup(asked, setup.job);
  std::fputs(otherRefusals(setup.job, files).c_str(), stderr);
  return 0;
}

}  // namespace grinder
