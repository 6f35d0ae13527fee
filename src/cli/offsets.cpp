#include "cli/offsets.h"

#include "cli/answers.h"
#include "cli/json_output.h"
#include "cli/time_text.h"
#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/client/latest.h"
#include "flute_grinder/client/requests.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/setup/touch_off.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace grinder {

namespace {

/// The axis whose letter is first in a text; kAxisCount if there is none.
int axisOf(const std::string& text) {
  const std::size_t at = text.empty() ? std::string::npos : std::string(kAxisLetters).find(text[0]);
  return at == std::string::npos ? kAxisCount : static_cast<int>(at);
}

double toShop(int axis, double si) { return si / shopScale(unitOf(axis, 0)); }

/// Requires a job for Y and Z, whose zero points depend on it. @throw std::invalid_argument if there is none.
void requireJob(int axis, const std::string& job, const std::string& command) {
  if ((axis == kY || axis == kZ) && job.empty()) {
    throw std::invalid_argument(command +
                                " needs --job JOB: where Y and Z are 0 depends on its diameter, height and wheel");
  }
}

/// The basis of an offset. @param options options with a job file, or without one for no particular job.
/// @throw FileError
template <typename Options>
OffsetBasis basisFor(const Options& options, OffsetMethod method) {
  if (!options.job.empty()) return basisOf(goalFromFile(options.job, options.operation), method);
  OffsetBasis basis;
  basis.method = method;
  return basis;
}

/// @param node resolved name.
Json toJson(const std::string& node, const flute_grinder::WorkOffsets& offsets,
            const flute_grinder::GrinderState& state) {
  Json axes = Json::object();
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const std::string unit = std::string("_") + shopUnit(unitOf(axis, 0));
    const auto time = [](const ros::Time& at) {
      return at.isZero() ? Json(nullptr) : Json(timeText(at.toSec(), true));
    };
    axes[std::string(1, kAxisLetters[i])] = {
        {"offset" + unit, toShop(axis, offsets.values[i])},
        {"machine" + unit, toShop(axis, state.position[i])},
        {"work" + unit, toShop(axis, state.work_position[i])},
        {"set_by", offsets.set_at[i].isZero() ? Json(nullptr) : Json(offsets.set_by[i])},
        {"set_at", time(offsets.set_at[i])},
        {"found_at", time(offsets.found_at[i])},
        {"set_for", grinder::toJson(fromMessage(offsets.basis[i]))}};
  }
  const WorkOffsets all = fromMessage(offsets);
  const Json diameter = all.wheel.isKnown() ? Json(toShop(kY, all.wheel.diameter)) : Json(nullptr);
  return {{"grinder", node},
          {"homed", state.homed != 0},
          {"axes", axes},
          {"wheel", {{"name", all.wheel.name}, {"digest", all.wheel.digest}, {"diameter_mm", diameter}}},
          {"tool", {{"digest", all.tool.digest}, {"text", toolText(all.tool)}}},
          {"error", offsets.error}};
}

/// @param node resolved name.
void printTable(const std::string& node, const flute_grinder::WorkOffsets& offsets,
                const flute_grinder::GrinderState& state) {
  const WorkOffsets all = fromMessage(offsets);
  std::printf("work offsets of %s\n", node.c_str());
  std::printf("axis  %12s  %12s  %12s\n", "offset", "machine", "work");
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const auto column = [&](double si) { return format("  %12s", fixed(toShop(axis, si), 4).c_str()); };
    std::printf("%c   %s%s%s %-4s", axisLetter(axis), column(offsets.values[i]).c_str(),
                column(state.position[i]).c_str(), column(state.work_position[i]).c_str(), shopUnit(unitOf(axis, 0)));
    const std::string basis = escaped(basisText(axis, all.axes[i]));
    if (offsets.set_at[i].isZero()) {
      std::printf("  %s\n", basis.c_str());
    } else {
      std::printf("  set by %s, %s; %s\n", escaped(offsets.set_by[i]).c_str(),
                  timeText(offsets.set_at[i].toSec(), false).c_str(), basis.c_str());
    }
  }
  std::printf("wheel on the spindle: %s\n", escaped(mountedText(all.wheel)).c_str());
  std::printf("tool in the collet: %s\n", escaped(toolText(all.tool)).c_str());
  if (!state.homed) std::printf("the axes are not homed: their positions mean nothing yet\n");
  if (!offsets.error.empty()) std::printf("%s\n", escaped(offsets.error).c_str());
}

/// Whether a state was computed with these offsets, and not before their last change.
bool agree(const flute_grinder::GrinderState& state, const flute_grinder::WorkOffsets& offsets) {
  for (std::size_t i = 0; i < offsets.values.size(); ++i) {
    // The same arithmetic as in the grinder; NaN, for an axis without a position, passes.
    if (std::abs(state.position[i] - offsets.values[i] - state.work_position[i]) > 0) return false;
  }
  return true;
}

/// Waits for a state computed with the present work offsets. @return the exit status.
int awaitAgreement(ros::NodeHandle& nh, const States& states, const Latest<flute_grinder::WorkOffsets>& offsets) {
  if (!await(kPatience, [&] { return states.newest() && offsets.newest(); })) return noGrinder(nh);
  if (!await(kPatience, [&] { return agree(*states.newest(), *offsets.newest()); })) return fail(kLinkLost);
  return 0;
}

int show(ros::NodeHandle& nh, bool json) {
  const States states(nh, "state");
  const Latest<flute_grinder::WorkOffsets> offsets(nh, "offsets");
  if (const int status = awaitAgreement(nh, states, offsets)) return status;
  if (json) {
    print(toJson(nh.getNamespace(), *offsets.newest(), *states.newest()));
  } else {
    printTable(nh.getNamespace(), *offsets.newest(), *states.newest());
  }
  return 0;
}

}  // namespace

int confirmWheel(const std::string& node, const ConfirmWheelOptions& options) {
  const OffsetBasis job = basisOf(goalFromFile(options.job, options.operation), OffsetMethod::kUnknown);
  ros::NodeHandle nh(node);
  const int status = call<flute_grinder::ConfirmWheel>(nh, "confirm_wheel", wheelRequest(job, options.again));
  return status != 0 ? status : succeed("the wheel on the spindle is " + wheelText(job));
}

int sayReclamped(const std::string& node) {
  ros::NodeHandle nh(node);
  const int status = call<flute_grinder::Reclamped>(nh, "reclamped", reclampedRequest());
  return status != 0 ? status : succeed("a tool was clamped; where its teeth are is not known");
}

int setWorkOffsets(ros::NodeHandle& nh, const OffsetValues& values, const OffsetBasis& basis,
                   const std::vector<std::string>& answers) {
  auto request = offsetsRequest(values, basis, answers);
  return callAnswering<flute_grinder::SetOffsets>(nh, "set_offsets", request) ? 0 : 1;
}

std::string offsetRefusal(const std::string& argument) {
  const std::string allowed = "; allowed: AXIS=VALUE, as y=45.2, the axis x, y, z or a, the value in mm or deg";
  if (axisOf(argument) == kAxisCount || argument.size() < 3 || argument[1] != '=') return argument + allowed;
  char* end = nullptr;
  const double value = parseNumber(argument.c_str() + 2, &end);
  return *end == '\0' && std::isfinite(value) ? "" : argument + allowed;
}

int runOffsets(const std::string& node, const OffsetsOptions& options) {
  for (const std::string& argument : options.set) requireJob(axisOf(argument), options.job, "--set " + argument);
  const OffsetBasis basis = basisFor(options, OffsetMethod::kByHand);
  ros::NodeHandle nh(node);
  OffsetValues values;
  for (const std::string& argument : options.set) {
    const int axis = axisOf(argument);
    const double value = parseNumber(argument.c_str() + 2) * shopScale(unitOf(axis, 0));
    if (!values.emplace(axis, value).second) {
      throw std::invalid_argument("--set names " + axisName(axis) + " twice; allowed: each axis once");
    }
  }
  if (!values.empty()) {
    if (const int status = setWorkOffsets(nh, values, basis, options.answers)) return status;
  }
  return show(nh, options.json);
}

int runTouchOff(const std::string& node, const TouchOffOptions& options) {
  const int axis = axisOf(options.axis);
  requireJob(axis, options.job, "touch-off " + options.axis);
  if (axis == kY && !options.at) {
    throw std::invalid_argument("touch-off y needs --at DIAMETER, of the blank that the wheel touches");
  }
  auto request = touchOffRequest(axis, options.at.value_or(0) * shopScale(unitOf(axis, 0)),
                                 basisFor(options, OffsetMethod::kTouchOff), options.answers);
  ros::NodeHandle nh(node);
  if (axis == kY) {
    const GrindJob job = readJobFile(options.job, options.operation);
    const States states(nh, "state");
    const Latest<flute_grinder::WorkOffsets> offsets(nh, "offsets");
    if (const int status = awaitAgreement(nh, states, offsets)) return status;
    const std::string refused = heightRefusal(job, states.newest()->work_position[kZ]);
    if (!refused.empty()) return fail(refused);
    request.position = touchY(job, request.position);
  }
  const auto response = callAnswering<flute_grinder::TouchOff>(nh, "touch_off", request);
  if (!response) return 1;
  const auto shown = [&](double si) { return text(Quantity{si, unitOf(axis, 0)}, 9); };
  std::printf("%s: work offset %s; it is at %s of the work\n", axisName(axis).c_str(), shown(response->value).c_str(),
              shown(request.position).c_str());
  return 0;
}

}  // namespace grinder
