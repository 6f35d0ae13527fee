// Compares the messages' constants with the tables of core's enums: the values must be the same, the names must be the
// same in capitals, and there must be no further constants. All checks are made at compile time.

#include "flute_grinder/PathStatistics.h"
#include "flute_grinder/base/enum_table.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/reason.h"
#include "flute_grinder/machine/machine_state.h"
#include "flute_grinder/machine/probing_cycle.h"
#include "flute_grinder/motion/setpoint.h"
#include "flute_grinder/motion/work_offsets.h"
#include "flute_grinder/tool/tool_figure.h"
#include "message_texts.h"

#include <string_view>

namespace grinder {

namespace {

constexpr std::string_view kType = "uint8 ";

constexpr bool isDigit(char c) { return c >= '0' && c <= '9'; }
constexpr char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

/// Removes the next line from a text and returns it.
constexpr std::string_view takeLine(std::string_view& text) {
  const std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(line.size() < text.size() ? line.size() + 1 : line.size());
  return line;
}

/// Whether a line is `uint8 NAME=value`.
constexpr bool isConstant(std::string_view line, std::string_view name, std::size_t value) {
  if (line.substr(0, kType.size()) != kType) return false;
  line.remove_prefix(kType.size());
  for (const char c : name) {
    if (line.empty() || line.front() != upper(c)) return false;
    line.remove_prefix(1);
  }
  if (line.size() < 2 || line[0] != '=' || !isDigit(line[1])) return false;
  std::size_t number = 0;
  for (std::size_t i = 1; i < line.size() && isDigit(line[i]); ++i) {
    number = 10 * number + static_cast<std::size_t>(line[i] - '0');
  }
  return number == value;
}

constexpr int countConstants(std::string_view text) {
  int count = 0;
  while (!text.empty()) {
    const std::string_view line = takeLine(text);
    count += line.substr(0, line.find('#')).find('=') != std::string_view::npos ? 1 : 0;
  }
  return count;
}

template <typename Enum>
constexpr bool hasAllOf(std::string_view text) {
  for (const auto& row : rowsOf(Enum{})) {
    bool found = false;
    for (std::string_view rest = text; !rest.empty();) {
      found |= isConstant(takeLine(rest), row.name, static_cast<std::size_t>(row.value));
    }
    if (!found) return false;
  }
  return true;
}

/// Whether a message's constants match the values of these enums.
template <typename... Enums>
constexpr bool has(std::string_view text) {
  return (hasAllOf<Enums>(text) && ...) && countConstants(text) == (countOf<Enums>() + ...);
}

static_assert(has<EvenStepRule>(message_text::kInterpolation));
static_assert(has<CutDirection>(message_text::kCutter));
static_assert(has<OperationKind, GrindOrder, StrokeDirection, ZLaw, WheelShape, WheelFace>(message_text::kProcess));
static_assert(has<OffsetMethod>(message_text::kOffsetBasis));
static_assert(has<TeethUnknown>(message_text::kClampedTool));
static_assert(has<ProbingCycle>(message_text::kProbe));
static_assert(has<ToolFigure>(message_text::kToolFigure));
// The message's other constants are axes and units, which reasons.cpp compares.
static_assert(hasAllOf<ReasonKind>(message_text::kReason) &&
              countConstants(message_text::kReason) == kReasonKindCount + kAxisCount + kUnitCount);
static_assert(has<MachineState>(message_text::kGrinderState));
static_assert(has<MoveKind, StepKind>(message_text::kWrittenSetpoint));
static_assert(flute_grinder::PathStatistics::_move_duration_type::static_size == kMoveKindCount,
              "PathStatistics.move_duration");

}  // namespace

}  // namespace grinder
