#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <stdexcept>

namespace railstep {

/// Exit codes of the program: done; ran but did not reach what was asked; bad input or usage.
enum class Exit { done = 0, not_reached = 1, bad_input = 2 };

/// Bad input, in one sentence that names file, line or key, what was found and what is accepted.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A subcommand: its parser and what it does once parsed.
struct Command {
  CLI::App* parser;
  std::function<Exit()> run;
};

Command add_fit(CLI::App& app);

}  // namespace railstep
