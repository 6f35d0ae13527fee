#pragma once

#include "flute_grinder/base/units.h"
#include "flute_grinder/job/grind_job.h"
#include "flute_grinder/job/job_file.h"

/// @file
/// The jobs that the benchmarks measure.
namespace grinder {

/// The paper's cutter, as in jobs/paper.yaml, at a feed of its own.
inline GrindJob paperJob(double feed_mm_min, EvenStepRule rule = EvenStepRule::kPublished) {
  GrindJob job = readJobFile("jobs/paper.yaml");
  job.process().feed = feed_mm_min * units::kMillimetrePerMinute;
  job.interpolation.even_step = rule;
  return job;
}

/// The same with ten teeth in twenty passes: some twelve million setpoints.
inline GrindJob wholeToolJob() {
  GrindJob job = paperJob(52);
  for (int tooth = 1; tooth < 10; ++tooth) job.tooth_angles.push_back(tooth * 36 * units::kDegree);
  job.process().infeed = job.process().depth / 20;
  // A wheel that leaves land between ten flutes, whatever tool it grinds. The motion is the same with any wheel.
  job.process().wheel_width = 1.5 * units::kMillimetre;
  CutterGeometry& cutter = job.cutter;
  cutter.rake_tolerance = cutter.chordal_rake_tolerance = cutter.spiral_tolerance = 180 * units::kDegree;
  cutter.core_tolerance = cutter.end_diameter;
  job.process().incomplete_ok = true;
  return job;
}

}  // namespace grinder
