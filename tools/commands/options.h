#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "study/outputs.h"
#include "study/setting.h"

namespace railstep {

// Tags of options whose value names a file, for Option::check(): what the command does with it.
// They accept every value; arguments.h refuses what cannot be.
CLI::Validator reads_file();
CLI::Validator writes_file();
CLI::Validator makes_folder();

bool is_read(CLI::Option& option);
/// Also where it makes a folder.
bool is_written(CLI::Option& option);
bool is_folder(CLI::Option& option);

/// --set.
void add_overrides(CLI::App& command, std::vector<std::string>& overrides);

/// The words of a command's help for what a study tries and judges.
struct StudyHelp {
  const char *models, *schemes, *outputs;
};
/// --set, --models, --meshes, --schemes, --steps, --output and --from.
void add_study(CLI::App& command, const StudyHelp& help, std::vector<std::string>& overrides,
               Choices& choices, Judged& judged);

}  // namespace railstep
