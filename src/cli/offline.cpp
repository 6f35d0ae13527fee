#include "cli/offline.h"

#include "cli/csv.h"
#include "cli/json_output.h"
#include "cli/machine_file.h"
#include "cli/tool_output.h"
#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/curve/step_table.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/messages/conversions.h"
#include "flute_grinder/messages/plan_result.h"

#include <cstdio>

namespace grinder {

namespace {

using namespace units;

void printText(const StepTable& table) {
  std::printf("%6s  %12s  %10s  %10s  %12s\n", "point", "X mm", "A rad", "theory rad", "error 1e-4");
  int number = 0;
  for (const StepTable::Row& row : table.rows) {
    std::printf("%6d  %12.4f  %10.4f  %10.4f  %12.4f\n", number++, row.point.x / kMillimetre, row.point.a, row.theory,
                row.error() / 1e-4);
  }
  std::printf("\n%d points\n", number - 1);
  std::printf("maximum error          %.4e rad\n", table.maxError());
  std::printf("maximum at odd points  %.4e rad\n", table.max_odd_error);
  std::printf("maximum at even points %.4e rad\n", table.max_even_error);
}

Json toJson(const StepTable& table, EvenStepRule rule, double step_length_mm) {
  Json points = Json::array();
  for (const StepTable::Row& row : table.rows) {
    points.push_back(Json{{"point", points.size()},
                          {"x_mm", row.point.x / kMillimetre},
                          {"a_rad", row.point.a},
                          {"a_theory_rad", row.theory},
                          {"error_rad", row.error()}});
  }
  return {{"step_length_mm", step_length_mm},
          {"even_step", toString(rule)},
          {"points", points},
          {"max_error_rad", table.maxError()},
          {"max_odd_error_rad", table.max_odd_error},
          {"max_even_error_rad", table.max_even_error}};
}

void writeCsv(const StepTable& table, TableCsv& csv) {
  int number = 0;
  for (const StepTable::Row& row : table.rows) csv.write(number++, row.point, row.theory);
  csv.close();
}

void printStatistics(const PathStatistics& s) {
  std::printf("setpoints            %llu\n", static_cast<unsigned long long>(s.setpoints));
  std::printf("duration             %.3f s:", s.duration);
  for (const MoveRow& move : kMoveKinds) {
    const double duration = s.move_duration[static_cast<std::size_t>(move.value)];
    if (duration > 0) std::printf(" %s %.3f", move.name, duration);
  }
  std::printf("\nmaximum odd error    %.4e rad\n", s.max_odd_error);
  std::printf("maximum even error   %.4e rad\n", s.max_even_error);
  std::printf("maximum deviation    %.3g um at the cutter's surface\n", s.max_deviation / kMicrometre);
  if (s.max_feed > 0) {
    std::printf("feed constancy       %.6f to %.6f mm/min\n", s.min_feed / kMillimetrePerMinute,
                s.max_feed / kMillimetrePerMinute);
  } else {
    std::printf("feed constancy       never reached\n");
  }
  for (const flute_grinder::FeedLimit& limit : toMessage(s).feed_limits) {
    std::printf("feed limited by      %s\n", escaped(grinder::text(limit)).c_str());
  }
  const auto axes = [](const char* name, const Axes& v, const char* linear, const char* rotary) {
    std::printf("%-20s X %.5g  Y %.5g  Z %.5g %s  A %.5g %s\n", name, v[kX] / kMillimetre, v[kY] / kMillimetre,
                v[kZ] / kMillimetre, linear, v[kA] / kDegree, rotary);
  };
  axes("maximum velocity", s.max_velocity, "mm/s", "deg/s");
  axes("maximum acceleration", s.max_acceleration, "mm/s^2", "deg/s^2");
  axes("maximum jerk", s.max_jerk, "mm/s^3", "deg/s^3");
  axes("odd-even ripple", s.ripple_acceleration, "mm/s^2", "deg/s^2");
}

}  // namespace

int runTable(const TableOptions& options) {
  const GrindJob job = readJobFile(options.job, toString(OperationKind::kFlute));
  std::optional<TableCsv> csv;
  if (!options.csv.empty()) csv.emplace(options.csv);
  const EvenStepRule rule = options.even_step.value_or(job.interpolation.even_step);
  const StepTable table = interpolateBySteps(ConicalCutter(job.cutter), job.interpolation.rotary_scale, rule,
                                             options.step_length_mm * kMillimetre);
  if (!table.complete) {
    std::fprintf(stderr, "--step-length %g mm is too long for this curve at X = %g mm\n", options.step_length_mm,
                 table.rows.back().point.x / kMillimetre);
    return 1;
  }
  if (csv) writeCsv(table, *csv);
  if (options.json) {
    print(toJson(table, rule, options.step_length_mm));
  } else {
    printText(table);
  }
  return 0;
}

void printPlan(const flute_grinder::PlanReport& plan) {
  if (plan.statistics.setpoints == 0) return;
  printStatistics(fromMessage(plan.statistics));
  for (const flute_grinder::ToolFigure& figure : plan.figures) printFigure(fromMessage(figure));
  if (plan.complete[0] <= plan.complete[1]) {
    std::printf("%-20s X %.3f to %.3f mm\n", "flutes complete", plan.complete[0] / kMillimetre,
                plan.complete[1] / kMillimetre);
  }
  const std::string closest = closestText(plan);
  if (!closest.empty()) std::printf("%-20s %s\n", "closest", escaped(closest).c_str());
  if (plan.shank_cut > 0) {
    std::printf("%-20s %.3f mm more than the infeed, by the first pass beyond the flute's end\n",
                "cut out of the shank", plan.shank_cut / kMillimetre);
  }
  if (!plan.passes.empty()) {
    std::printf("%-20s depth, area removed from a section of a tooth, removal rate\n", "passes");
  }
  for (std::size_t i = 0; i < plan.passes.size(); ++i) {
    std::printf("%-20s %s\n", format("pass %zu", i + 1).c_str(), passText(plan, i).c_str());
  }
}

int runPlan(const PlanOptions& options) {
  const ValidJob job(readJobFile(options.job, options.operation));
  const MachineFiles files = readMachineFiles({options.parameters}, options.urdf);
  const Machine& machine = files.config.loop.machine;
  std::optional<SetpointCsv> csv;
  std::function<void(const Setpoint&)> visit;
  if (!options.csv.empty()) {
    csv.emplace(options.csv);
    visit = [&](const Setpoint& p) { csv->write(p, machine.period); };
  }
  PlannedJob plan = planWholeJob(job, machine, MachineShapes(files.model), machine.park, visit);
  if (csv) csv->close();
  measurePasses(plan);
  if (options.json) {
    Json json = toJson(plan);
    json["shank_cut_mm"] = shankCut(job->cutter) / kMillimetre;
    print(json);
  } else {
    printPlan(resultOf(plan).plan);
  }
  for (const Reason& reason : plan.reasons) {
    std::fprintf(stderr, "%s\n", text(reason).c_str());
  }
  return plan.good() ? 0 : 1;
}

}  // namespace grinder
