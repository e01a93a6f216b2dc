#include <fmt/core.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <stdexcept>
#include <vector>

#include "build/cache_sizes.h"
#include "commands/arguments.h"
#include "commands/command.h"
#include "text/one_line.h"

/// The program: parses, runs the chosen subcommand, and turns errors into one line and exit code 2.
int main(int argc, char** argv) {
  using namespace railstep;
  fix_cache_sizes();
  // A file at the limit of its size is then a write that fails, as on a full disk, and is told.
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app{"railstep: real-time, fixed-step simulation of flexible railway track"};
  app.name("railstep");
  app.require_subcommand(1);
  const std::vector<Command> commands = {
      add_fit(app), add_static(app), add_modes(app),  add_receptance(app), add_condense(app),
      add_run(app), add_sweep(app),  add_replay(app), add_compare(app),    add_rules(app),
      add_hil(app), add_hard(app),   add_pareto(app), add_tune(app)};
  try {
    want_finite_numbers(app);
    refuse_empty_words(argc, argv);
    app.parse(argc, argv);
    for (const Command& command : commands)
      if (command.parser->parsed()) {
        refuse_same_files(*command.parser);
        refuse_impossible_places(*command.parser);
        const Exit exit = command.run();
        if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return static_cast<int>(exit);
        throw std::runtime_error(fmt::format("standard output: {}", std::strerror(errno)));
      }
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    fmt::print(stderr, "error: {}\n", usage_sentence(app, error));
    return static_cast<int>(Exit::bad_input);
  } catch (const InputError& error) {
    fmt::print(stderr, "error: {}\n", one_line(error.what()));
    return static_cast<int>(Exit::bad_input);
  } catch (const std::bad_alloc&) {  // says no more than its name
    fmt::print(
        stderr,
        "error: there is not enough memory, on this machine or under its limits (ulimit -v); "
        "accepted is a smaller scene, a shorter run, or fewer --jobs\n");
    return static_cast<int>(Exit::bad_input);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", one_line(error.what()));
    return static_cast<int>(Exit::not_reached);
  }
  return static_cast<int>(Exit::bad_input);
}
