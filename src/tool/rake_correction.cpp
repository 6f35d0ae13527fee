#include "tool/rake_correction.h"

#include "flute_grinder/base/units.h"

#include <Eigen/Dense>

#include <cmath>

namespace grinder {

namespace {

constexpr int kPieces[] = {4, 8, ZCorrection::kMaxPieces};
constexpr int kCorrectedSections = 48;  ///< number of sections in which the rake is corrected
constexpr int kSteps = 6;               ///< steps of Newton's method for one number of pieces
constexpr double kGoodEnough = 0.001 * units::kDegree;
constexpr double kDerivativeStep = 1e-6;  ///< step for derivatives by a coefficient, as a fraction of the radius
constexpr double kSmooth = 1e-3;          ///< weight of the coefficients' third differences against the rake

/// Computes the correction for a right-hand cutter.
class Correction {
 public:
  Correction(const ConicalCutter& cutter, const WheelProfile& wheel, double nominal_radius, const WheelSetup& setup,
             const GrindStroke& stroke, double rake, const PlanWatch& watch)
      : cutter_(cutter),
        wheel_(wheel),
        nominal_radius_(nominal_radius),
        setup_(setup),
        stroke_(stroke),
        rake_(rake),
        watch_(watch) {}

  std::optional<RakeCorrection> solve() const {
    std::optional<RakeCorrection> best;
    for (const int pieces : kPieces) {
      ZCorrection z;
      z.from = std::min(stroke_.from, stroke_.to);
      z.piece = std::abs(stroke_.to - stroke_.from) / pieces;
      z.pieces = pieces;
      for (int i = 0; i <= kSteps; ++i) {
        const Eigen::VectorXd errors = rakeErrors(z);
        if (!errors.allFinite()) break;
        const RakeCorrection here{z, rake_ + errors.minCoeff(), rake_ + errors.maxCoeff()};
        if (!best || maxError(here) < maxError(*best)) best = here;
        if (maxError(*best) < kGoodEnough) return best;
        improve(z, errors);
      }
    }
    return best;
  }

 private:
  void goOn() const {
    if (watch_ && !watch_(0)) throw ReasonError(Reason{ReasonKind::kGivenUp});
  }

  double maxError(const RakeCorrection& c) const {
    return std::max(std::abs(c.min_rake - rake_), std::abs(c.max_rake - rake_));
  }

  /// The rake less the asked rake, in sections over the flute; not finite where there is no flute.
  Eigen::VectorXd rakeErrors(const ZCorrection& z) const {
    goOn();
    GrindStroke stroke = stroke_;
    stroke.z_correction = z;
    const WheelSweep sweep(cutter_, wheel_, nominal_radius_, setup_, stroke);
    Eigen::VectorXd errors(kCorrectedSections + 1);
    for (int i = 0; i <= kCorrectedSections; ++i) {
      const double x = cutter_.cone().flute_length * i / kCorrectedSections;
      const double r = cutter_.radius(x);
      const auto wall = sweep.wall(x, r, true);
      errors[i] = wall ? std::atan(-r * wall->slope) - rake_ : std::nan("");
    }
    return errors;
  }

  /// A least-squares step of Newton's method, with coefficients kept smooth where the rake does not determine them.
  void improve(ZCorrection& z, const Eigen::VectorXd& errors) const {
    const int n = z.coefficientCount();
    const double h = kDerivativeStep * cutter_.radius(0);
    const double weight = kSmooth / cutter_.radius(0);
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(errors.size() + n - 3, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(a.rows());
    b.head(errors.size()) = -errors;
    for (int k = 0; k < n; ++k) {
      ZCorrection moved = z;
      moved.coefficients[static_cast<std::size_t>(k)] += h;
      a.col(k).head(errors.size()) = (rakeErrors(moved) - errors) / h;
    }
    for (int k = 0; k + 3 < n; ++k) {
      const auto row = errors.size() + k;
      a.row(row).segment(k, 4) << -weight, 3 * weight, -3 * weight, weight;
      for (int j = k; j < k + 4; ++j) b[row] -= a(row, j) * z.coefficients[static_cast<std::size_t>(j)];
    }
    if (!a.allFinite()) return;
    const Eigen::VectorXd step = a.completeOrthogonalDecomposition().solve(b);
    for (int k = 0; k < n; ++k) z.coefficients[static_cast<std::size_t>(k)] += step[k];
  }

  ConicalCutter cutter_;
  WheelProfile wheel_;
  double nominal_radius_;
  WheelSetup setup_;
  GrindStroke stroke_;
  double rake_;
  const PlanWatch& watch_;
};

}  // namespace

std::optional<RakeCorrection> correctRake(const ConicalCutter& cutter, const WheelProfile& wheel, double nominal_radius,
                                          const WheelSetup& setup, const GrindStroke& stroke, double rake,
                                          const PlanWatch& watch) {
  if (cutter.cone().cut == CutDirection::kLeftHand) {
    Cone right = cutter.cone();
    right.cut = CutDirection::kRightHand;
    right.spiral_angle *= -1;
    GrindStroke right_stroke = stroke;
    right_stroke.a *= -1;
    auto result = correctRake(ConicalCutter(right), wheel.mirrored(), nominal_radius,
                              {-setup.swivel, -setup.height, setup.x_shift}, right_stroke, rake, watch);
    if (result) {
      for (double& c : result->z.coefficients) c = -c;
    }
    return result;
  }
  return Correction(cutter, wheel, nominal_radius, setup, stroke, rake, watch).solve();
}

}  // namespace grinder
