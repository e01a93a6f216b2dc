#include <algorithm>
#include <cctype>

#include "commands/command.h"
#include "text/explanation.h"

namespace railstep {
namespace {

/// A word in the case of the ids: those of messages have capitals and a hyphen, those of status
/// bits neither.
std::string as_id(std::string word) {
  const bool is_message = word.find('-') != std::string::npos;
  std::transform(word.begin(), word.end(), word.begin(), [is_message](unsigned char c) {
    return static_cast<char>(is_message ? std::toupper(c) : std::tolower(c));
  });
  return word;
}

Exit run_explain(const std::string& word) {
  const std::vector<Explanation> all = explanations();
  const std::string id = as_id(word);
  if (id.empty()) {
    for (const Explanation& each : all) fmt::print("{:<20} {}\n", each.id, first_sentence(each));
    return Exit::done;
  }
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Explanation& each) { return each.id == id; });
  if (found == all.end()) {
    std::vector<std::string> ids;
    ids.reserve(all.size());
    for (const Explanation& each : all) ids.emplace_back(each.id);
    throw InputError("E-CLI-14", fmt::format("'{}' is not the id of a message or a status bit; did "
                                             "you mean '{}'? `railstep explain` lists all",
                                             word.substr(0, 60), nearest(id, ids)));
  }
  fmt::print("{}\n\n{}\n", found->id, found->text);
  return Exit::done;
}

}  // namespace

Command add_explain(CLI::App& app) {
  CLI::App* sub = app.add_subcommand(
      "explain", "Say more about an error, a warning or a status bit, or list all of them");
  auto id = std::make_shared<std::string>();
  sub->add_option("ID", *id, "the id at the end of a message, such as E-KEY-05");
  return {sub, [id] { return run_explain(*id); }};
}

}  // namespace railstep
