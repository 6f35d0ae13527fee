#pragma once

namespace grinder {

/// Thresholds of a quantity for a warning and for an error.
struct DiagnosticLevels {
  double warn = 0;
  double error = 0;
};

/// All thresholds of the diagnostics; fractions.
struct DiagnosticThresholds {
  DiagnosticLevels late_cycles;      ///< upper, of all cycles since the last report
  DiagnosticLevels following_error;  ///< upper, of the allowed following error
  DiagnosticLevels limit_use;        ///< upper, of an axis limit
  DiagnosticLevels buffer_fill;      ///< lower, of the maximum fill since power-on
};

}  // namespace grinder
