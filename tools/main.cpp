#include <fmt/core.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "cache_sizes.h"
#include "command.h"

/// The program: parses, runs the chosen subcommand, and turns errors into one line and exit code 2.
int main(int argc, char** argv) {
  using namespace railstep;
  fix_cache_sizes();
  CLI::App app{"railstep: real-time, fixed-step simulation of flexible railway track"};
  app.name("railstep");
  app.require_subcommand(1);
  const std::vector<Command> commands = {
      add_fit(app), add_static(app), add_modes(app),  add_receptance(app), add_condense(app),
      add_run(app), add_sweep(app),  add_replay(app), add_compare(app),    add_rules(app),
      add_hil(app), add_pareto(app), add_tune(app)};
  try {
    app.parse(argc, argv);
    for (const Command& command : commands)
      if (command.parser->parsed()) {
        const Exit exit = command.run();
        if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return static_cast<int>(exit);
        throw std::runtime_error(fmt::format("standard output: {}", std::strerror(errno)));
      }
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : static_cast<int>(Exit::bad_input);  // CLI11's own codes start at 100
  } catch (const InputError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return static_cast<int>(Exit::bad_input);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return static_cast<int>(Exit::not_reached);
  }
  return static_cast<int>(Exit::bad_input);
}
