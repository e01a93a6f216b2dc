#pragma once
#include <cstdint>

namespace railstep {

/// Bytes that this process may still take: the least of the free memory of the machine and of the
/// limits (ulimit -v, a container's); infinite where the system does not say.
double available_memory();

/// Throws InputError where a recording's inputs, which are held twice as they are written, do not
/// fit into the free memory. It is called before the run.
void want_recording_memory(std::int64_t numbers);

}  // namespace railstep
