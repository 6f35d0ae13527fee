#include "report/csv_run.h"

#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/axes.h"
#include "flute_grinder/job/format.h"
#include "flute_grinder/report/csv_columns.h"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace grinder {

namespace {

using units::kMillimetre;

/// Takes the fields of a line one after the other. @throw std::invalid_argument
class Fields {
 public:
  explicit Fields(const std::string& line) : rest_(line) {}

  std::string text() {
    if (at_end_) throw std::invalid_argument("a field is missing");
    const std::size_t comma = rest_.find(',');
    std::string field(rest_.substr(0, comma));
    at_end_ = comma == std::string_view::npos;
    if (!at_end_) rest_.remove_prefix(comma + 1);
    return field;
  }
  double number() {
    const std::string field = text();
    char* end = nullptr;
    const double value = parseNumber(field.c_str(), &end);
    if (field.empty() || *end != '\0') throw std::invalid_argument("\"" + field + "\" is not a number");
    return value;
  }
  template <typename Integer>
  Integer integer() {
    constexpr Integer max = std::numeric_limits<Integer>::max();
    const double value = number();
    if (!(value >= 0 && value <= static_cast<double>(max) && value == std::floor(value)))
      throw std::invalid_argument(format("%g is out of range; allowed: 0 to %ju", value, std::uintmax_t{max}));
    return static_cast<Integer>(value);
  }
  template <typename Enum>
  Enum choice() {
    const std::string field = text();
    const auto value = valueOf<Enum>(field);
    if (!value) throw std::invalid_argument("\"" + field + "\" is not known");
    return *value;
  }
  Axes axes() {
    Axes axes;
    for (const int axis : {kX, kY, kZ}) axes[axis] = number() * kMillimetre;
    axes[kA] = number();
    return axes;
  }
  void end() const {
    if (!at_end_) throw std::invalid_argument("there are more fields than columns");
  }

 private:
  std::string_view rest_;
  bool at_end_ = false;
};

RunRow pointOf(Fields& fields) {
  RunRow row;
  Setpoint& s = row.setpoint;
  s.cycle = fields.integer<std::uint64_t>();
  s.move = MoveKind::kStroke;
  s.step = s.cycle % 2 == 1 ? StepKind::kOdd : StepKind::kEven;
  s.position[kX] = fields.number() * kMillimetre;
  s.position[kA] = fields.number();
  fields.number();  // the theory
  s.path_error = fields.number();
  return row;
}

RunRow setpointOf(Fields& fields, bool has_actual) {
  RunRow row;
  Setpoint& s = row.setpoint;
  s.cycle = fields.integer<std::uint64_t>();
  row.time = fields.number();
  s.move = fields.choice<MoveKind>();
  s.tooth = fields.integer<std::uint16_t>();
  s.pass = fields.integer<std::uint16_t>();
  s.step = fields.choice<StepKind>();
  s.position = fields.axes();
  s.path_error = fields.number();
  s.feed = fields.number() * units::kMillimetrePerMinute;
  if (has_actual) row.actual = fields.axes();
  return row;
}

}  // namespace

FileKind kindOfCsv(const std::string& first_line) {
  if (first_line == kTableColumns) return FileKind::kTable;
  if (first_line == kSetpointColumns) return FileKind::kPlan;
  if (first_line == std::string(kSetpointColumns) + kActualColumns) return FileKind::kRun;
  return FileKind::kOther;
}

CsvRun::CsvRun(std::string path, FileKind kind) : RunFile(std::move(path), kind) {
  visit([this](const RunRow& row) {
    summarise(row);
    // The times are whole cycles.
    if (row.setpoint.cycle > 0) period_ = row.time / static_cast<double>(row.setpoint.cycle);
  });
  finish();
}

void CsvRun::visit(const RowVisitor& visitor) const {
  std::ifstream file(path_);
  std::string line;
  if (!std::getline(file, line)) {
    if (!file.is_open()) fail(std::string("cannot be read: ") + std::strerror(errno));
    fail("is empty");
  }
  if (kind() == FileKind::kOther) {
    fail("its first line is '" + line.substr(0, 80) + "'; allowed: \"" + kTableColumns + "\", \"" + kSetpointColumns +
         "\", or a bag");
  }
  for (int number = 2; std::getline(file, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    try {
      if (line.empty()) throw std::invalid_argument("is empty");
      Fields fields(line);
      const RunRow row = kind() == FileKind::kTable ? pointOf(fields) : setpointOf(fields, kind() == FileKind::kRun);
      fields.end();
      visitor(row);
    } catch (const std::invalid_argument& error) {
      fail("line " + std::to_string(number) + ": " + error.what());
    }
  }
}

}  // namespace grinder
