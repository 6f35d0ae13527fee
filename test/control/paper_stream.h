#pragma once

#include "flute_grinder/motion/setpoint_stream.h"

namespace grinder::test_support {

/// The paper's job.
SetpointStream paperStream(const Machine& machine, const RunStart& run);

}  // namespace grinder::test_support
