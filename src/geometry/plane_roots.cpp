#include "geometry/plane_roots.h"

#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace flute_grinder {

namespace {

constexpr std::uintmax_t kMaxSteps = 60;
constexpr int kHalvings = 6;        ///< of a step of u in which lines begin, end or jump
constexpr double kLargeStep = 0.1;  ///< of the second function, between columns where it may hide a jump
constexpr int kStepsAround = 8;     ///< of v, about where a line is expected between two columns
constexpr double kOnLine = 0.1;     ///< how much closer than the tolerance a line is followed
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Where f changes its sign between a and b; NaN if it jumps there, or does not exist.
double rootBetween(const LineFunction& f, double a, double fa, double b, double fb, double tolerance) {
  if (std::abs(fa) <= tolerance) return a;
  if (std::abs(fb) <= tolerance) return b;
  bool exists = true;
  double best = a, least = std::abs(fa);
  const auto g = [&](double at) {
    const double value = f(at);
    // A zero ends the search, here where it would go astray.
    if (std::isnan(value)) exists = false;
    if (!exists) return 0.0;
    if (std::abs(value) < least) least = std::abs(value), best = at;
    return std::abs(value) <= tolerance ? 0.0 : value;
  };
  std::uintmax_t steps = kMaxSteps;
  boost::math::tools::toms748_solve(g, a, b, fa, fb, boost::math::tools::eps_tolerance<double>(48), steps);
  return exists && least <= tolerance ? best : kNone;
}

/// The lines along which the first function vanishes, cut at one u.
struct Column {
  struct Cut {
    LineRoot v;
    double second = 0;  ///< the second function's value
  };
  double u = 0;
  std::vector<Cut> cuts;
};

class PlaneSearch {
 public:
  PlaneSearch(const PlaneFunction& first, const PlaneFunction& second, const SearchRange& v, double tolerance)
      : first_(first), second_(second), v_(v), tolerance_(tolerance) {}

  Column column(double u) const {
    Column column{u, {}};
    for (const LineRoot& root : cutsOf(u, v_)) column.cuts.push_back({root, second_(u, root.at)});
    return column;
  }

  void between(const Column& a, const Column& b, int halvings, std::vector<PlaneRoot>& found) const {
    if (!alike(a, b) && halvings > 0) {
      const Column middle = column((a.u + b.u) / 2);
      between(a, middle, halvings - 1, found);
      between(middle, b, halvings - 1, found);
      return;
    }
    for (const Column::Cut& cut : a.cuts) {
      const auto next = nearest(b, cut.v);
      if (!next || cut.second == 0 || !(cut.second * next->second <= 0)) continue;
      if (const auto root = along({a.u, cut}, {b.u, *next})) found.push_back(*root);
    }
  }

 private:
  struct LinePoint {
    double u;
    Column::Cut cut;
  };

  /// Whether two columns cut the same lines, and no jump of the second function may lie between them.
  static bool alike(const Column& a, const Column& b) {
    const auto same = [](const Column::Cut& one, const Column::Cut& other) {
      return one.v.rising == other.v.rising && std::abs(one.second - other.second) < kLargeStep;
    };
    return std::equal(a.cuts.begin(), a.cuts.end(), b.cuts.begin(), b.cuts.end(), same);
  }

  static std::optional<Column::Cut> nearest(const Column& column, const LineRoot& v) {
    std::optional<Column::Cut> best;
    for (const Column::Cut& cut : column.cuts) {
      if (cut.v.rising != v.rising) continue;
      if (!best || std::abs(cut.v.at - v.at) < std::abs(best->v.at - v.at)) best = cut;
    }
    return best;
  }

  std::vector<LineRoot> cutsOf(double u, const SearchRange& range) const {
    return lineRoots([&](double v) { return first_(u, v); }, range, kOnLine * tolerance_);
  }

  /// The line's v at a u between two of its points.
  std::optional<double> lineAt(double u, const LinePoint& a, const LinePoint& b) const {
    const double across = b.cut.v.at - a.cut.v.at;
    const double expected = a.cut.v.at + (u - a.u) / (b.u - a.u) * across;
    const double around = v_.step() + std::abs(across);
    std::optional<double> best;
    for (const LineRoot& root : cutsOf(u, {expected - around, expected + around, kStepsAround})) {
      if (root.rising != a.cut.v.rising) continue;
      if (!best || std::abs(root.at - expected) < std::abs(*best - expected)) best = root.at;
    }
    return best;
  }

  std::optional<PlaneRoot> along(const LinePoint& a, const LinePoint& b) const {
    const auto f = [&](double u) {
      const auto v = lineAt(u, a, b);
      return v ? second_(u, *v) : kNone;
    };
    const double u = rootBetween(f, a.u, a.cut.second, b.u, b.cut.second, tolerance_);
    const auto v = std::isnan(u) ? std::nullopt : lineAt(u, a, b);
    if (!v) return std::nullopt;
    return PlaneRoot{u, *v};
  }

  const PlaneFunction& first_;
  const PlaneFunction& second_;
  SearchRange v_;
  double tolerance_;
};

}  // namespace

std::vector<LineRoot> lineRoots(const LineFunction& f, const SearchRange& range, double tolerance) {
  std::vector<LineRoot> roots;
  double before = range.from, f_before = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i <= range.steps; ++i) {
    const double here = range.at(i), f_here = f(here);
    if (std::abs(f_here) <= tolerance) {
      roots.push_back({here, f_before < 0});
    } else if (std::abs(f_before) > tolerance && (f_before < 0) != (f_here < 0) && !std::isnan(f_here)) {
      const double at = rootBetween(f, before, f_before, here, f_here, tolerance);
      if (!std::isnan(at)) roots.push_back({at, f_before < 0});
    }
    before = here, f_before = f_here;
  }
  return roots;
}

std::vector<PlaneRoot> planeRoots(const PlaneFunction& first, const PlaneFunction& second, const SearchRange& u,
                                  const SearchRange& v, double tolerance) {
  const PlaneSearch search(first, second, v, tolerance);
  std::vector<PlaneRoot> found;
  Column before = search.column(u.from);
  for (int i = 1; i <= u.steps; ++i) {
    Column here = search.column(u.at(i));
    search.between(before, here, kHalvings, found);
    before = std::move(here);
  }
  return found;
}

}  // namespace flute_grinder
