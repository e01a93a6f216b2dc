#pragma once
#include <CLI/CLI.hpp>

#include "text/message.h"

namespace railstep {

/// Refuses words without a letter, as an unset variable of a shell leaves them: CLI11 takes an
/// empty number for none. Throws InputError.
void refuse_empty_words(int argc, const char* const* argv);

/// Has every option that takes a number refuse what is not one, and what is not finite. To be
/// called once all options are there.
void want_finite_numbers(CLI::App& app);

/// What is wrong with a command line that was not understood, with the page of --help to read.
Message usage_message(const CLI::App& app, const CLI::ParseError& error);

/// Refuses, before anything is done, a file to be written that is a folder, or in none that is
/// there. Throws InputError.
void refuse_impossible_places(CLI::App& command);

/// Refuses, before anything is done, a file to be written that an option has read, or that two
/// options write, and announces the others: what the scene reads is not known yet (files.h). Throws
/// InputError.
void refuse_same_files(CLI::App& command);

}  // namespace railstep
