#pragma once

namespace grinder {

/// Thresholds of a quantity for a warning and for an error.
struct DiagnosticLevels {
  double warn = 0;
  double error = 0;
};

/// All thresholds of the diagnostics.
struct DiagnosticThresholds {
  DiagnosticLevels late_cycles;      ///< upper thresholds, as fractions of all cycles since the last report
  DiagnosticLevels following_error;  ///< upper thresholds, as fractions of the allowed following error
  DiagnosticLevels limit_use;        ///< upper thresholds, as fractions of an axis limit
  DiagnosticLevels buffer_fill;      ///< lower thresholds, as fractions of the maximum fill since power-on
};

}  // namespace grinder
