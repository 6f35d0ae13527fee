#include "flute_grinder/setup/setup_sheet.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/setup/touch_off.h"

#include <algorithm>
#include <cmath>

namespace grinder {

namespace {

using namespace units;

double mm(double metres) { return metres / kMillimetre; }
double deg(double radians) { return radians / kDegree; }

/// "+ 1.200 mm", or "- 1.200 mm"
std::string added(double metres) { return format("%c %.3f mm", metres < 0 ? '-' : '+', std::abs(mm(metres))); }

std::string line(const char* name, const std::string& text) { return format("  %-16s ", name) + text + "\n"; }

std::string wheelText(const GrindProcess& p) {
  std::string text =
      format("%s, D %g mm, %g mm wide", toString(p.wheel_profile), mm(p.wheel_diameter), mm(p.wheel_width));
  if (isTapered(p.wheel_profile))
    text += format(", %g deg, larger face %s", deg(p.wheel_angle), toString(p.wheel_side));
  if (p.wheel_rim > 0) text += format(", rim %g mm", mm(p.wheel_rim));
  if (p.wheel_wear > 0) text += format(", worn by %g mm", mm(p.wheel_wear));
  return text;
}

std::string overtravelText(const JobSetup& setup) {
  const auto& [end, shank] = setup.overtravel;
  const GrindProcess& p = setup.job.process();
  return format("%g mm beyond the small end, %g mm toward the shank; needed: %.2f and %.2f mm", mm(p.overtravel_end),
                mm(p.overtravel_shank), mm(end), mm(shank));
}

std::string shiftText(const GrindProcess& p) {
  if (p.setup_x_shift == 0) return "0 mm: A by the published motion";
  return format("%.3f mm: A follows the curve at X - shift, so that the ground edge is the asked helix",
                mm(p.setup_x_shift));
}

std::string lawOfFlute(const JobSetup& setup) {
  const GrindProcess& p = setup.job.process();
  return line("shift in X", shiftText(p)) +
         line("depth", format("%.3f mm at X = 0, %.3f mm at the flute's end", mm(p.depth), mm(p.depthEnd()))) +
         line("overtravel", overtravelText(setup));
}

std::string placeText(const Axes& at) {
  const auto shown = [&](Axis axis) { return std::round(at[axis] / kMicrometre) * kMicrometre / kMillimetre + 0.0; };
  return format("X %.3f, Y %.3f, Z %.3f mm", shown(kX), shown(kY), shown(kZ));
}

std::string strokesText(const JobSetup::Straight& straight, OperationKind kind) {
  return line("first tooth", format("A %.3f deg", deg(straight.last.to[kA]))) +
         line("last stroke", "from " + placeText(straight.last.from)) +
         line("", "to   " + placeText(straight.last.to)) +
         line("travel", placeText(straight.travel) + format(", A %.3f deg", deg(straight.travel[kA]))) +
         line("passes", format("%d of each tooth, which remove %.3f mm %s", straight.passes, mm(straight.stock),
                               kind == OperationKind::kGash ? "along Y" : "across the plane"));
}

std::string whatToSet(const JobSetup& setup, const Range& swivel) {
  const GrindProcess& p = setup.job.process();
  return "set\n" + line("wheel", wheelText(p)) +
         line("swivel", format("%.3f deg; the machine's range is %g to %g deg", deg(p.setup_swivel), deg(swivel.from),
                               deg(swivel.to))) +
         line("height", format("%.3f mm, of the wheel's centre above the cutter's axis at Z = 0", mm(p.setup_height))) +
         (setup.straight
              ? strokesText(*setup.straight, p.kind)
              : line("", format("upper face %.3f mm, lower face %.3f mm, where they are deepest in the cutter",
                                mm(upperFaceHeight(setup.job)), mm(lowerFaceHeight(setup.job))))) +
         (setup.relief || setup.straight ? "" : lawOfFlute(setup));
}

/// What of the wheel grinds the end, and so must be touched off.
std::string whatGrinds(const GrindJob& job) {
  if (job.process().kind == OperationKind::kGash) {
    const bool right = job.cutter.cut == CutDirection::kRightHand;
    return line("", right ? "The rim and the upper face grind: Z, touched off with the lower one, relies on the width."
                          : "The rim and the lower face grind.");
  }
  return line("", "The lower face grinds: X and Z are touched off with it.") +
         line("X", "swivel set, Z = 0, wheel's lower face against the end, at the top of the blank") +
         line("",
              format("reads %.3f mm for D = %g mm, %g mm longer than the tool",
                     mm(touchX(job, job.cutter.end_diameter)), mm(job.cutter.end_diameter), mm(job.process().stock)));
}

/// The assumption about the wheel's position behind the reading of Z.
std::string wheelsPlace(const GrindJob& job, const std::optional<double>& above_swivel) {
  if (above_swivel)
    return line("", format("with the wheel's middle %.3f mm above the swivel's centre", mm(*above_swivel)));
  const double lowered = 1 - std::cos(job.process().setup_swivel);
  return line(
      "", format("%.4f mm less per mm of the wheel's middle above the swivel's centre, along the spindle", lowered));
}

std::string whatToTouch(const GrindJob& job, const std::optional<double>& above_swivel) {
  const TouchReadings touch = touchReadings(job, above_swivel.value_or(0));
  const double end = job.cutter.end_diameter;
  const auto reads = [&](const std::string& formula, double at_end) {
    return line("", format("reads %s: %.3f mm for D = %g mm", formula.c_str(), mm(at_end), mm(end)));
  };
  return "touch off on a cylinder, blank or shank but no cone, with D its diameter\n" +
         (isStraight(job.process().kind) ? whatGrinds(job) : "") +
         line("Z", "swivel at 0, wheel's lower face on top of the blank") +
         reads("D/2 " + added(touch.z), end / 2 + touch.z) + wheelsPlace(job, above_swivel) +
         line("Y", format("swivel set, Z = %.3f mm, wheel's circumference against the blank", mm(touch.z_for_y))) +
         reads(format("(D - %g)/2 ", mm(end)) + (touch.y == 0 ? "mm" : added(touch.y)), touch.y);
}

std::string whatComesOut(const JobSetup& setup) {
  const auto& complete = setup.check.complete;
  std::string text = "comes out\n";
  for (const GroundFigure& figure : setup.check.figures) {
    text += line(rowOf(figure.figure).words, grinder::text(figure));
  }
  if (setup.straight) return text;
  return text + line("flutes complete", complete ? format("X %.3f to %.3f mm", mm(complete->from), mm(complete->to))
                                                 : std::string("nowhere"));
}

/// @param room angle to the end of the machine's range [rad].
std::string swivelText(double room) {
  return line("swivel", format("%.3f deg from the end of the machine's range", deg(room)));
}

/// Where the rim ends, and so how far Y goes.
std::string whatLimitsStraight(const JobSetup& setup, const Range& swivel) {
  const GrindProcess& p = setup.job.process();
  const JobSetup::Straight& straight = *setup.straight;
  const std::string past = format("%.3f mm %s the cutter's axis, at Y %.3f mm", std::abs(mm(straight.past_axis)),
                                  straight.past_axis < 0 ? "before" : "past", mm(straight.last.to[kY])) +
                           (setup.job.cutter.end_center_teeth > 0 ? ", at the first tooth" : "");
  std::string ends = setup.job.comesAlongX() ? "goes round the next tooth, and ends " : "ends ";
  if (p.kind == OperationKind::kChamfer) ends += format("%g mm beyond the flank, ", mm(kEndGap));
  return swivelText(std::min(p.setup_swivel - swivel.from, swivel.to - p.setup_swivel)) + line("rim", ends + past) +
         (isEndFlank(p.kind) ? line("next tooth", format("%g mm from the rim at the end of a stroke", mm(kEndGap)))
                             : "");
}

std::string whatLimits(const JobSetup& setup, const Range& swivel) {
  if (setup.relief) {
    const JobSetup::Relief& r = *setup.relief;
    return line("next tooth", format("the wheel stays %.3f deg or more from its edge", deg(r.next_edge))) +
           line("rim", format("%.3f of %.3f mm of its width are behind the relief's start", mm(r.rim),
                              mm(setup.job.process().wheel_width))) +
           (r.land_end_clearance
                ? line("land's end", format("clearance %.3f to %.3f deg there", deg(r.land_end_clearance->from),
                                            deg(r.land_end_clearance->to)))
                : std::string());
  }
  if (setup.straight) return whatLimitsStraight(setup, swivel);
  const double percent = 100 * setup.margin;
  switch (setup.limit) {
    case SetupLimit::kSwivel: return swivelText(setup.margin * (swivel.to - swivel.from));
    case SetupLimit::kLand: return line("land", format("%.1f %% of the minimum pitch is left", percent));
    case SetupLimit::kCore: return line("core", format("%.1f %% of the small end's diameter is left", percent));
  }
  return "";
}

}  // namespace

double upperFaceHeight(const GrindJob& job) {
  return job.process().setup_height + wheelOf(job).upperFace() / std::cos(job.process().setup_swivel);
}

double lowerFaceHeight(const GrindJob& job) {
  return job.process().setup_height + wheelOf(job).lowerFace() / std::cos(job.process().setup_swivel);
}

std::string setupSheet(const JobSetup& setup, const Range& swivel, const std::optional<double>& above_swivel) {
  return whatToSet(setup, swivel) + whatToTouch(setup.job, above_swivel) + whatComesOut(setup) + "limited by\n" +
         whatLimits(setup, swivel);
}

std::string changesText(const std::optional<GrindProcess>& before, const GrindJob& solved) {
  GrindJob had = solved;
  if (before) had.process() = *before;
  std::string text;
  visitJobFields([&](const JobField& field, auto of) {
    if (!isOfSetup(field) || !field.isOf(solved.process().kind)) return;
    const double scale = shopScale(field.unit), was = of(had) / scale, is = of(solved) / scale;
    text +=
        format("  %-32s", field.file_key) + (before ? format("%.8g before, ", was) : "") + format("%.8g solved", is);
    text += !before ? "\n" : is == was ? ": the same\n" : format(": %+.5f\n", is - was);
  });
  return text;
}

std::string planRefusal(const JobSetup& setup) {
  std::string text;
  for (const Reason& reason : setup.check.reasons) {
    text += "a plan would refuse this tool: " + grinder::text(reason);
    const bool is_uneven = reason.kind == ReasonKind::kRake && setup.job.process().z_law == ZLaw::kPublished;
    text += is_uneven ? ", or set process.z_law: constant_rake\n" : "\n";
  }
  if (!setup.remedy.empty()) text += "It would be set up with " + setup.remedy + "\n";
  return text;
}

}  // namespace grinder
