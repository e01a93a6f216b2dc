#pragma once
#include <cstdint>

namespace railstep {

/// Bytes that this process may still take, by what the machine has free and by the limits set to it
/// (ulimit -v, a container's); infinite where the system tells nothing.
double available_memory();

/// Throws InputError where a recording's inputs, which are held twice as they are written, do not
/// fit into the memory there is: before a run that would end without it.
void want_recording_memory(std::int64_t numbers);

}  // namespace railstep
