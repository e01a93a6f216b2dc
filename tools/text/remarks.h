#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "text/message.h"

namespace railstep {

/// The messages of a command beside its result: a line each on stderr, and with --json an entry
/// each of the result, so that a script needs stdout alone.
class Remarks {
 public:
  /// Adds a warning. A note asks or informs; a warning is about something that the run went
  /// without.
  void note(const std::optional<Message>& said) { add("note", said); }
  void warning(const Message& said) { add("warning", said); }
  /// Adds the reason why a command that ran did not reach what was asked.
  void error(const Message& said) { add("error", said); }
  [[nodiscard]] bool has_errors() const;
  /// Prints those that were not printed yet, in their order.
  void print();
  /// Adds `errors` and `warnings` to a command's result: [{"id": ..., "text": ...}, ...].
  void add_to(nlohmann::ordered_json& result) const;

 private:
  struct Remark {
    std::string word;  // of the line
    Message message;
  };
  void add(const char* word, const std::optional<Message>& said);

  std::vector<Remark> all_;
  std::size_t printed_ = 0;
};

/// Prints a command's result on stdout. Bytes that are not UTF-8, as a file's name may have, are
/// replaced.
void print_json(const nlohmann::ordered_json& result);

}  // namespace railstep
