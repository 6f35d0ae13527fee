#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace grinder {

/// A smooth addition to Z over X: a quintic spline of equal pieces, continuous up to its fourth derivative, constant
/// outside its range, and 0 without pieces. Real-time safe.
struct ZCorrection {
  static constexpr int kMaxPieces = 16;
  static constexpr int kDegree = 5;

  double from = 0;   ///< X where the first piece begins [m]
  double piece = 0;  ///< length of a piece [m]
  int pieces = 0;
  std::array<double, kMaxPieces + kDegree>
      coefficients{};  ///< coefficients of the B-splines, of which the first `pieces` + kDegree are used [m]

  /// Z and its derivatives over X.
  struct Value {
    double z = 0;       ///< [m]
    double first = 0;   ///< dZ/dX
    double second = 0;  ///< [1/m]
    double third = 0;   ///< [1/m^2]
  };

  int coefficientCount() const noexcept { return pieces == 0 ? 0 : pieces + kDegree; }

  Value at(double x) const noexcept {
    if (pieces == 0) return {};
    const double t = (x - from) / piece;
    const double inside = std::clamp(t, 0.0, static_cast<double>(pieces));
    const double index = std::max(0.0, std::min(std::floor(inside), static_cast<double>(pieces - 1)));
    const double u = inside - index;
    // The piece as a polynomial in u.
    std::array<double, kDegree + 1> p{};
    for (std::size_t j = 0; j <= kDegree; ++j) {
      const double c = coefficients[static_cast<std::size_t>(index) + j] / 120;
      for (std::size_t k = 0; k <= kDegree; ++k) p[k] += c * kBasis[j][k];
    }
    const double z = p[0] + u * (p[1] + u * (p[2] + u * (p[3] + u * (p[4] + u * p[5]))));
    const double first = p[1] + u * (2 * p[2] + u * (3 * p[3] + u * (4 * p[4] + u * 5 * p[5])));
    if (inside != t) return {z, 0, 0, 0};
    const double second = 2 * p[2] + u * (6 * p[3] + u * (12 * p[4] + u * 20 * p[5]));
    const double third = 6 * p[3] + u * (24 * p[4] + u * 60 * p[5]);
    return {z, first / piece, second / (piece * piece), third / (piece * piece * piece)};
  }

  /// The extremes of the derivatives over the whole range.
  struct Bounds {
    double min_first = 0, max_first = 0;
    double second = 0;  ///< maximum magnitude of the second derivative [1/m]
    double third = 0;   ///< maximum magnitude of the third derivative [1/m^2]
  };

  /// The derivative of a B-spline of equal pieces is a B-spline whose coefficients are differences of the original
  /// ones; it lies between their minimum and maximum.
  Bounds bounds() const noexcept {
    Bounds bounds;
    std::array<double, kMaxPieces + kDegree> difference = coefficients;
    const auto differentiate = [&](int order) {
      const auto count = static_cast<std::size_t>(coefficientCount() - order);
      for (std::size_t i = 0; i < count; ++i) difference[i] = (difference[i + 1] - difference[i]) / piece;
      return std::minmax_element(difference.begin(), difference.begin() + static_cast<std::ptrdiff_t>(count));
    };
    if (pieces == 0) return bounds;
    const auto [min, max] = differentiate(1);
    bounds.min_first = *min;
    bounds.max_first = *max;
    for (const int order : {2, 3}) {
      const auto [lowest, highest] = differentiate(order);
      // Never -0.0: limits are divided by this value.
      (order == 2 ? bounds.second : bounds.third) = std::max({0.0, -*lowest, *highest});
    }
    return bounds;
  }

  /// The six B-splines on a piece, as polynomials in u, times 120.
  static constexpr double kBasis[kDegree + 1][kDegree + 1] = {{1, -5, 10, -10, 5, -1},  {26, -50, 20, 20, -20, 5},
                                                              {66, 0, -60, 0, 30, -10}, {26, 50, 20, -20, -20, 10},
                                                              {1, 5, 10, 10, 5, -5},    {0, 0, 0, 0, 0, 1}};
};

}  // namespace grinder
