#pragma once

#include "flute_grinder/GrinderState.h"

namespace grinder {

/// Whether `wheel_in_work` is only a precaution, because the journal has not been read.
inline bool isWheelUnknown(const flute_grinder::GrinderState& state) {
  return state.wheel_in_work != 0 && !state.journal_error.empty() && state.progress.job_digest.empty();
}

}  // namespace grinder
