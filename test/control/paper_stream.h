#pragma once

#include "flute_grinder/motion/setpoint_stream.h"

namespace grinder::test_support {

/// The paper's job. @param start in work coordinates [m], A [rad].
SetpointStream paperStream(const Machine& machine, const Axes& start);

}  // namespace grinder::test_support
