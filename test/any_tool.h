#pragma once

#include "flute_grinder/curve/conical_cutter.h"
#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/job_file.h"

#include <string>

namespace flute_grinder::test_support {

/// Asks for no edge, core and chord in particular.
inline void askForRakeAlone(CutterGeometry& g) {
  g.chordal_rake_tolerance = g.spiral_tolerance = units::kPi;
  g.core_diameter = g.core_diameter_end = 1e-6;
  g.core_tolerance = 0.1;
}

inline GrindJob jobOf(const std::string& name) { return readJobFile("jobs/" + name + ".yaml"); }

/// The paper's cutter by its published motion; any edge and core will do.
inline GrindJob paper() {
  GrindJob job = readJobFile("test/jobs/paper.yaml");
  askForRakeAlone(job.cutter);
  return job;
}

}  // namespace flute_grinder::test_support
