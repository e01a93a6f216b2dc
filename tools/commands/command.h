#pragma once
#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "text/read.h"

namespace railstep {

/// Exit codes of the program: done; ran but did not reach what was asked; bad input or usage.
enum class Exit { done = 0, not_reached = 1, bad_input = 2 };

/// A subcommand: its parser and what it does once parsed.
struct Command {
  CLI::App* parser;
  std::function<Exit()> run;
};

/// Takes numbers from low to high, and names the range in short.
template <typename T>
CLI::Validator within(T low, T high) {
  const std::string accepted =
      fmt::format("{:g} to {:g}", static_cast<double>(low), static_cast<double>(high));
  return {[low, high, accepted](std::string& text) {
            T value{};
            const bool read = CLI::detail::lexical_cast(text, value);
            if (read && value >= low && value <= high) return std::string();
            return fmt::format("{} is out of range; expected {}", text.substr(0, 60), accepted);
          },
          accepted};
}

Command add_fit(CLI::App& app);
Command add_explain(CLI::App& app);
Command add_compare(CLI::App& app);
Command add_condense(CLI::App& app);
Command add_creep(CLI::App& app);
Command add_critical(CLI::App& app);
Command add_hard(CLI::App& app);
Command add_hil(CLI::App& app);
Command add_modes(CLI::App& app);
Command add_pareto(CLI::App& app);
Command add_profile(CLI::App& app);
Command add_receptance(CLI::App& app);
Command add_replay(CLI::App& app);
Command add_run(CLI::App& app);
Command add_static(CLI::App& app);
Command add_sweep(CLI::App& app);
Command add_tune(CLI::App& app);
Command add_rules(CLI::App& app);

}  // namespace railstep
