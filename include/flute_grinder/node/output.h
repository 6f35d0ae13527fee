#pragma once

namespace flute_grinder {

/// From now on what the process prints is dropped where nobody takes it, as after Ctrl-S in its terminal or with a full
/// pipe: otherwise a log line, one of roscpp's own threads too, would wait for it with all that hangs on its thread.
void dropOutputThatNobodyTakes();

}  // namespace flute_grinder
