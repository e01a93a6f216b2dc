#pragma once
#include <filesystem>
#include <string>

namespace railstep {

// The files that this run of the program reads and writes, so that no output replaces a file that
// is read. Links, and several names of one file, count as the file that they lead to; devices and
// pipes do not count. May be called from any thread.

/// Announces an output before anything is read. Reading it later is then refused at once, and not
/// only at the end of a long run, when the output is written.
void announce_output(const std::string& option, const std::filesystem::path& file);

/// Notes a file that is read. Throws InputError where it was announced as an output.
void note_read_file(const std::filesystem::path& file);

/// Throws InputError where a file to be written has been read.
void refuse_read_file(const std::filesystem::path& file);

}  // namespace railstep
