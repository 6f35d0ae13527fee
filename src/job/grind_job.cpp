#include "flute_grinder/job/grind_job.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_fields.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace grinder {

namespace {

constexpr const char* kNoCenterTeeth = "0 without cutter.end.center_teeth";

/// Tolerance for the rounding of a unit conversion at the ends of a range.
constexpr double kRangeRounding = 1e-12;

/// Collects the errors in a job.
class Checker {
 public:
  void range(const JobField& f, double value) {
    const double min = f.low().si;
    const double max = f.high().si;
    if (!(value >= min - kRangeRounding * std::abs(min) && value <= max + kRangeRounding * std::abs(max))) {
      refuse(ReasonKind::kOutOfRange, f.path, {value, f.unit}, "", max, min);
    }
  }

  /// A count or choice must be from `min` to `max`.
  void whole(const char* path, int value, int max, int min = 0) {
    const Quantity count{static_cast<double>(value), Unit::kNone};
    if (!(value >= min && value <= max)) refuse(ReasonKind::kOutOfRange, path, count, "", max, min);
  }

  /// A length must be less than `limit`; `why` describes the limit.
  void below(const char* path, double value, double limit, const char* why) {
    if (!(value < limit)) refuse(ReasonKind::kNotBelow, path, {value, Unit::kMetre}, why, limit);
  }

  void refuse(ReasonKind kind, const char* path, const Quantity& value, const std::string& detail, double limit = 0,
              double low = 0) {
    reasons_.push_back({kind, 0, path, detail, value.unit, value.si, low, limit});
  }

  bool good() const { return reasons_.empty(); }
  std::vector<Reason> take() { return std::move(reasons_); }

 private:
  std::vector<Reason> reasons_;
};

void checkTeeth(Checker& checker, const std::vector<double>& angles) {
  checker.whole("cutter.teeth", static_cast<int>(angles.size()), kMaxTeeth, 1);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const bool good = i == 0 ? angles[i] == 0 : angles[i] > angles[i - 1] && angles[i] < 2 * units::kPi;
    if (good) continue;
    return checker.refuse(ReasonKind::kNotAllowed, "cutter.tooth_angles", {angles[i], Unit::kRadian},
                          "0 first, then ascending, below", 2 * units::kPi);
  }
}

void checkSpirals(Checker& checker, const GrindJob& job) {
  const std::vector<double>& angles = job.spiral_angles;
  if (angles.empty()) return;
  if (angles.size() != job.tooth_angles.size()) {
    return checker.refuse(ReasonKind::kNotAllowed, "cutter.spiral_angles",
                          {static_cast<double>(angles.size()), Unit::kNone},
                          "as many as teeth, " + std::to_string(job.tooth_angles.size()));
  }
  visitJobFields([&](JobField field, auto of) {
    if (std::string_view(field.path) != "cutter.spiral_angle") return;
    if (!(angles[0] == of(job))) {
      checker.refuse(ReasonKind::kNotAllowed, "cutter.spiral_angles", {angles[0], Unit::kRadian},
                     std::string("first ") + field.file_key + ",", of(job));
    }
    field.path = "cutter.spiral_angles";
    for (const double angle : angles) checker.range(field, angle);
  });
}

void checkWheelPoints(Checker& checker, const GrindJob& job) {
  constexpr double rounding = 1e-9;
  constexpr double min = 0.05e-3, max = 250e-3;
  const GrindProcess& p = job.process();
  const std::vector<ProfilePoint>& points = job.process().wheel_points;
  const char* const path = "process.wheel_points";
  if (p.wheel_profile != WheelShape::kPoints) {
    if (!points.empty()) checker.whole(path, static_cast<int>(points.size()), 0);
    return;
  }
  checker.whole(path, static_cast<int>(points.size()), kMaxWheelPoints, 2);
  if (!checker.good()) return;
  double radius = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(points[i].radius >= min && points[i].radius <= max)) {
      checker.refuse(ReasonKind::kOutOfRange, path, {points[i].radius, Unit::kMetre}, "", max, min);
    }
    if (!(std::abs(points[i].w) <= max && (i == 0 || points[i].w > points[i - 1].w))) {
      checker.refuse(ReasonKind::kNotAllowed, path, {points[i].w, Unit::kMetre}, "places along the spindle, ascending");
    }
    radius = std::max(radius, points[i].radius);
  }
  if (!(std::abs(points.front().w + points.back().w) <= rounding)) {
    checker.refuse(ReasonKind::kNotAllowed, path, {points.front().w, Unit::kMetre}, "the middle of the width at 0, so",
                   -points.back().w);
  }
  if (!(std::abs(2 * radius - p.wheel_diameter) <= rounding)) {
    checker.refuse(ReasonKind::kNotAllowed, "process.wheel_diameter", {p.wheel_diameter, Unit::kMetre},
                   "that of its points,", 2 * radius);
  }
  if (!(std::abs(points.back().w - points.front().w - p.wheel_width) <= rounding)) {
    checker.refuse(ReasonKind::kNotAllowed, "process.wheel_width", {p.wheel_width, Unit::kMetre}, "that of its points,",
                   points.back().w - points.front().w);
  }
}

/// Checks the wear, the angle and the corner radii against the wheel's shape.
void checkWheel(Checker& checker, const GrindProcess& p) {
  const bool tapered = isTapered(p.wheel_profile), is_cup = p.wheel_profile == WheelShape::kCup;
  if (!is_cup && tapered != (p.wheel_angle > 0)) {
    checker.refuse(ReasonKind::kNotAllowed, "process.wheel_angle", {p.wheel_angle, Unit::kRadian},
                   tapered ? "more than 0 for this profile" : "0 for this profile");
  }
  checker.below("process.wheel_wear", p.wheel_wear, p.wheel_diameter / 2, "the wheel's radius");
  if (is_cup) {
    checker.below("process.wheel_rim", p.wheel_rim, p.wheel_diameter / 2 - p.wheel_wear, "what is left of its radius");
  } else if (p.wheel_rim != 0) {
    checker.refuse(ReasonKind::kNotAllowed, "process.wheel_rim", {p.wheel_rim, Unit::kMetre}, "0 for this profile");
  }
  if (tapered) {
    checker.below("process.wheel_width", p.wheel_width, (p.wheel_diameter / 2 - p.wheel_wear) / std::tan(p.wheel_angle),
                  "where the wheel's smaller face closes");
  }
  const Quantity corners{p.wheel_corner_radius_lower + p.wheel_corner_radius_upper, Unit::kMetre};
  if (p.wheel_profile == WheelShape::kFullRadius) {
    if (!(corners.si <= 0)) {
      checker.refuse(ReasonKind::kNotAllowed, "process.wheel_corner_radius_lower", corners, "0 for this profile");
    }
    checker.below("process.wheel_width", p.wheel_width, p.wheel_diameter, "the wheel's diameter");
  } else if (!(corners.si <= p.wheel_width)) {
    checker.refuse(ReasonKind::kAbove, "process.wheel_corner_radius_lower", corners,
                   "the wheel's width for both corners together", p.wheel_width);
  }
}

/// Checks that exactly one key says how deep the roughing passes are.
void checkRoughing(Checker& checker, const GrindProcess& p) {
  constexpr double kMinInfeed = 0.1e-6;
  const Quantity infeed{p.infeed, Unit::kMetre}, removal{p.removal, Unit::kCubicMetrePerSecond};
  const Quantity roughing{static_cast<double>(p.roughing_passes), Unit::kNone};
  const auto beside = [](const char* path, const Quantity& other) {
    return "0 beside " + fieldName(path) + " = " + text(other);
  };
  if (isStraight(p.kind)) {
    if (p.roughing_passes > 0) {
      checker.refuse(ReasonKind::kNotAllowed, "process.roughing_passes", roughing, "0 for this operation");
    }
    if (p.removal > 0) checker.refuse(ReasonKind::kNotAllowed, "process.removal", removal, "0 for this operation");
  } else if (p.roughing_passes > 0 && (p.infeed > 0 || p.removal > 0)) {
    checker.refuse(ReasonKind::kNotAllowed, "process.roughing_passes", roughing,
                   p.infeed > 0 ? beside("process.infeed", infeed) : beside("process.removal", removal));
  } else if (p.removal > 0 && p.infeed > 0) {
    checker.refuse(ReasonKind::kNotAllowed, "process.removal", removal, beside("process.infeed", infeed));
  }
  if (!(p.infeed >= kMinInfeed * (1 - kRangeRounding)) && !(p.infeed == 0 && p.roughsByRemoval())) {
    checker.refuse(
        ReasonKind::kNotAllowed, "process.infeed", infeed,
        "0.0001 to 50 mm" + std::string(isStraight(p.kind) ? ""
                                                           : ", or " + fieldName("process.roughing_passes") + " or " +
                                                                 fieldName("process.removal") + " in its place"));
  }
}

bool has(const GrindJob& job, OperationKind kind) {
  const auto is_it = [kind](const GrindProcess& p) { return p.kind == kind; };
  return std::any_of(job.operations.begin(), job.operations.end(), is_it);
}

/// Checks which teeth go to the centre, and from where on the others beside them are whole.
void checkCenterTeeth(Checker& checker, const GrindJob& job) {
  const CutterGeometry& c = job.cutter;
  const int center = c.end_center_teeth, teeth = static_cast<int>(job.tooth_angles.size());
  const Quantity from{c.end_short_from, Unit::kMetre};
  if (center == 0) {
    if (from.si != 0) checker.refuse(ReasonKind::kNotAllowed, "cutter.end_short_from", from, kNoCenterTeeth);
    return;
  }
  constexpr int kFewest = 2;  // for each that goes to the centre: a short one is beside it
  if (teeth < kFewest * center || teeth % center != 0) {
    checker.refuse(ReasonKind::kNotAllowed, "cutter.end_center_teeth", {static_cast<double>(center), Unit::kNone},
                   "0, 1 of 2 or more teeth, or 2 of an even number of them from 4 on");
  }
  const double least = 4 * kEndGap;
  if (!(from.si >= least)) {
    checker.refuse(ReasonKind::kNotAllowed, "cutter.end_short_from", from, "at least", least);
  } else {
    checker.below("cutter.end_short_from", from.si, c.end_diameter / 2, "the cutter's radius at the end");
  }
}

/// Checks the order of the operations, and that the cutter has the dimensions that they need. The first are the flutes:
/// the edges of all others follow them.
void checkOperations(Checker& checker, const GrindJob& job) {
  const CutterGeometry& c = job.cutter;
  const auto ask = [&](const char* path, double value, Unit unit, const char* what) {
    if (!(value > 0)) checker.refuse(ReasonKind::kNotAllowed, path, {value, unit}, what);
  };
  int least = 0;
  for (std::size_t i = 0; i < job.operations.size() && checker.good(); ++i) {
    const OperationKind kind = job.operations[i].kind;
    const int number = static_cast<int>(kind), at = static_cast<int>(i);
    const int most = i > 0 && isStraight(kind) ? countOf<OperationKind>() - 1 : at;
    if (least > most) {
      checker.refuse(ReasonKind::kNotAllowed, "process.kind", {static_cast<double>(number), Unit::kNone},
                     "more than the kind of the operation before it, each kind once");
    } else {
      checker.whole("process.kind", number, most, least);
    }
    least = number + 1;
  }
  if (!checker.good()) return;
  if (has(job, OperationKind::kPrimaryRelief)) {
    ask("cutter.clearance", c.clearance, Unit::kRadian, "more than 0 with a relief");
    ask("cutter.clearance_tolerance", c.clearance_tolerance, Unit::kRadian, "more than 0 with a relief");
  }
  if (has(job, OperationKind::kSecondaryRelief)) {
    ask("cutter.land", c.land, Unit::kMetre, "more than 0 with a secondary relief");
    ask("cutter.second_clearance", c.second_clearance, Unit::kRadian, "more than 0 with a secondary relief");
  }
  if (has(job, OperationKind::kGash)) {
    ask("cutter.end_rake_tolerance", c.end_rake_tolerance, Unit::kRadian, "more than 0 with a gash");
  }
  if (has(job, OperationKind::kPrimaryEnd) || has(job, OperationKind::kSecondaryEnd)) {
    ask("cutter.end_clearance", c.end_clearance, Unit::kRadian, "more than 0 with end teeth");
    ask("cutter.end_clearance_tolerance", c.end_clearance_tolerance, Unit::kRadian, "more than 0 with end teeth");
  }
  if (has(job, OperationKind::kSecondaryEnd)) {
    ask("cutter.end_land", c.end_land, Unit::kMetre, "more than 0 with secondary flanks of the end");
    ask("cutter.end_second_clearance", c.end_second_clearance, Unit::kRadian,
        "more than 0 with secondary flanks of the end");
  }
  if (has(job, OperationKind::kChamfer)) {
    ask("cutter.chamfer_width", c.chamfer_width, Unit::kMetre, "more than 0 with a chamfer");
    ask("cutter.chamfer_angle", c.chamfer_angle, Unit::kRadian, "more than 0 with a chamfer");
    ask("cutter.chamfer_clearance", c.chamfer_clearance, Unit::kRadian, "more than 0 with a chamfer");
    ask("cutter.end_clearance_tolerance", c.end_clearance_tolerance, Unit::kRadian, "more than 0 with a chamfer");
  }
  const auto is_on_end = [](const GrindProcess& p) { return isStraight(p.kind); };
  if (std::any_of(job.operations.begin(), job.operations.end(), is_on_end)) checkCenterTeeth(checker, job);
}

/// Checks that a wheel can grind what only some wheels can: a relief's rim is a cylinder; a face grinds the end. The
/// rim of a gash's wheel may slope away from the face, and so spare the tooth before. The rim of a cup goes round the
/// next tooth of a left-hand end.
void checkWheelSuits(Checker& checker, const GrindJob& job) {
  const GrindProcess& p = job.process();
  const bool right = job.cutter.cut == CutDirection::kRightHand, is_gash = p.kind == OperationKind::kGash;
  const bool round_next = job.comesAlongX(), is_relief = isRelief(p.kind);
  const auto refuse = [&](const char* path, auto choice, const char* allowed) {
    checker.refuse(ReasonKind::kNotAllowed, path, {static_cast<double>(choice), Unit::kNone}, allowed);
  };
  if (p.wheel_profile == WheelShape::kStraight && !round_next) return;
  if (p.wheel_profile == WheelShape::kAngled && is_gash) {
    if (p.wheel_side == (right ? WheelFace::kUpper : WheelFace::kLower)) return;
    return refuse("process.wheel_side", p.wheel_side,
                  right ? "the upper face, which grinds the rake face of a right-hand gash"
                        : "the lower face, which grinds the rake face of a left-hand gash");
  }
  if (p.wheel_profile == WheelShape::kCup && !is_gash && !is_relief) {
    if (p.wheel_side != WheelFace::kLower) {
      return refuse("process.wheel_side", p.wheel_side, "the lower face, which grinds the flank");
    }
    if (round_next && !(p.wheel_rim > 0)) {
      checker.refuse(ReasonKind::kNotAllowed, "process.wheel_rim", {p.wheel_rim, Unit::kMetre},
                     "more than 0 for flanks of a left-hand end: its inner edge goes round the next tooth");
    }
    if (round_next) {
      checker.below("process.wheel_rim", p.wheel_rim, (p.wheel_diameter - job.cutter.end_diameter) / 2,
                    "what leaves a recess as wide as the cutter");
    }
    return;
  }
  refuse("process.wheel_profile", p.wheel_profile,
         round_next  ? "3, cup, for flanks of a left-hand end"
         : is_relief ? "0, straight, for a relief: its cylinder is what grinds it"
         : is_gash   ? "0, straight, or 1, angled, for a gash"
                     : "0, straight, or 3, cup, for a flank of the end or a chamfer");
}

/// Checks what only the gashes of short teeth have.
void checkShortGash(Checker& checker, const GrindJob& job) {
  const GrindProcess& p = job.process();
  constexpr double kLeastAngle = 5 * units::kDegree;
  const bool none = job.cutter.end_center_teeth == 0;
  const Quantity angle{p.gash_short_angle, Unit::kRadian}, past{p.gash_short_past, Unit::kMetre};
  if (none && past.si != 0) checker.refuse(ReasonKind::kNotAllowed, "process.gash_short_past", past, kNoCenterTeeth);
  if (angle.si == 0 || (!none && angle.si >= kLeastAngle)) return;
  checker.refuse(ReasonKind::kNotAllowed, "process.gash_short_angle", angle, none ? kNoCenterTeeth : "0, or from",
                 none ? 0 : kLeastAngle);
}

/// Checks what only an operation on the end has.
void checkEnd(Checker& checker, const GrindJob& job) {
  const CutterGeometry& c = job.cutter;
  const GrindProcess& p = job.process();
  const double radius = c.end_diameter / 2;
  const auto ask_past = [&](const char* path, double past) {
    if (past > -radius) return;
    checker.refuse(ReasonKind::kNotAllowed, path, {past, Unit::kMetre}, "more than the cutter's radius at the end,",
                   -radius);
  };
  if (p.kind == OperationKind::kGash) {
    ask_past("process.gash_past", p.gash_past);
    ask_past("process.gash_short_past", p.gash_short_past);
    checkShortGash(checker, job);
  }
  if (p.kind == OperationKind::kChamfer) {
    checker.below("cutter.chamfer_width", c.chamfer_width, radius, "the cutter's radius at the end");
  }
  if (p.kind == OperationKind::kSecondaryEnd && !(c.end_second_clearance > c.end_clearance)) {
    checker.refuse(ReasonKind::kNotAllowed, "cutter.end_second_clearance", {c.end_second_clearance, Unit::kRadian},
                   "more than that of the primary flank,", c.end_clearance);
  }
}

/// Checks numbers that are each within their range against each other.
void checkTogether(Checker& checker, const GrindJob& job) {
  const CutterGeometry& c = job.cutter;
  const GrindProcess& p = job.process();
  const double growth = std::tan(c.cone_angle);
  const auto radius = [&](double x) { return c.end_diameter / 2 + x * growth; };
  const double apex = -c.end_diameter / 2 / growth;  // X at which the cone's radius is 0
  if (growth < 0) {
    checker.below("cutter.flute_length", c.flute_length, apex, "where the cone closes");
    if (!checker.good()) return;  // the other errors would follow from this one
    const double room = apex - c.flute_length;
    if (!(p.setup_x_shift > -room)) {
      checker.refuse(ReasonKind::kOutOfRange, "process.setup_x_shift", {p.setup_x_shift, Unit::kMetre}, "",
                     100 * units::kMillimetre, -room);
      return;
    }
    checker.below("process.overtravel_shank", p.overtravel_shank, room + std::min(0.0, p.setup_x_shift),
                  "where the cone closes");
  } else if (growth > 0) {
    checker.below("process.setup_x_shift", p.setup_x_shift, -apex, "where the cone closes");
    if (!checker.good()) return;
    checker.below("process.overtravel_end", p.overtravel_end, -apex - std::max(0.0, p.setup_x_shift),
                  "where the cone closes");
  }
  if (p.kind != OperationKind::kFlute) {
    checkWheelSuits(checker, job);
    if (isStraight(p.kind)) checkEnd(checker, job);
    return checkWheel(checker, p);
  }
  checker.below("process.depth", p.depth, radius(0), "the cutter's radius at the small end");
  checker.below(p.depth_end > 0 ? "process.depth_end" : "process.depth", p.depthEnd(), radius(c.flute_length),
                "the cutter's radius at the flute's end");
  checker.below("cutter.core_diameter", c.core_diameter, c.end_diameter, "the cutter's diameter at the small end");
  checker.below("cutter.core_diameter_end", c.core_diameter_end, 2 * radius(c.flute_length),
                "the cutter's diameter at the flute's end");
  if (c.chordal_rake_depth > 0) {
    checker.below("cutter.chordal_rake_depth", c.chordal_rake_depth,
                  std::min(c.end_diameter - c.core_diameter, 2 * radius(c.flute_length) - c.core_diameter_end) / 2,
                  "the asked depth of the flute");
  }
  checkWheel(checker, p);
  const double deepest = p.deepest();
  if (!(p.finish_infeed <= deepest)) {
    checker.refuse(ReasonKind::kAbove, "process.finish_infeed", {p.finish_infeed, Unit::kMetre}, "the depth", deepest);
  }
  const int allowed_passes = std::min(kMaxPasses, kMaxPassesOfAll / static_cast<int>(job.tooth_angles.size()));
  if (!p.roughsByRemoval() && !(deepest / p.infeed + p.spark_out + 2 <= allowed_passes)) {
    checker.refuse(ReasonKind::kNotAllowed, "process.infeed", {p.infeed, Unit::kMetre},
                   "enough for the depth in " + std::to_string(allowed_passes) + " passes per tooth, " +
                       std::to_string(kMaxPassesOfAll) + " of all teeth");
  }
}

}  // namespace

Range askedSpiral(const GrindJob& job) {
  const std::vector<double>& angles = job.spiral_angles;
  if (angles.empty()) return {job.cutter.spiral_angle, job.cutter.spiral_angle};
  const auto [min, max] = std::minmax_element(angles.begin(), angles.end());
  return {*min, *max};
}

std::vector<Reason> validate(const GrindJob& job) {
  Checker checker;
  const int count = static_cast<int>(job.operations.size());
  checker.whole("operations", count, kMaxOperations, 1);
  if (checker.good()) checker.whole("operation", job.operation, count - 1);
  if (!checker.good()) return checker.take();
  visitJobFields([&](const JobField& field, auto of) {
    if (field.isOf(job.process().kind)) return checker.range(field, of(job));
    if (of(job) == 0) return;
    checker.refuse(ReasonKind::kNotAllowed, field.path, {of(job), field.unit}, "0 for this operation");
  });
  checkTeeth(checker, job.tooth_angles);
  checkSpirals(checker, job);
  checkWheelPoints(checker, job);
  visitJobChoices([&](const char* path, int max, auto of) { checker.whole(path, static_cast<int>(of(job)), max); });
  if (checker.good()) checkOperations(checker, job);
  if (checker.good()) checkRoughing(checker, job.process());
  if (checker.good()) checkTogether(checker, job);
  return checker.take();
}

GrindJob GrindJob::ofOperation(int index) const {
  GrindJob job = *this;
  job.operation = index;
  job.process();  // throws where there is none
  return job;
}

bool GrindJob::hasGround(OperationKind kind) const {
  return std::any_of(operations.begin(), operations.begin() + operation + 1,
                     [kind](const GrindProcess& p) { return p.kind == kind; });
}

int GrindJob::behind(int tooth) const {
  const int teeth = static_cast<int>(tooth_angles.size()), way = cutter.cut == CutDirection::kRightHand ? 1 : -1;
  return (tooth + way + teeth) % teeth;
}

bool GrindJob::isShort(int tooth) const {
  const int center = cutter.end_center_teeth, teeth = static_cast<int>(tooth_angles.size());
  return center > 0 && tooth % std::max(teeth / center, 1) != 0;
}

bool GrindJob::comesAlongX() const { return isEndFlank(process().kind) && cutter.cut == CutDirection::kLeftHand; }

const GrindProcess* GrindJob::next() const {
  const auto next = static_cast<std::size_t>(operation) + 1;
  return next < operations.size() ? &operations[next] : nullptr;
}

std::vector<GrindJob> GrindJob::ofAllOperations() const {
  std::vector<GrindJob> jobs(operations.size(), *this);
  for (std::size_t i = 0; i < jobs.size(); ++i) jobs[i].operation = static_cast<int>(i);
  return jobs;
}

std::vector<Reason> validateWheel(const GrindJob& job) {
  const auto of_wheel = [](std::string_view path) { return path.find("process.wheel_") == 0; };
  Checker checker;
  visitJobFields([&](const JobField& field, auto of) {
    if (of_wheel(field.path)) checker.range(field, of(job));
  });
  checkWheelPoints(checker, job);
  if (checker.good()) checkWheel(checker, job.process());
  return checker.take();
}

std::vector<double> passDepths(const GrindProcess& process) { return passDepths(process, process.deepest()); }

std::vector<double> passDepths(const GrindProcess& process, double deepest) {
  // A depth that is a multiple of the infeed, except for rounding, needs no extra pass for the remainder.
  constexpr double rounding = 1e-9;
  const double rough = deepest - process.finish_infeed;
  const int rough_passes = static_cast<int>(std::ceil(rough / process.infeed - rounding));
  std::vector<double> depths;
  for (int i = 1; i <= rough_passes; ++i) depths.push_back(i == rough_passes ? rough : i * process.infeed);
  return passDepths(process, deepest, std::move(depths));
}

std::vector<double> passDepths(const GrindProcess& process, double deepest, std::vector<double> depths) {
  if (process.finish_infeed > 0 || depths.empty()) depths.push_back(deepest);
  depths.insert(depths.end(), static_cast<std::size_t>(process.spark_out), deepest);
  return depths;
}

double shankCut(const CutterGeometry& cutter) {
  if (cutter.neck_length > 0) return 0;
  constexpr double kNothing = 0.5e-6;  // except for the decimals of a file, the shank is as thick as the flute's end
  const double cut = cutter.shank_diameter / 2 - ConicalCutter(cutter).radius(cutter.flute_length);
  return cut > kNothing ? cut : 0;
}

double askedCore(const CutterGeometry& cutter, double x) noexcept {
  return cutter.core_diameter + (cutter.core_diameter_end - cutter.core_diameter) * x / cutter.flute_length;
}

double askedDepth(const GrindJob& job, double x) {
  const CutterGeometry& c = job.cutter;
  return c.end_diameter / 2 + x * std::tan(c.cone_angle) - askedCore(c, x) / 2;
}

}  // namespace grinder
