#pragma once
#include <CLI/CLI.hpp>

#include "text/message.h"

namespace railstep {

/// Refuses empty words, which an unset variable of a shell leaves: CLI11 takes an empty number as
/// not given. Throws InputError.
void refuse_empty_words(int argc, const char* const* argv);

/// Makes every option that takes a number refuse text that is not a finite number. Call it after
/// all options are added.
void want_finite_numbers(CLI::App& app);

/// The message for a command line that was not understood, with the page of --help to read.
Message usage_message(const CLI::App& app, const CLI::ParseError& error);

/// Refuses, before anything is done, an output that is a folder, or that lies in a folder that does
/// not exist. Throws InputError.
void refuse_impossible_places(CLI::App& command);

/// Refuses, before anything is done, an output that an option reads, or that two options write, and
/// announces the other outputs: the files that the scene reads are not known yet (files.h). Throws
/// InputError.
void refuse_same_files(CLI::App& command);

}  // namespace railstep
