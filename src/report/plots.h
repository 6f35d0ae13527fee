#pragma once

#include "flute_grinder/report/bag_run.h"
#include "report/envelope.h"
#include "report/motion.h"

#include <optional>
#include <vector>

namespace grinder {

/// The points of a report's pictures.
class Plots {
 public:
  explicit Plots(const BagRun& run);

  void add(const RunRow& row, const AxisMotion& motion);
  Json json() const;

 private:
  /// A quantity of the axes over time, in the strokes and outside them.
  struct OfAxes {
    OfAxes(const BagRun& run);
    void add(const RunRow& row, const std::optional<Axes>& value);
    Json json() const;

    Envelope stroke, rapid;
  };
  /// The curve and its errors in the stroke with the maximum error: thinned to some hundred points, and its ends in
  /// full.
  struct Curve {
    explicit Curve(const BagRun& run);
    void add(const Setpoint& setpoint);
    Json json() const;

    ToothPass worst;
    std::uint64_t count = 0;
    std::uint64_t every = 1;  ///< interval of the points kept; odd, so that odd and even points alternate
    std::vector<Setpoint> whole, start, end;
    Envelope odd, even;
  };
  /// A histogram of the measured periods of the loop.
  struct Timing {
    explicit Timing(double period);
    void add(double period);
    Json json() const;

    double width;
    std::vector<std::uint64_t> counts;
  };

  const double begin_, end_, period_;
  OfAxes speed_, acceleration_, following_;
  std::optional<Envelope> feed_;
  std::optional<Curve> curve_;
  Timing timing_;
};

}  // namespace grinder
