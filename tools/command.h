#pragma once
#include <CLI/CLI.hpp>
#include <functional>

#include "read.h"

namespace railstep {

/// Exit codes of the program: done; ran but did not reach what was asked; bad input or usage.
enum class Exit { done = 0, not_reached = 1, bad_input = 2 };

/// A subcommand: its parser and what it does once parsed.
struct Command {
  CLI::App* parser;
  std::function<Exit()> run;
};

Command add_fit(CLI::App& app);
Command add_compare(CLI::App& app);
Command add_condense(CLI::App& app);
Command add_hard(CLI::App& app);
Command add_hil(CLI::App& app);
Command add_modes(CLI::App& app);
Command add_pareto(CLI::App& app);
Command add_receptance(CLI::App& app);
Command add_replay(CLI::App& app);
Command add_run(CLI::App& app);
Command add_static(CLI::App& app);
Command add_sweep(CLI::App& app);
Command add_tune(CLI::App& app);
Command add_rules(CLI::App& app);

}  // namespace railstep
