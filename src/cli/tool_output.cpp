#include "cli/tool_output.h"

#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/tool_text.h"
#include "flute_grinder/tool/end_view.h"
#include "flute_grinder/tool/section_outline.h"
#include "flute_grinder/tool/tool_figure.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <utility>

namespace grinder {

namespace {

using namespace units;

constexpr std::size_t kOutlineRings = 32;
constexpr std::size_t kOutlineColumns = 180;  ///< columns of the lands of all teeth together

/// A tooth in a section, with a figure that only the output needs.
struct Place : FigurePlace {
  Place(const ValidJob& job, const MeasuredSection& section, std::size_t tooth)
      : FigurePlace{job, section.ground, tooth}, area_removed(section.area_removed) {}

  double area_removed;  ///< area removed from the section [m^2]
};
using Value = FigureValue;

Value onOuterCircle(const Place& p, Value angle) {
  if (angle) *angle *= p.section.radius;
  return angle;
}

/// A figure of a tooth in a section.
struct Figure {
  std::string key;    ///< name in files, ending in the unit
  std::string title;  ///< name in the table of extremes
  std::string head;   ///< name in the table of sections; empty for a figure in neither table
  double unit = 1;
  std::function<Value(const Place&)> value;
  std::function<Value(const Place&)> asked{};  ///< value asked for; empty if no job asks for the figure
  bool of_section = false;                     ///< the figure is the same for all teeth
  std::optional<ToolFigure> row{};             ///< row in the table of figures, if it has one
};

/// A figure from the table of figures.
Figure askedFigure(ToolFigure figure) {
  const ToolFigureRow& row = rowOf(figure);
  const std::string unit = shopUnit(row.unit), words = row.words;
  return {std::string(row.name) + "_" + unit,
          words + ", " + unit,
          words.substr(0, words.find(' ')) + " " + unit,
          shopScale(row.unit),
          [figure](const Place& p) { return measured(figure, p); },
          [figure](const Place& p) { return asked(figure, p); },
          figure == ToolFigure::kCoreDiameter,
          figure};
}

Value askedNormalRake(const Place& p) {
  return std::atan(std::tan(p.job->cutter.rake_angle) * std::cos(*asked(ToolFigure::kSpiral, p)));
}

Value ofRelief(const Place& p, Value ReliefSection::*member) {
  return p.tooth().relief ? *p.tooth().relief.*member : std::nullopt;
}

std::vector<Figure> figuresOfFlutes() {
  return {{"edge_deg", "", "", kDegree, [](const Place& p) { return p.tooth().edge; }},
          askedFigure(ToolFigure::kRake),
          askedFigure(ToolFigure::kChordalRake),
          {"normal_rake_deg", "normal rake, deg", "normal deg", kDegree,
           [](const Place& p) { return p.tooth().complete ? p.tooth().normal_rake : Value(); }, askedNormalRake},
          askedFigure(ToolFigure::kCoreDiameter),
          {"depth_mm", "flute depth, mm", "depth mm", kMillimetre, [](const Place& p) { return p.tooth().depth; },
           [](const Place& p) { return askedDepth(*p.job, p.section.x); }},
          {"flute_deg", "flute, deg", "flute deg", kDegree, [](const Place& p) { return p.tooth().flute; }},
          {"flute_mm", "flute, mm", "flute mm", kMillimetre,
           [](const Place& p) { return onOuterCircle(p, p.tooth().flute); }},
          {"land_deg", "land, deg", "land deg", kDegree, [](const Place& p) { return p.tooth().land; }},
          {"land_mm",
           "land, mm",
           "land mm",
           kMillimetre,
           [](const Place& p) { return onOuterCircle(p, p.tooth().land); },
           {},
           false,
           ToolFigure::kLand},
          askedFigure(ToolFigure::kSpiral),
          {"area_removed_mm2",
           "area removed, mm^2",
           "area mm^2",
           kMillimetre * kMillimetre,
           [](const Place& p) { return p.area_removed; },
           {},
           true}};
}

std::vector<Figure> figuresOf(const ValidJob& job) {
  std::vector<Figure> figures = figuresOfFlutes();
  if (!job->hasGround(OperationKind::kPrimaryRelief)) return figures;
  for (Figure& figure :
       std::vector<Figure>{askedFigure(ToolFigure::kClearance),
                           {"land_end_clearance_deg", "at the land's end", "end deg", kDegree,
                            [](const Place& p) { return ofRelief(p, &ReliefSection::land_end_clearance); }},
                           askedFigure(ToolFigure::kPrimary),
                           askedFigure(ToolFigure::kSecondClearance),
                           {"heel_mm", "edge to heel, mm", "heel mm", kMillimetre,
                            [](const Place& p) { return ofRelief(p, &ReliefSection::heel); }},
                           askedFigure(ToolFigure::kEdgeDiameter)}) {
    figures.push_back(std::move(figure));
  }
  return figures;
}

bool isShown(const Figure& figure) { return !figure.head.empty(); }

/// A value in the figure's unit.
Value shown(const Figure& figure, Value value) {
  if (value) *value /= figure.unit;
  return value;
}

template <typename Visit>
void forEachTooth(const GroundTool& tool, const Visit& visit) {
  for (const MeasuredSection& section : tool.sections) {
    for (std::size_t i = 0; i < section.ground.teeth.size(); ++i) visit(Place{tool.job, section, i});
  }
}

std::string cell(int width, Value value, const char* plus = "") {
  return value ? format(*plus ? "  %+*.3f" : "  %*.3f", width, *value) : format("  %*s", width, "-");
}

std::string rowOf(const Place& place) {
  std::string row;
  for (const Figure& figure : figuresOf(place.job)) {
    if (!isShown(figure)) continue;
    row += cell(static_cast<int>(figure.head.size()), shown(figure, figure.value(place)));
  }
  return row;
}

/// Prints a section; neighbouring teeth with the same figures share a line.
void printSection(const ValidJob& job, const MeasuredSection& section) {
  const std::size_t teeth = section.ground.teeth.size();
  std::string row;
  for (std::size_t first = 0, next; first < teeth; first = next) {
    row = rowOf({job, section, first});
    for (next = first + 1; next < teeth && rowOf({job, section, next}) == row;) ++next;
    const std::string which = format(next > first + 1 ? "%zu-%zu" : "%zu", first + 1, next);
    std::printf("%8.3f  %5s%s\n", section.ground.x / kMillimetre, which.c_str(), row.c_str());
  }
}

/// The minimum and maximum of a figure and their places, with the ranges of the value asked for and of the difference.
struct Extremes {
  struct At {
    double value, x;
    std::size_t tooth;
  };
  std::optional<At> min, max;
  std::optional<std::pair<double, double>> asked, difference;

  Extremes(const GroundTool& tool, const Figure& figure) {
    forEachTooth(tool, [&](const Place& p) {
      const Value asks = figure.asked ? shown(figure, figure.asked(p)) : std::nullopt,
                  value = shown(figure, figure.value(p));
      if (asks) widen(asked, *asks);
      if (!value) return;
      if (asks) widen(difference, *value - *asks);
      const At at{*value, p.section.x / kMillimetre, p.number + 1};
      if (!min || *value < min->value) min = at;
      if (!max || *value > max->value) max = at;
    });
  }

 private:
  static void widen(std::optional<std::pair<double, double>>& range, double value) {
    if (!range) range.emplace(value, value);
    range->first = std::min(range->first, value);
    range->second = std::max(range->second, value);
  }
};

std::string text(const std::optional<Extremes::At>& at) {
  if (!at) return format("  %9s  %8s  %5s", "-", "-", "-");
  return format("  %9.3f  %8.3f  %5zu", at->value, at->x, at->tooth);
}

std::string text(const std::optional<std::pair<double, double>>& range, const char* plus = "") {
  if (!range) return format("  %20s", "-");
  const std::string from = cell(0, range->first, plus).substr(2), to = cell(0, range->second, plus).substr(2);
  return format("  %20s", (from == to ? from : from + " to " + to).c_str());
}

void printExtremes(const GroundTool& tool) {
  std::printf("\n%-18s  %9s  %8s  %5s  %9s  %8s  %5s  %20s  %20s\n", "", "min", "at X mm", "tooth", "max", "at X mm",
              "tooth", "asked", "difference");
  for (const Figure& figure : figuresOf(tool.job)) {
    if (!isShown(figure)) continue;
    const Extremes e(tool, figure);
    std::printf("%-18s%s%s%s%s\n", figure.title.c_str(), text(e.min).c_str(), text(e.max).c_str(),
                text(e.asked).c_str(), text(e.difference, "+").c_str());
  }
}

/// Prints the figures of the tool's end.
void printEnd(const CutterFigures& figures) {
  std::printf("\n");
  for (const GroundFigure& figure : figures) printFigure(figure);
}

std::string text(const Range& range) {
  return format("X %.3f to %.3f mm", range.from / kMillimetre, range.to / kMillimetre);
}

/// Prints the strokes of each tooth in a run, even if there are none. Passes of equal length share a line.
void printStrokes(const GroundTool& tool) {
  for (std::size_t i = 0; i < tool.job->tooth_angles.size(); ++i) {
    std::vector<RunStroke> strokes;
    for (const RunStroke& stroke : tool.strokes) {
      if (stroke.move == MoveKind::kStroke && stroke.place.tooth == static_cast<int>(i)) strokes.push_back(stroke);
    }
    std::string passes;
    for (std::size_t first = 0, next; first < strokes.size(); first = next) {
      const std::string range = text(strokes[first].range);
      for (next = first + 1; next < strokes.size() && text(strokes[next].range) == range;) ++next;
      passes += passes.empty() ? "pass " : "; pass ";
      passes += std::to_string(strokes[first].place.pass + 1);
      if (next > first + 1) passes += "-" + std::to_string(strokes[next - 1].place.pass + 1);
      passes += ", " + range;
    }
    std::printf("%-18s  %s\n", format("tooth %zu", i + 1).c_str(),
                passes.empty() ? "not in the record" : passes.c_str());
  }
}

void printGouges(const GroundTool& tool) {
  for (const Gouge& gouge : tool.gouges) {
    if (!(gouge.depth > kBadGouge)) continue;
    std::printf("%-18s  tooth %d, pass %d, %s: %.3f mm at X %.3f mm\n", "beyond the flute", gouge.place.tooth + 1,
                gouge.place.pass + 1, toString(gouge.move), gouge.depth / kMillimetre, gouge.x / kMillimetre);
  }
}

Json strokes(const GroundTool& tool) {
  Json strokes = Json::array();
  for (const RunStroke& stroke : tool.strokes) {
    if (stroke.move != MoveKind::kStroke) continue;
    strokes.push_back({{"tooth", stroke.place.tooth},
                       {"pass", stroke.place.pass},
                       {"from_x_mm", stroke.range.from / kMillimetre},
                       {"to_x_mm", stroke.range.to / kMillimetre}});
  }
  return strokes;
}

Json gouges(const GroundTool& tool) {
  Json gouges = Json::array();
  for (const Gouge& gouge : tool.gouges) {
    gouges.push_back({{"tooth", gouge.place.tooth},
                      {"pass", gouge.place.pass},
                      {"move", toString(gouge.move)},
                      {"x_mm", gouge.x / kMillimetre},
                      {"depth_mm", gouge.depth / kMillimetre}});
  }
  return gouges;
}

Json number(Value value) { return value ? Json(*value) : Json(nullptr); }

/// Appends the figures of the section, or of the tooth.
void append(Json& json, const Place& place, bool of_section) {
  for (const Figure& figure : figuresOf(place.job)) {
    if (figure.of_section != of_section) continue;
    json[figure.key] = number(shown(figure, figure.value(place)));
    if (figure.asked) json["asked_" + figure.key] = number(shown(figure, figure.asked(place)));
  }
}

/// The figures that are drawn over X. The width of a land on the blank means nothing once the land is relieved.
Json curves(const GroundTool& tool) {
  Json curves = Json::array();
  const Place first{tool.job, tool.sections.front(), 0};
  for (const Figure& figure : figuresOf(tool.job)) {
    if (!figure.row || (*figure.row == ToolFigure::kLand && tool.job->hasGround(OperationKind::kPrimaryRelief)))
      continue;
    const ToolFigureRow& row = rowOf(*figure.row);
    const bool is_asked = asked(row.value, first).has_value();
    curves.push_back({{"key", figure.key},
                      {"words", row.words},
                      {"unit", shopUnit(row.unit)},
                      {"of_section", figure.of_section},
                      {"tolerance", is_asked ? Json(tolerance(row.value, first) / figure.unit) : Json(nullptr)}});
  }
  return curves;
}

/// The outline of a section; null where the core is cut through.
Json outline(const GroundTool& tool, double x) {
  const std::size_t teeth = tool.cutter.teeth().size();
  const OutlineGrid grid{teeth, kOutlineRings, kOutlineColumns / teeth + 1};
  Json points = Json::array();
  try {
    for (const PolarPoint& p : sectionOutline(tool.cutter, x, tool.cutter.cutter().radius(x), grid)) {
      const double r = p.radius / kMillimetre;
      points.push_back({r * std::cos(p.angle()), r * std::sin(p.angle())});
    }
  } catch (const std::invalid_argument&) {
    return nullptr;
  }
  return points;
}

/// A line in steps of 10 nm, so that it is short.
Json lineOf(const EndPolyline& line) {
  const auto rounded = [](double length) { return std::round(length / kMillimetre * 1e5) / 1e5; };
  Json points = Json::array();
  for (const Eigen::Vector2d& point : line) points.push_back({rounded(point.x()), rounded(point.y())});
  return points;
}

const char* nameOf(SurfaceKind kind) {
  switch (kind) {
    case SurfaceKind::kGash: return "gash";
    case SurfaceKind::kEndPrimary: return "primary";
    case SurfaceKind::kEndSecondary: return "secondary";
    case SurfaceKind::kChamfer: return "chamfer";
    default: return "blank";
  }
}

Json toJson(const GroundTool& tool, const EndView& view) {
  if (view.regions.empty()) return nullptr;
  Json regions = Json::array(), edges = Json::array();
  for (const EndRegion& region : view.regions) {
    Json outlines = Json::array();
    for (const EndPolyline& outline : region.outlines) outlines.push_back(lineOf(outline));
    regions.push_back({{"face", nameOf(region.kind)}, {"tooth", region.tooth}, {"outlines_mm", outlines}});
  }
  for (const EndEdge& edge : view.edges) edges.push_back({{"tooth", edge.tooth}, {"line_mm", lineOf(edge.line)}});
  return {{"diameter_mm", tool.job->cutter.end_diameter / kMillimetre},
          {"edge_deg", (tool.job->tooth_angles.front() + tool.job.edges().front().at_end) / kDegree},
          {"uncut_diameter_mm", tool.job->cutter.end_uncut_diameter / kMillimetre},
          {"short_from_mm", tool.job->cutter.end_short_from / kMillimetre},
          {"regions", regions},
          {"edges", edges}};
}

/// The view of the end; null for a tool whose end is the blank's, or that has no solid, as with a core cut through.
Json endViewOf(const GroundTool& tool) {
  try {
    return toJson(tool, endView(tool.cutter, tool.end));
  } catch (const std::invalid_argument&) {
    return nullptr;
  }
}

/// The radial depth of every pass at the small end.
Json passDepths(const ValidJob& job) {
  Json depths = Json::array();
  for (const double depth : job.depths()) depths.push_back(job.depthAtEnd(depth) / kMillimetre);
  return depths;
}

Json toJson(const GroundTool& tool, const MeasuredSection& section) {
  Json json{{"x_mm", section.ground.x / kMillimetre}, {"diameter_mm", 2 * section.ground.radius / kMillimetre}};
  append(json, {tool.job, section, 0}, true);
  json["outline_mm"] = outline(tool, section.ground.x);
  json["teeth"] = Json::array();
  for (std::size_t i = 0; i < section.ground.teeth.size(); ++i) {
    Json tooth{{"tooth", i}, {"complete", section.ground.teeth[i].complete}};
    append(tooth, {tool.job, section, i}, false);
    json["teeth"].push_back(std::move(tooth));
  }
  return json;
}

}  // namespace

void printFigure(const GroundFigure& figure) {
  std::printf("%-20s %s\n", rowOf(figure.figure).words, text(figure).c_str());
}

void printText(const GroundTool& tool) {
  std::printf("%s: %s\n\n%8s  %5s", tool.source.c_str(),
              toolText(tool.job->cutter, tool.job->tooth_angles.size()).c_str(), "X mm", "tooth");
  for (const Figure& figure : figuresOf(tool.job)) {
    if (isShown(figure)) std::printf("  %s", figure.head.c_str());
  }
  std::printf("\n");
  for (const MeasuredSection& section : tool.sections) printSection(tool.job, section);
  printExtremes(tool);
  if (tool.job.isStraight()) {
    printEnd(tool.check.figures);
  } else if (tool.check.complete) {
    std::printf("\n%-18s  X %.3f to %.3f mm\n", "flutes complete", tool.check.complete->from / kMillimetre,
                tool.check.complete->to / kMillimetre);
  } else {
    std::printf("\n%-18s  not in the middle of the flute\n", "flutes complete");
  }
  std::printf("%-18s  %.3f mm^3, X 0 to %.3f mm\n", "volume removed",
              tool.volume_removed / (kMillimetre * kMillimetre * kMillimetre),
              tool.job->cutter.flute_length / kMillimetre);
  if (!tool.of_run) return;
  printStrokes(tool);
  printGouges(tool);
}

Json toJson(const GroundTool& tool) {
  Json reasons = Json::array();
  for (const Reason& reason : tool.check.reasons) reasons.push_back(text(reason));
  Json sections = Json::array();
  for (const MeasuredSection& section : tool.sections) sections.push_back(toJson(tool, section));
  const auto& complete = tool.check.complete;
  return {{"source", tool.source},
          {"tool", toolText(tool.job->cutter, tool.job->tooth_angles.size())},
          {"cut", toString(tool.job->cutter.cut)},
          {"job", toJson(*tool.job)},
          {"pass_depths_mm", passDepths(tool.job)},
          {"valid", tool.check.reasons.empty()},
          {"reasons", reasons},
          {"teeth", tool.job->tooth_angles.size()},
          {"volume_mm3", tool.volume_removed / (kMillimetre * kMillimetre * kMillimetre)},
          {"complete_from_mm", complete ? Json(complete->from / kMillimetre) : Json(nullptr)},
          {"complete_to_mm", complete ? Json(complete->to / kMillimetre) : Json(nullptr)},
          {"end", tool.job.isStraight() ? toJson(tool.check.figures) : Json(nullptr)},
          {"end_view", endViewOf(tool)},
          {"on_planned", tool.on_planned},
          {"strokes", tool.of_run ? strokes(tool) : Json(nullptr)},
          {"gouges", tool.of_run ? gouges(tool) : Json(nullptr)},
          {"curves", curves(tool)},
          {"sections", sections}};
}

namespace {

std::string csvHeader(const ValidJob& job) {
  std::string header = "x_mm,tooth";
  for (const Figure& figure : figuresOf(job)) {
    header += "," + figure.key;
    if (figure.asked) header += ",asked_" + figure.key;
  }
  return header;
}

}  // namespace

GroundToolCsv::GroundToolCsv(const std::string& path, const ValidJob& job) : CsvFile(path, csvHeader(job)) {}

void GroundToolCsv::write(const GroundTool& tool) {
  const auto field = [&](Value value) { value ? print(",%.17g", *value) : print(","); };
  forEachTooth(tool, [&](const Place& place) {
    print("%.17g,%zu", place.section.x / kMillimetre, place.number);
    for (const Figure& figure : figuresOf(tool.job)) {
      field(shown(figure, figure.value(place)));
      if (figure.asked) field(shown(figure, figure.asked(place)));
    }
    print("\n");
  });
}

}  // namespace grinder
