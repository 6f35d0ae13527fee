#pragma once

#include "flute_grinder/base/enum_table.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/machine/need.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

// Arguments that several commands share.

/// A check that a number is from `min` to `max`, in `unit`.
inline auto within(double min, double max, const char* unit) {
  return [=](const std::string& text) {
    const double value = parseNumber(text.c_str());
    return value >= min && value <= max ? "" : format("%s; allowed: %g to %g %s", text.c_str(), min, max, unit);
  };
}

/// Adds the required job file.
void addJob(CLI::App& command, std::string& job);

/// Adds `--operation`, which chooses one of a job file's operations.
CLI::Option& addOperation(CLI::App& command, std::string& operation);

/// Adds `--csv`, a file to write.
void addCsv(CLI::App& command, std::string& csv, const char* description);

/// Adds `--json`.
void addJson(CLI::App& command, bool& json);

/// Adds `--answer`, which answers beforehand what the grinder needs to be told.
/// @param possible the answers that this command may give.
CLI::Option* addAnswer(CLI::App& command, std::vector<std::string>& answers, const std::vector<NeedAnswer>& possible);

/// Adds the choice of one of a bag's jobs, from 1. @param name name of the option.
void addCountedJob(CLI::App& command, const char* name, int& number);

/// Adds the files that describe the machine; by default the package's own.
void addMachine(CLI::App& command, std::string& parameters, std::string& urdf);

/// Adds the required letter of an axis.
void addAxis(CLI::App& command, std::string& axis);

/// Adds `--flange`.
void addFlange(CLI::App& command, std::optional<double>& flange_mm);

/// Adds an option whose argument is the name of an enum's value.
template <typename Enum>
void addChoice(CLI::App& command, const char* name, std::optional<Enum>& choice, const char* description) {
  std::map<std::string, Enum> values;
  std::string names;
  for (const auto& row : rowsOf(Enum{})) {
    values[row.name] = row.value;
    names += (names.empty() ? "" : "|") + std::string(row.name);
  }
  command
      .add_option_function<Enum>(
          name, [&choice](const Enum& value) { choice = value; }, description)
      ->transform(CLI::CheckedTransformer(values).description(""))
      ->type_name("{" + names + "}");
}

/// Adds a length in mm. @param zero whether it may be 0.
template <typename Length>
CLI::Option& addLength(CLI::App& command, const char* name, Length& length_mm, const char* description, bool zero) {
  return *command.add_option(name, length_mm, description)->type_name("MM")->check([zero](const std::string& text) {
    const double value = parseNumber(text.c_str());
    const bool good = std::isfinite(value) && (zero ? value >= 0 : value > 0);
    return good ? "" : text + "; allowed: " + (zero ? "0 mm or more" : "more than 0 mm");
  });
}

}  // namespace grinder
