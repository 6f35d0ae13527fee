#include "cli/offsets.h"

#include "cli/call.h"
#include "cli/json_output.h"
#include "cli/offset_watch.h"
#include "cli/time_text.h"
#include "flute_grinder/ConfirmWheel.h"
#include "flute_grinder/Reclamped.h"
#include "flute_grinder/SetOffset.h"
#include "flute_grinder/TouchOff.h"
#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/quantity.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/offset_basis.h"
#include "flute_grinder/network/user_at_host.h"
#include "flute_grinder/setup/touch_off.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <iostream>
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

/// Asks at the terminal whether to make a large change; false without a terminal.
bool confirmed() {
  if (isatty(STDIN_FILENO) == 0) {
    std::fprintf(stderr, "--yes sets it all the same\n");
    return false;
  }
  std::fprintf(stderr, "Set it? [y/N] ");
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "Y";
}

/// Prints why an offset was not set. @param set_it_all_the_same carried out if the change was refused only because
/// it was large, and is confirmed. @return the exit status.
template <typename Response, typename Set>
int settle(const std::optional<Response>& response, const Set& set_it_all_the_same) {
  if (!response) return 1;
  if (response->success) return 0;
  const int status = fail(response->message);
  return response->large_change && confirmed() ? set_it_all_the_same() : status;
}

/// @param node resolved name.
Json toJson(const std::string& node, const flute_grinder::WorkOffsets& offsets,
            const flute_grinder::GrinderState& state) {
  Json axes = Json::object();
  for (int axis = 0; axis < kAxisCount; ++axis) {
    const auto i = static_cast<std::size_t>(axis);
    const std::string unit = axis == kA ? "_deg" : "_mm";
    const bool set = !offsets.set_at[i].isZero();
    axes[std::string(1, kAxisLetters[i])] = {
        {"offset" + unit, toShop(axis, offsets.values[i])},
        {"machine" + unit, toShop(axis, state.position[i])},
        {"work" + unit, toShop(axis, state.work_position[i])},
        {"set_by", set ? Json(offsets.set_by[i]) : Json(nullptr)},
        {"set_at", set ? Json(timeText(offsets.set_at[i].toSec(), true)) : Json(nullptr)},
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
    std::printf("%c     %12.4f  %12.4f  %12.4f %-4s", axisLetter(axis), toShop(axis, offsets.values[i]),
                toShop(axis, state.position[i]), toShop(axis, state.work_position[i]), axis == kA ? "deg" : "mm");
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
int awaitAgreement(ros::NodeHandle& nh, const StateWatch& watch, const OffsetWatch& offsets) {
  if (!await(kPatience, [&] { return watch.begun() && offsets.newest(); })) return noGrinder(nh);
  if (!await(kPatience, [&] { return agree(watch.newest(), *offsets.newest()); })) return fail(kLinkLost);
  return 0;
}

int show(ros::NodeHandle& nh, bool json) {
  const StateWatch watch(nh);
  const OffsetWatch offsets(nh);
  if (const int status = awaitAgreement(nh, watch, offsets)) return status;
  if (json) {
    print(toJson(nh.getNamespace(), *offsets.newest(), watch.newest()));
  } else {
    printTable(nh.getNamespace(), *offsets.newest(), watch.newest());
  }
  return 0;
}

/// Computes, from their bases, the offsets of Y and Z that do not fit a job, and sets either all of them or none.
/// @return the exit status; 1 if an offset must be set anew.
int fit(ros::NodeHandle& nh, const flute_grinder::GrindGoal& goal, bool large_change_ok) {
  const std::optional<flute_grinder::WorkOffsets> message = workOffsets(nh);
  if (!message) return noGrinder(nh);
  const WorkOffsets offsets = fromMessage(*message);
  const auto was = [&](int axis) -> const WorkOffset& { return offsets.axes[static_cast<std::size_t>(axis)]; };
  int status = 0;
  bool all = true;
  const std::vector<OffsetMismatch> found = mismatches(offsets, goal);
  for (const OffsetMismatch& mismatch : found) {
    const bool is_zero_point = mismatch.what != "wheel" && mismatch.what != "A";
    if (mismatch.change || !is_zero_point) continue;
    status = fail(mismatch.reason + "; set it anew");
    all = all && mismatch.axis == kX;
  }
  std::vector<int> set;
  for (const OffsetMismatch& mismatch : found) {
    if (!all || !mismatch.change) continue;
    const OffsetBasis basis = basisOf(goal, OffsetMethod::kComputed);
    if (const int refused =
            setWorkOffset(nh, mismatch.axis, was(mismatch.axis).value + *mismatch.change, basis, large_change_ok)) {
      for (const int axis : set) setWorkOffset(nh, axis, was(axis).value, was(axis).basis, true);
      return refused;
    }
    set.push_back(mismatch.axis);
  }
  return status;
}

}  // namespace

int confirmWheel(const std::string& node, const ConfirmWheelOptions& options) {
  const OffsetBasis job = basisOf(goalFromFile(options.job, options.operation), OffsetMethod::kUnknown);
  ros::NodeHandle nh(node);
  flute_grinder::ConfirmWheel::Request request;
  request.job = toMessage(job);
  request.again = static_cast<std::uint8_t>(options.again);
  request.set_by = userAtHost();
  const int status = call<flute_grinder::ConfirmWheel>(nh, "confirm_wheel", request);
  return status != 0 ? status : succeed("the wheel on the spindle is " + wheelText(job));
}

int sayReclamped(const std::string& node) {
  ros::NodeHandle nh(node);
  flute_grinder::Reclamped::Request request;
  request.set_by = userAtHost();
  const int status = call<flute_grinder::Reclamped>(nh, "reclamped", request);
  return status != 0 ? status : succeed("a tool was clamped; where its teeth are is not known");
}

int setWorkOffset(ros::NodeHandle& nh, int axis, double value, const OffsetBasis& basis, bool large_change_ok) {
  flute_grinder::SetOffset::Request request;
  request.axis = static_cast<std::uint8_t>(axis);
  request.value = value;
  request.set_by = userAtHost();
  request.basis = toMessage(basis);
  request.large_change_ok = static_cast<std::uint8_t>(large_change_ok);
  return settle(ask<flute_grinder::SetOffset>(nh, "set_offset", request),
                [&] { return setWorkOffset(nh, axis, value, basis, true); });
}

std::optional<flute_grinder::WorkOffsets> workOffsets(ros::NodeHandle& nh) {
  const OffsetWatch watch(nh);
  if (!await(kPatience, [&] { return watch.newest() != nullptr; })) return std::nullopt;
  return *watch.newest();
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
  for (const std::string& argument : options.set) {
    const int axis = axisOf(argument);
    const double value = parseNumber(argument.c_str() + 2) * shopScale(unitOf(axis, 0));
    if (const int status = setWorkOffset(nh, axis, value, basis, options.yes)) return status;
  }
  const int fitted = options.fit.empty() ? 0 : fit(nh, goalFromFile(options.fit, options.operation), options.yes);
  const int shown = show(nh, options.json);
  return fitted != 0 ? fitted : shown;
}

int runTouchOff(const std::string& node, const TouchOffOptions& options) {
  const int axis = axisOf(options.axis);
  requireJob(axis, options.job, "touch-off " + options.axis);
  if (axis == kY && !options.at) {
    throw std::invalid_argument("touch-off y needs --at DIAMETER, of the blank that the wheel touches");
  }
  flute_grinder::TouchOff::Request request;
  request.axis = static_cast<std::uint8_t>(axis);
  request.position = options.at.value_or(0) * shopScale(unitOf(axis, 0));
  request.set_by = userAtHost();
  const OffsetBasis basis = basisFor(options, OffsetMethod::kTouchOff);
  request.basis = toMessage(basis);
  request.large_change_ok = static_cast<std::uint8_t>(options.yes);
  ros::NodeHandle nh(node);
  if (axis == kY) {
    const GrindJob job = readJobFile(options.job, options.operation);
    const StateWatch watch(nh);
    const OffsetWatch offsets(nh);
    if (const int status = awaitAgreement(nh, watch, offsets)) return status;
    const std::string refused = heightRefusal(job, watch.newest().work_position[kZ]);
    if (!refused.empty()) return fail(refused);
    request.position = touchY(job, request.position);
  }
  const std::optional<flute_grinder::TouchOff::Response> response =
      ask<flute_grinder::TouchOff>(nh, "touch_off", request);
  // Sets the value that was confirmed, because the axis may have moved since.
  if (const int status = settle(response, [&] { return setWorkOffset(nh, axis, response->value, basis, true); })) {
    return status;
  }
  const auto shown = [&](double si) { return text(Quantity{si, unitOf(axis, 0)}, 9); };
  std::printf("%s: work offset %s; it is at %s of the work\n", axisName(axis).c_str(), shown(response->value).c_str(),
              shown(request.position).c_str());
  return 0;
}

}  // namespace grinder
