// The run on a time line, for Perfetto (ui.perfetto.dev) or chrome://tracing.
#pragma once

#include <string>

#include "tools/stats.hpp"

namespace myriad::tools {

// Chrome trace event format: a CPU track (phases of the run, frames), one for the recording of passes, and a GPU track, in
// microseconds since the run began; list sizes and bytes as counters, a value a frame.
std::string trace_json(const RunRecord& run);

// What to add to the recorder's gpu_begin_ms to get its cpu_begin_ms' clock: nothing where the device shares the host's. Elsewhere no scope begins on the GPU before its
// recording ended, so the least offset that keeps this is taken: right for whichever scope waited least for its submission.
double gpu_offset_ms(const RunRecord& run);

}  // namespace myriad::tools
