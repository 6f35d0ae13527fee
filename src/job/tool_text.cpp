#include "flute_grinder/job/tool_text.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"

namespace grinder {

std::string toolText(const CutterGeometry& cutter, std::size_t teeth) {
  return format("D %g mm, cone %g deg, spiral %g deg, rake %g deg, %zu %s", cutter.end_diameter / units::kMillimetre,
                cutter.cone_angle / units::kDegree, cutter.spiral_angle / units::kDegree,
                cutter.rake_angle / units::kDegree, teeth, teeth == 1 ? "tooth" : "teeth");
}

std::string jobText(const std::string& name, const std::string& operation, const CutterGeometry& cutter,
                    std::size_t teeth) {
  return (name.empty() ? "a job without a name" : name) + (operation.empty() ? "" : ", " + operation) + " (" +
         toolText(cutter, teeth) + ")";
}

}  // namespace grinder
