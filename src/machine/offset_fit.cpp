#include "flute_grinder/machine/offset_fit.h"

#include "flute_grinder/job/quantity.h"
#include "flute_grinder/machine/swivel.h"

#include <array>
#include <cmath>

namespace grinder {

namespace {

constexpr double kSameFigure = 1e-9;  ///< below any measurement, above any rounding [m]

/// What a zero point depends on.
struct Dependence {
  bool on_job;  ///< at all: an offset that was set for no particular job does not fit
  bool end_diameter;
  bool height;
  bool wheel;
  bool placing;  ///< of the wheel's middle off the swivel's axis: swivel and width
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
  const bool other_file = !a.wheel_name.empty() && !b.wheel_name.empty() && a.wheel_name != b.wheel_name;
  return a.wheel_digest == b.wheel_digest && !other_file;
}

std::string shown(double value, Unit unit) { return text(Quantity{value, unit}); }

std::string wheelText(const OffsetBasis& basis) {
  return "wheel " + (basis.wheel_name.empty() ? "" : basis.wheel_name + ", ") + "D " +
         shown(basis.wheel_diameter, Unit::kMetre);
}

/// The figures of a job that an axis depends on, as "D 6 mm, wheel a.yaml, D 100 mm".
/// @param other only those that are not the same in it; null for all.
std::string figures(int axis, const OffsetBasis& basis, const OffsetBasis* other) {
  const Dependence& on = dependenceOf(axis);
  std::string list;
  const auto add = [&](bool depends, bool same, const std::string& figure) {
    if (depends && !(other && same)) list += (list.empty() ? "" : ", ") + figure;
  };
  const OffsetBasis& to = other ? *other : basis;
  const bool same_wheel = isSameWheel(basis, to);
  const bool looks_same = other && wheelText(basis) == wheelText(to);
  add(on.end_diameter, isSame(basis.end_diameter, to.end_diameter), "D " + shown(basis.end_diameter, Unit::kMetre));
  add(on.height, isSame(basis.height, to.height), "height " + shown(basis.height, Unit::kMetre));
  add(on.placing, isSameSwivel(basis, to), "swivel " + shown(basis.swivel, Unit::kRadian));
  add(on.wheel, same_wheel, (looks_same ? "another " : "") + wheelText(basis));
  add(on.placing, isSame(basis.wheel_width, to.wheel_width),
      "width of the wheel " + shown(basis.wheel_width, Unit::kMetre));
  return list;
}

std::string ofJob(const OffsetBasis& basis) { return basis.job_name.empty() ? "" : " (" + basis.job_name + ")"; }

/// What makes an offset fit another job of the same wheel, as it is mounted and swivelled.
std::optional<double> changeFor(int axis, const OffsetBasis& was, const OffsetBasis& is) {
  const Dependence& on = dependenceOf(axis);
  if (!isSameWheel(was, is)) return std::nullopt;
  if (on.placing && !(isSameSwivel(was, is) && isSame(was.wheel_width, is.wheel_width))) return std::nullopt;
  double change = 0;
  if (on.end_diameter) change += (is.end_diameter - was.end_diameter) / 2;
  if (on.height) change += is.height - was.height;
  return change;
}

std::optional<OffsetMismatch> mismatch(int axis, const WorkOffset& offset, const OffsetBasis& job) {
  const Dependence& on = dependenceOf(axis);
  const std::string name(1, "XYZA"[axis]);
  const OffsetBasis& was = offset.basis;
  if (!on.on_job && !on.wheel && !on.placing) return std::nullopt;
  if (std::isnan(offset.value)) return OffsetMismatch{axis, name + " cannot be read", {}};
  if (!offset.wasSet()) return OffsetMismatch{axis, name + " was never set", {}};
  if (was.method == OffsetMethod::kUnknown || (on.on_job && !was.hasJob())) {
    return OffsetMismatch{axis, name + " was " + basisText(axis, offset), {}};
  }
  const std::string differs = was.hasJob() ? figures(axis, job, &was) : "";
  if (differs.empty()) return std::nullopt;
  return OffsetMismatch{axis, name + " was " + basisText(axis, offset) + "; this job has " + differs,
                        changeFor(axis, was, job)};
}

}  // namespace

std::vector<OffsetMismatch> mismatches(const WorkOffsets& offsets, const OffsetBasis& job) {
  std::vector<OffsetMismatch> found;
  for (int axis = 0; axis < kAxisCount; ++axis) {
    auto one = mismatch(axis, offsets.axes[static_cast<std::size_t>(axis)], job);
    if (one) found.push_back(std::move(*one));
  }
  return found;
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
