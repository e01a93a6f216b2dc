#include "commands/options.h"

#include "commands/command.h"

namespace railstep {
namespace {

constexpr const char* kReads = "reads a file";
constexpr const char* kWrites = "writes a file";
constexpr const char* kMakesFolder = "makes a folder";

/// A validator without a description does not show in --help.
CLI::Validator tag(const char* name) {
  return {[](std::string&) { return std::string(); }, "", name};
}

bool is_tagged(CLI::Option& option, const char* name) {
  try {
    return option.get_validator(name) != nullptr;
  } catch (const CLI::OptionNotFound&) {
    return false;
  }
}

}  // namespace

CLI::Validator reads_file() { return tag(kReads); }
CLI::Validator writes_file() { return tag(kWrites); }
CLI::Validator makes_folder() { return tag(kMakesFolder); }

bool is_read(CLI::Option& option) { return is_tagged(option, kReads); }
bool is_written(CLI::Option& option) { return is_tagged(option, kWrites) || is_folder(option); }
bool is_folder(CLI::Option& option) { return is_tagged(option, kMakesFolder); }

void add_overrides(CLI::App& command, std::vector<std::string>& overrides) {
  command.add_option("--set", overrides, "key.path=value, as if written in the scene; repeatable")
      ->take_all()
      ->allow_extra_args(false);
}

void add_study(CLI::App& command, const StudyHelp& help, std::vector<std::string>& overrides,
               Choices& choices, Judged& judged) {
  add_overrides(command, overrides);
  command.add_option("--models", choices.models, help.models)
      ->delimiter(',')
      ->type_name("MODEL,MODEL")
      ->allow_extra_args(false);
  command.add_option("--meshes", choices.meshes, "elements per bay, with commas")
      ->delimiter(',')
      ->type_name("INT,INT")
      ->allow_extra_args(false)
      ->check(within(1, 1000));
  command.add_option("--schemes", choices.schemes, help.schemes)
      ->delimiter(',')
      ->type_name("SCHEME,SCHEME")
      ->allow_extra_args(false);
  command.add_option("--steps", choices.steps, "s, with commas; each goes into a frame")
      ->delimiter(',')
      ->type_name("FLOAT,FLOAT")
      ->allow_extra_args(false);
  command.add_option("--output", judged.outputs, help.outputs)->take_all()->allow_extra_args(false);
  command.add_option("--from", judged.from, "leave out what comes before, s")
      ->check(within(0., 1e7));
}

}  // namespace railstep
