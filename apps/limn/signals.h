// SIGINT, SIGTERM and SIGHUP: end at once, leave nothing half-written, say 128 + n.
#pragma once

namespace limn::program {

/// From now on a thread of its own waits for the signals that end a run, removes temporary files and ends the process.
/// Call before any other thread starts, so that all inherit the mask. A signal that the parent ignores stays ignored.
void endOnSignals();

}  // namespace limn::program
