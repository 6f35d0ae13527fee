#pragma once

#include "flute_grinder/messages/json.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace grinder {

/// Reduces millions of points to what a picture can show: the minimum and the maximum of each curve in each column of
/// x. A small number of points is kept as it is.
class Envelope {
 public:
  /// @param low,high range of x. @param points approximate number of points. @param curves number of values at each x.
  Envelope(double low, double high, std::uint64_t points, std::size_t curves = 1);

  /// Adds a point. @param y a value for each curve.
  void add(double x, const double* y);
  /// {exact, width, x, y}: the points themselves, or two for each column, at its middle; `width` is the width of a
  /// column.
  Json json() const;

 private:
  struct Column {
    std::vector<double> min, max;  ///< minima and maxima; empty without a point in the column
  };

  const double low_, width_;
  const bool is_exact_;
  const std::size_t curves_;
  std::vector<double> x_, y_;  ///< the points, if they are kept
  std::vector<Column> columns_;
};

}  // namespace grinder
