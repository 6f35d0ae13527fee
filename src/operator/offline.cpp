#include "flute_grinder/operator/offline.h"

#include "flute_grinder/core/job_file.h"
#include "flute_grinder/core/units.h"
#include "flute_grinder/operator/csv.h"
#include "flute_grinder/operator/machine_file.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace flute_grinder {

namespace {

using namespace units;

/// Prints the rows of a table, and remembers the largest errors.
class Table {
 public:
  Table(const LogCurve& curve, const std::string& csv) : curve_(curve) {
    if (!csv.empty()) csv_.emplace(csv);
    std::printf("%6s  %12s  %10s  %10s  %12s\n", "point", "X mm", "A rad", "theory rad", "error 1e-4");
  }

  void row(int number, const CurvePoint& point) {
    const double theory = curve_.a(point.x);
    const double error = theory - point.a;
    std::printf("%6d  %12.4f  %10.4f  %10.4f  %12.4f\n", number, point.x / kMillimetre, point.a, theory, error / 1e-4);
    if (csv_) csv_->write(number, point, theory);
    double& largest = number % 2 == 1 ? largest_odd_ : largest_even_;
    largest = std::max(largest, std::abs(error));
  }

  void finish(int points) {
    std::printf("\n%d points\n", points);
    std::printf("largest error          %.4e rad\n", std::max(largest_odd_, largest_even_));
    std::printf("largest at odd points  %.4e rad\n", largest_odd_);
    std::printf("largest at even points %.4e rad\n", largest_even_);
    if (csv_) csv_->close();
  }

 private:
  LogCurve curve_;
  std::optional<TableCsv> csv_;
  double largest_odd_ = 0;
  double largest_even_ = 0;
};

}  // namespace

int runTable(const TableOptions& options) {
  const GrindJob job = readJobFile(options.job);
  const LogCurve curve{ConicalCutter(job.cutter)};
  OddEvenInterpolator interpolator(curve, job.interpolation.rotary_scale,
                                   options.even_step.value_or(job.interpolation.even_step), 0);
  Table table(curve, options.csv);
  table.row(0, interpolator.position());
  int points = 0;
  while (interpolator.position().x < job.cutter.flute_length) {
    const double x = interpolator.position().x;
    const OddEvenPair pair = interpolator.next(options.step_length_mm * kMillimetre);
    if (!(pair.even.x > x && curve.u(pair.odd.x) > 0 && curve.u(pair.even.x) > 0 && std::isfinite(pair.even.a))) {
      std::fprintf(stderr, "--step-length %g mm is too long for this curve at X = %g mm\n", options.step_length_mm,
                   x / kMillimetre);
      return 1;
    }
    table.row(++points, pair.odd);
    table.row(++points, pair.even);
  }
  table.finish(points);
  return 0;
}

void printStatistics(const PlanStatistics& s) {
  std::printf("setpoints            %llu\n", static_cast<unsigned long long>(s.setpoints));
  std::printf("duration             %.3f s:", s.duration);
  for (int i = 0; i < kMoveKindCount; ++i) {
    const double duration = s.move_duration[static_cast<std::size_t>(i)];
    if (duration > 0) std::printf(" %s %.3f", toString(static_cast<MoveKind>(i)), duration);
  }
  std::printf("\nlargest odd error    %.4e rad\n", s.max_odd_error);
  std::printf("largest even error   %.4e rad\n", s.max_even_error);
  std::printf("largest deviation    %.3g um at the cutter's surface\n", s.max_deviation / kMicrometre);
  if (s.max_feed > 0) {
    std::printf("feed held            %.6f to %.6f mm/min\n", s.min_feed / kMillimetrePerMinute,
                s.max_feed / kMillimetrePerMinute);
  } else {
    std::printf("feed held            never reached\n");
  }
  for (const FeedCut& cut : s.feed_cuts) {
    std::printf("feed limited by      %s, X %.3f to %.3f mm\n", cut.cause.c_str(), cut.from / kMillimetre,
                cut.to / kMillimetre);
  }
  const auto axes = [](const char* name, const Axes& v, const char* linear, const char* rotary) {
    std::printf("%-20s X %.5g  Y %.5g  Z %.5g %s  A %.5g %s\n", name, v[kX] / kMillimetre, v[kY] / kMillimetre,
                v[kZ] / kMillimetre, linear, v[kA] / kDegree, rotary);
  };
  axes("largest velocity", s.max_velocity, "mm/s", "deg/s");
  axes("largest acceleration", s.max_acceleration, "mm/s^2", "deg/s^2");
  axes("largest jerk", s.max_jerk, "mm/s^3", "deg/s^3");
  axes("odd-even ripple", s.ripple_acceleration, "mm/s^2", "deg/s^2");
}

int runPlan(const PlanOptions& options) {
  const GrindJob job = readJobFile(options.job);
  const Machine machine = readMachineFiles(options.parameters, options.urdf).machine;
  std::optional<SetpointCsv> csv;
  std::function<void(const Setpoint&)> visit;
  if (!options.csv.empty()) {
    csv.emplace(options.csv, machine.period);
    visit = [&](const Setpoint& p) { csv->write(p); };
  }
  const JobPlan plan = planJob(job, machine, machine.park, {}, visit, UnitSystem::kShop);
  if (csv) csv->close();
  printStatistics(plan.statistics);
  for (const std::string& reason : plan.reasons) std::fprintf(stderr, "%s\n", reason.c_str());
  return plan.good() ? 0 : 1;
}

}  // namespace flute_grinder
