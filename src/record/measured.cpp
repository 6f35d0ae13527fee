#include "flute_grinder/record/measured.h"

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/job/valid_job.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

constexpr const char* kForm = "; allowed: FIGURE=VALUE or FIGURE@X=VALUE, as core=6.62 or rake@15=8.3, in mm or deg";
constexpr const char* kCore = "core";  ///< short for core_diameter
constexpr double kMostAngle = 90 * units::kDegree;
constexpr std::size_t kMostNumbers = 10;  ///< most numbers of tools in a message

bool isOfEnd(ToolFigure figure) { return rowOf(figure).of == StrokeForm::kStraight; }
bool isAngle(ToolFigure figure) { return rowOf(figure).unit == Unit::kRadian; }
std::string valueKey(ToolFigure figure) { return std::string("value_") + shopUnit(rowOf(figure).unit); }
std::string nameOf(ToolFigure figure) { return figure == ToolFigure::kCoreDiameter ? kCore : toString(figure); }

/// Whether rake and core are the same along the flute.
bool isSameAlong(const CutterGeometry& cutter) {
  return !(std::abs(cutter.cone_angle) > 0) && !(std::abs(cutter.core_diameter_end - cutter.core_diameter) > 0);
}

/// A number that is the whole text; NaN for any other.
double numberIn(const std::string& text) {
  char* end = nullptr;
  const double number = parseNumber(text.c_str(), &end);
  return !text.empty() && *end == '\0' ? number : std::numeric_limits<double>::quiet_NaN();
}

/// @param place text behind the @; nothing if there is none.
double placeOf(ToolFigure figure, const std::optional<std::string>& place, const CutterGeometry& cutter,
               const std::string& text) {
  if (isOfEnd(figure)) {
    if (place) throw std::invalid_argument(text + "; allowed: no X, since it is a figure of the end");
    return 0;
  }
  if (!place) {
    if (isSameAlong(cutter)) return cutter.flute_length / 2;
    throw std::invalid_argument(text + "; allowed: " + nameOf(figure) +
                                "@X, with X in mm from the small end, since the flute is not the same everywhere");
  }
  const double x = numberIn(*place) * units::kMillimetre;
  if (!(x >= 0 && x <= cutter.flute_length)) {
    throw std::invalid_argument(text + ": X = " + *place + "; allowed: 0 to " +
                                grinder::text(Quantity{cutter.flute_length, Unit::kMetre}) + ", the flute's length");
  }
  return x;
}

double valueOf(ToolFigure figure, double x, const std::string& value, const CutterGeometry& cutter) {
  const double si = numberIn(value) * shopScale(rowOf(figure).unit);
  if (isAngle(figure)) {
    if (std::abs(si) < kMostAngle) return si;
    throw std::invalid_argument(nameOf(figure) + " = " + value + "; allowed: an angle in deg, within 90 deg");
  }
  const double most = 2 * ConicalCutter(cutter).radius(x);
  if (si > 0 && si <= most) return si;
  throw std::invalid_argument(nameOf(figure) + " = " + value + "; allowed: more than 0, up to the diameter there, " +
                              grinder::text(Quantity{most, Unit::kMetre}));
}

}  // namespace

std::vector<ToolFigure> measurableOf(const GrindJob& job) {
  std::vector<ToolFigure> figures;
  for (const ToolFigureRow& row : kToolFigures) {
    const bool is_computed = row.value == ToolFigure::kOffHelix;
    if (!is_computed && row.of == rowOf(job.process().kind).form) figures.push_back(row.value);
  }
  return figures;
}

ToolFigure measurableOf(const std::string& name, const std::vector<ToolFigure>& allowed) {
  std::string names;
  for (const ToolFigure figure : allowed) {
    if (name == nameOf(figure) || name == toString(figure)) return figure;
    names += (names.empty() ? "" : ", ") + nameOf(figure);
  }
  throw std::invalid_argument("figure = " + name + "; allowed: " + names);
}

FigureAt figureFrom(const std::string& text, const GrindJob& job) {
  const std::size_t at = text.find('@');
  const ToolFigure figure = measurableOf(text.substr(0, at), measurableOf(job));
  const auto x = at == std::string::npos ? std::nullopt : std::optional(text.substr(at + 1));
  return {figure, placeOf(figure, x, job.cutter, text)};
}

MeasuredFigure measuredFrom(const std::string& text, const GrindJob& job) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) throw std::invalid_argument(text + kForm);
  const FigureAt at = figureFrom(text.substr(0, equals), job);
  return {at.figure, at.x, valueOf(at.figure, at.x, text.substr(equals + 1), job.cutter), "", ""};
}

std::optional<AskedFigure> askedAt(const ValidJob& job, ToolFigure figure, double x) {
  GroundSection section;
  section.x = x;
  section.radius = ConicalCutter(job->cutter).radius(x);
  const FigurePlace place{job, section, 0};
  if (const FigureValue value = asked(figure, place)) return AskedFigure{*value, tolerance(figure, place)};
  return std::nullopt;
}

std::string text(const MeasuredFigure& measured, const ValidJob& job) {
  const ToolFigureRow& row = rowOf(measured.figure);
  const auto shown = [&](double si) { return text(Quantity{si, row.unit}); };
  std::string words = row.words;
  if (!isOfEnd(measured.figure)) words += " at X = " + text(Quantity{measured.x, Unit::kMetre});
  words += ": " + shown(measured.value);
  if (const auto asks = askedAt(job, measured.figure, measured.x)) {
    words += "; asked " + shown(asks->value) + " within " + shown(asks->tolerance);
  }
  return words;
}

void addMeasured(Record& record, const MeasuredFigure& measured) {
  const Unit unit = rowOf(measured.figure).unit;
  record.body["measured"].push_back({{"figure", toString(measured.figure)},
                                     {"x_mm", shopNumber(measured.x, Unit::kMetre)},
                                     {valueKey(measured.figure), shopNumber(measured.value, unit)},
                                     {"when", measured.when},
                                     {"by", measured.by}});
}

Record keepMeasured(const ToolNumber& tool, std::vector<MeasuredFigure> figures, const std::string& by) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  for (MeasuredFigure& measured : figures) {
    measured.when = utcText(std::chrono::duration<double>(now).count());
    measured.by = by;
  }
  return changeRecord(tool.path, [&](Record& record) {
    for (const MeasuredFigure& measured : figures) addMeasured(record, measured);
  });
}

std::vector<MeasuredFigure> measuredOf(const Record& record) {
  std::vector<MeasuredFigure> all;
  const auto list = record.body.find("measured");
  if (list == record.body.end()) return all;
  for (const Json& one : *list) {
    const auto& name = one.at("figure").get_ref<const std::string&>();
    const auto figure = grinder::valueOf<ToolFigure>(name);
    if (!figure) throw std::invalid_argument("figure = " + name + ", which is unknown");
    MeasuredFigure measured{*figure, one.at("x_mm").get<double>() * units::kMillimetre,
                            one.at(valueKey(*figure)).get<double>() * shopScale(rowOf(*figure).unit),
                            one.at("when").get<std::string>(), one.at("by").get<std::string>()};
    const auto same = std::find_if(all.begin(), all.end(), [&](const MeasuredFigure& earlier) {
      return earlier.figure == measured.figure && std::abs(earlier.x - measured.x) < units::kMicrometre;
    });
    if (same != all.end()) all.erase(same);
    all.push_back(std::move(measured));
  }
  return all;
}

std::vector<ToolNumber> toolsIn(const std::string& folder, const std::string& digest) {
  std::vector<ToolNumber> tools;
  for (const std::string& path : recordFilesIn(folder).records) {
    try {
      const RecordHead head = readHead(path);
      if (head.digest != digest || head.outcome != "done") continue;
      tools.push_back({std::stoull(std::filesystem::path(path).filename().string()), path});
    } catch (const FileError&) {
      // `grind history` names the unreadable record.
    }
  }
  return tools;
}

const ToolNumber& toolOf(const std::vector<ToolNumber>& tools, std::uint64_t number) {
  if (tools.empty()) throw std::invalid_argument("no tool of this job and set-up is in the records");
  if (number == 0) return tools.back();
  const auto found =
      std::find_if(tools.begin(), tools.end(), [&](const ToolNumber& tool) { return tool.number == number; });
  if (found != tools.end()) return *found;
  std::string allowed;
  for (std::size_t i = tools.size() - std::min(tools.size(), kMostNumbers); i < tools.size(); ++i) {
    allowed += (allowed.empty() ? "" : ", ") + std::to_string(tools[i].number);
  }
  if (tools.size() > kMostNumbers) allowed = std::to_string(tools.front().number) + ", ..., " + allowed;
  throw std::invalid_argument("tool = " + std::to_string(number) + "; allowed: " + allowed);
}

}  // namespace grinder
