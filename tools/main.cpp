#include <fmt/core.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <vector>

#include "build/cache_sizes.h"
#include "commands/arguments.h"
#include "commands/command.h"
#include "offline/math/refuse.h"
#include "text/message_json.h"
#include "text/one_line.h"

namespace railstep {
namespace {

constexpr std::size_t kMostShown = 10;  // errors of one input

/// A line each on stderr; on stdout too, as one JSON object, where --json is among the words.
Exit report(const std::vector<Message>& errors, Exit exit, bool json) {
  const std::size_t shown = std::min(errors.size(), kMostShown);
  const std::vector<Message> first(errors.begin(),
                                   errors.begin() + static_cast<std::ptrdiff_t>(shown));
  for (const Message& error : first) fmt::print(stderr, "error: {}\n", one_line(error.line()));
  if (shown < errors.size()) fmt::print(stderr, "error: and {} more\n", errors.size() - shown);
  if (json) {
    const nlohmann::ordered_json all = {{"errors", to_json(first)},
                                        {"more", errors.size() - shown}};
    fmt::print("{}\n", all.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  }
  return exit;
}

Exit run(CLI::App& app, int argc, char** argv) {
  const std::vector<Command> commands = {
      add_fit(app),        add_static(app),   add_modes(app),  add_critical(app), add_creep(app),
      add_receptance(app), add_condense(app), add_run(app),    add_sweep(app),    add_replay(app),
      add_compare(app),    add_rules(app),    add_hil(app),    add_hard(app),     add_pareto(app),
      add_profile(app),    add_tune(app),     add_explain(app)};
  want_finite_numbers(app);
  refuse_empty_words(argc, argv);
  app.parse(argc, argv);
  for (const Command& command : commands)
    if (command.parser->parsed()) {
      refuse_same_files(*command.parser);
      refuse_impossible_places(*command.parser);
      const Exit exit = command.run();
      if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit;
      fail("E-FILE-20", fmt::format("standard output cannot be written: {}", std::strerror(errno)));
    }
  return Exit::bad_input;
}

/// The program's exit. Errors are told, each in one line.
Exit exit_of(CLI::App& app, int argc, char** argv) {
  const bool json = std::any_of(argv, argv + argc,
                                [](const char* word) { return std::strcmp(word, "--json") == 0; });
  try {
    return run(app, argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return static_cast<Exit>(app.exit(error));  // --help
    return report({usage_message(app, error)}, Exit::bad_input, json);
  } catch (const InputError& error) {
    return report(error.messages(), Exit::bad_input, json);
  } catch (const std::bad_alloc&) {  // says no more than its name
    return report({{"E-RUN-90",
                    "there is not enough memory, on this machine or under its limits (ulimit -v); "
                    "expected a smaller scene, a shorter run, or fewer --jobs"}},
                  Exit::bad_input, json);
  } catch (const Failed& error) {
    return report({{error.id(), error.sentence()}}, Exit::not_reached, json);
  } catch (const Refused& error) {
    return report({{error.id(), error.sentence()}}, Exit::bad_input, json);
  } catch (const std::exception& error) {
    return report({{"E-RUN-91", error.what()}}, Exit::not_reached, json);
  }
}

}  // namespace
}  // namespace railstep

int main(int argc, char** argv) {
  using namespace railstep;
  fix_cache_sizes();
  // A file at the limit of its size is then a write that fails, as on a full disk, and is told.
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app{"railstep: real-time, fixed-step simulation of flexible railway track"};
  app.name("railstep");
  app.require_subcommand(1);
  return static_cast<int>(exit_of(app, argc, argv));
}
