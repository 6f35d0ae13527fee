#include "flute_grinder/machine/offset_fit.h"

#include "flute_grinder/base/quantity.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/machine/swivel.h"

#include <array>
#include <cmath>

namespace grinder {

namespace {

constexpr const char* kWheel = "wheel";
constexpr double kSameFigure = 1e-9;  ///< tolerance below any measurement and above any rounding [m]

/// The values that a zero point depends on.
struct Dependence {
  bool on_job;  ///< any of the values: an offset set for no particular job does not fit
  bool end_diameter;
  bool height;
  bool wheel;
  bool placing;  ///< position of the wheel's middle off the swivel's axis: swivel and width
};

constexpr std::array<Dependence, kAxisCount> kDependences{{
    {false, false, false, true, true},    // X
    {true, true, false, true, false},     // Y
    {true, false, true, true, true},      // Z
    {false, false, false, false, false},  // A
}};

const Dependence& dependenceOf(int axis) { return kDependences[static_cast<std::size_t>(axis)]; }

bool isSame(double a, double b) { return std::abs(a - b) <= kSameFigure; }
bool isSameSwivel(const OffsetBasis& a, const OffsetBasis& b) { return Swivel{a.swivel}.isAt(b.swivel); }
bool isSameWheel(const OffsetBasis& a, const OffsetBasis& b) {
  return a.wheel_digest == b.wheel_digest && a.wheel_name == b.wheel_name;
}

std::string shown(double value, Unit unit) { return text(Quantity{value, unit}); }

std::string wheelText(const std::string& name, double diameter) {
  return (name.empty() ? "" : name + ", ") + "D " + shown(diameter, Unit::kMetre);
}

/// The values of a job that an axis depends on, as "D 6 mm, wheel a.yaml, D 100 mm".
/// @param other if not null, only the values that differ from it.
std::string figures(int axis, const OffsetBasis& basis, const OffsetBasis* other) {
  const Dependence& on = dependenceOf(axis);
  std::string list;
  const auto add = [&](bool depends, bool same, const std::string& figure) {
    if (depends && !(other && same)) list += (list.empty() ? "" : ", ") + figure;
  };
  const OffsetBasis& to = other ? *other : basis;
  const bool same_wheel = isSameWheel(basis, to);
  const std::string wheel = "wheel " + wheelText(basis);
  const bool looks_same = other && wheelText(basis) == wheelText(to);
  add(on.end_diameter, isSame(basis.end_diameter, to.end_diameter), "D " + shown(basis.end_diameter, Unit::kMetre));
  add(on.height, isSame(basis.height, to.height), "height " + shown(basis.height, Unit::kMetre));
  add(on.placing, isSameSwivel(basis, to), "swivel " + shown(basis.swivel, Unit::kRadian));
  add(on.wheel, same_wheel, looks_same ? "another " + wheel : wheel);
  add(on.placing, !same_wheel || isSame(basis.wheel_width, to.wheel_width),
      "width of the wheel " + shown(basis.wheel_width, Unit::kMetre));
  return list;
}

std::string ofJob(const OffsetBasis& basis) { return basis.job_name.empty() ? "" : " (" + basis.job_name + ")"; }

/// The change that makes an offset fit another job with the same wheel, mounting and swivel.
std::optional<double> changeFor(int axis, const OffsetBasis& was, const OffsetBasis& is) {
  const Dependence& on = dependenceOf(axis);
  if (!isSameWheel(was, is)) return std::nullopt;
  if (on.placing && !(isSameSwivel(was, is) && isSame(was.wheel_width, is.wheel_width))) return std::nullopt;
  double change = 0;
  if (on.end_diameter) change += (is.end_diameter - was.end_diameter) / 2;
  if (on.height) change += is.height - was.height;
  return change;
}

std::string nameOf(int axis) { return {axisLetter(axis)}; }

std::optional<OffsetMismatch> mismatch(int axis, const WorkOffsets& offsets, const OffsetBasis& job) {
  const Dependence& on = dependenceOf(axis);
  const WorkOffset& offset = offsets.axes[static_cast<std::size_t>(axis)];
  const OffsetBasis& was = offset.basis;
  const std::string name = nameOf(axis);
  OffsetMismatch found{name, basisText(axis, offset), "touched off for this job", "", axis, {}};
  const auto refused = [&](const std::string& reason) {
    found.reason = name + reason;
    return found;
  };
  if (std::isnan(offset.value)) return refused(" cannot be read");
  const std::string set = " was " + found.set;
  if (!offset.wasSet() || was.method == OffsetMethod::kUnknown || (on.on_job && !was.hasJob())) return refused(set);
  if (offset.mounting != offsets.wheel.mounting) {
    found.asked = "touched off with this wheel";
    found.set = "before it was mounted";
    return refused(set + "; another wheel has been mounted since");
  }
  const std::string differs = was.hasJob() ? figures(axis, job, &was) : "";
  if (differs.empty()) return std::nullopt;
  found.asked = differs;
  found.set = rowOf(was.method).done + (" for " + figures(axis, was, &job)) + ofJob(was);
  found.change = changeFor(axis, was, job);
  return refused(set + "; this job has " + differs);
}

/// The mismatch of A with an operation after the flutes, or of an operation that is already ground.
std::optional<OffsetMismatch> mismatchOfTeeth(const WorkOffsets& offsets, const OffsetBasis& job) {
  const auto refused = [](const std::string& set, const std::string& asked, const std::string& reason) {
    return OffsetMismatch{"A", set, asked, "A: " + reason, kA, {}};
  };
  const ClampedTool& tool = offsets.tool;
  const bool same = !job.tool_digest.empty() && tool.digest == job.tool_digest;
  if (same && tool.isGround(job.kind)) {
    const std::string ground = std::string("operation ") + rowOf(job.kind).words + " is ground on this tool already";
    return refused(ground, "another blank", ground + "; if another blank is clamped, say so: grind reclamped");
  }
  if (job.kind == OperationKind::kFlute) return std::nullopt;
  if (!same) {
    const std::string is = tool.digest.empty() ? toolText(tool) : "A is as for " + toolText(tool);
    return refused(is, "A as the flutes were ground, or probed on a tooth",
                   "where the teeth of this tool are is not known: " + is + "; probe a tooth: grind probe tooth");
  }
  // After probing a tooth, it is unknown which operations are ground.
  const bool probed = offsets.axes[kA].basis.method == OffsetMethod::kProbe;
  if (tool.isGround(job.before) || probed) return std::nullopt;
  const std::string missing = std::string("operation ") + rowOf(job.before).words + " is not ground on this tool";
  return refused(missing, "ground", missing);
}

}  // namespace

std::string wheelText(const OffsetBasis& job) { return wheelText(job.wheel_name, job.wheel_diameter); }

std::string mountedText(const MountedWheel& wheel) {
  return wheel.isKnown() ? wheelText(wheel.name, wheel.diameter) : "not confirmed";
}

bool isMounted(const MountedWheel& wheel, const OffsetBasis& job) {
  return wheel.isKnown() && wheel.digest == job.wheel_digest && wheel.name == job.wheel_name;
}

std::string toolText(const ClampedTool& tool) {
  if (tool.digest.empty()) return rowOf(tool.unknown).reason;
  const std::string of = tool.job_name.empty() ? "another tool" : tool.job_name;
  std::string ground;
  for (const OperationRow& row : kOperationKinds) {
    if (tool.isGround(row.value)) ground += (ground.empty() ? "" : ", ") + std::string(row.words);
  }
  return of + (ground.empty() ? "" : " with " + ground);
}

std::vector<OffsetMismatch> mismatches(const WorkOffsets& offsets, const OffsetBasis& job) {
  std::vector<OffsetMismatch> found;
  if (!isMounted(offsets.wheel, job)) {
    const std::string is = mountedText(offsets.wheel), asked = wheelText(job);
    found.push_back({kWheel, is, asked, "the wheel on the spindle is " + is + "; this job has " + asked, 0, {}});
  }
  for (const int axis : {kX, kY, kZ}) {
    if (auto one = mismatch(axis, offsets, job)) found.push_back(std::move(*one));
  }
  if (auto teeth = mismatchOfTeeth(offsets, job)) found.push_back(std::move(*teeth));
  return found;
}

std::string correctionRefusal(const WorkOffsets& offsets, int axis, const OffsetBasis& job) {
  const auto found = mismatch(axis, offsets, job);
  return found ? found->reason + ": it cannot be corrected; touch it off" : "";
}

std::vector<Need> needsOf(const std::vector<OffsetMismatch>& mismatches) {
  Need wheel{NeedKind::kWheel, "", {}, {NeedAnswer::kConfirmWheel}};
  Need offsets{NeedKind::kOffsets, "", {}, {}};
  for (const OffsetMismatch& mismatch : mismatches) {
    Need& need = mismatch.what == kWheel ? wheel : offsets;
    need.text += (need.text.empty() ? "" : "; ") + mismatch.reason;
    const std::string difference = mismatch.change ? shown(*mismatch.change, Unit::kMetre) : "";
    need.figures.push_back({mismatch.what, mismatch.asked, mismatch.set, difference});
    if (mismatch.change) offsets.answers = {NeedAnswer::kFitOffsets};
  }
  offsets.answers.push_back(NeedAnswer::kIgnoreOffsets);
  std::vector<Need> needs;
  for (Need& need : std::vector{std::move(wheel), std::move(offsets)}) {
    if (!need.figures.empty()) needs.push_back(std::move(need));
  }
  return needs;
}

std::string basisText(int axis, const WorkOffset& offset) {
  if (std::isnan(offset.value)) return "cannot be read";
  if (!offset.wasSet()) return "never set";
  const OffsetBasis& basis = offset.basis;
  const std::string done = rowOf(basis.method).done;
  if (!basis.hasJob()) {
    const bool needed = dependenceOf(axis).on_job || basis.method == OffsetMethod::kUnknown;
    return done + (needed ? ", not known for which job" : "");
  }
  const std::string all = figures(axis, basis, nullptr);
  return done + (all.empty() ? "" : " for " + all) + ofJob(basis);
}

}  // namespace grinder
