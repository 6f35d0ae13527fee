#pragma once

#include "flute_grinder/messages/json.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace grinder {

/// Reduces millions of points to what can be seen in a picture: the minimum and the maximum of each curve in each
/// column of x. If there are few points, they are kept themselves.
class Envelope {
 public:
  /// @param low,high range of x. @param points about how many there will be. @param curves number of values at each x.
  Envelope(double low, double high, std::uint64_t points, std::size_t curves = 1);

  /// @param y a value for each curve.
  void add(double x, const double* y);
  /// {exact, width, x, y}: the points themselves, or two for each column, at its middle; `width` is a column's.
  Json json() const;

 private:
  struct Column {
    std::vector<double> min, max;  ///< empty if there is no point in it
  };

  const double low_, width_;
  const bool is_exact_;
  const std::size_t curves_;
  std::vector<double> x_, y_;  ///< if they are kept
  std::vector<Column> columns_;
};

}  // namespace grinder
