#include "flute_grinder/record/measured_tools.h"

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/units.h"

#include <algorithm>
#include <cmath>

namespace grinder {

namespace {

constexpr std::size_t kMostTools = 100;
constexpr double kSameTime = 0.002;  ///< records keep whole milliseconds [s]

MeasuredTool measuredTool(const ToolNumber& tool) {
  const Record record = readRecord(tool.path);
  try {
    MeasuredTool measured;
    measured.number = tool.number;
    measured.ended = record.head.ended;
    for (std::size_t i = 0; i < kCorrectedAxes.size(); ++i) {
      const std::string letter(1, "xyza"[kCorrectedAxes[i].axis]);
      const Json& found_at = record.body.at("zero_points").at(letter).at("found_at");
      const Json& offset = record.body.at("work_offsets").at(letter + "_mm");
      measured.offset[indexOf(kCorrectedAxes[i].turn)] = offset.get<double>() * units::kMillimetre;
      measured.found_at[i] = found_at.is_null() ? 0 : timeOf(found_at.get_ref<const std::string&>());
    }
    measured.figures = measuredOf(record);
    return measured;
  } catch (const std::exception& error) {
    throw FileError(tool.path + ": " + error.what());
  }
}

/// How the zero points of a tool came about: "found", "corrected" or "same" as those of the tool before.
const char* zerosOf(const MeasuredTool* before, const MeasuredTool& tool) {
  if (before == nullptr || !haveSameZeros(*before, tool)) return "found";
  return before->offset == tool.offset ? "same" : "corrected";
}

}  // namespace

const MeasuredFigure* MeasuredTool::find(const FigureAt& at) const noexcept {
  const auto found = std::find_if(figures.begin(), figures.end(), [&](const MeasuredFigure& one) {
    return one.figure == at.figure && std::abs(one.x - at.x) < units::kMicrometre;
  });
  return found == figures.end() ? nullptr : &*found;
}

bool isSameTime(double a, double b) noexcept { return std::abs(a - b) <= kSameTime; }

bool haveSameZeros(const MeasuredTool& a, const MeasuredTool& b) noexcept {
  return std::equal(a.found_at.begin(), a.found_at.end(), b.found_at.begin(), isSameTime);
}

std::vector<MeasuredTool> measuredTools(const std::vector<ToolNumber>& tools) {
  std::vector<MeasuredTool> measured;
  const std::size_t first = tools.size() - std::min(tools.size(), kMostTools);
  for (std::size_t i = first; i < tools.size(); ++i) measured.push_back(measuredTool(tools[i]));
  return measured;
}

Json figureHistory(const ValidJob& job, const std::vector<MeasuredTool>& tools, const FigureAt& at) {
  const ToolFigureRow& row = rowOf(at.figure);
  const auto shown = [&](double si) { return shopNumber(si, row.unit); };
  Json list = Json::array();
  const MeasuredTool* before = nullptr;
  for (const MeasuredTool& tool : tools) {
    const MeasuredFigure* measured = tool.find(at);
    list.push_back({{"tool", tool.number},
                    {"ended", tool.ended},
                    {"measured", measured ? Json(shown(measured->value)) : Json(nullptr)},
                    {"y_mm", shopNumber(tool.offset[indexOf(SetupTurn::kY)], Unit::kMetre)},
                    {"z_mm", shopNumber(tool.offset[indexOf(SetupTurn::kZ)], Unit::kMetre)},
                    {"zero_points", zerosOf(before, tool)}});
    before = &tool;
  }
  const auto asks = askedAt(job, at.figure, at.x);
  return {{"figure", toString(at.figure)},
          {"words", row.words},
          {"x_mm", row.of == StrokeForm::kStraight ? Json(nullptr) : Json(shopNumber(at.x, Unit::kMetre))},
          {"unit", shopUnit(row.unit)},
          {"asked", asks ? Json(shown(asks->value)) : Json(nullptr)},
          {"tolerance", asks ? Json(shown(asks->tolerance)) : Json(nullptr)},
          {"tools", list}};
}

}  // namespace grinder
