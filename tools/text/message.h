#pragma once
#include <stdexcept>
#include <string>
#include <vector>

#include "offline/math/refuse.h"

namespace railstep {

/// An error or a warning: what is wrong, in one sentence, and the name of the message.
struct Message {
  std::string id, text;
  Message(MessageId name, std::string sentence) : id(name.name()), text(std::move(sentence)) {}
  [[nodiscard]] std::string line() const { return text + " [" + id + "]"; }
};

/// Bad input: one message or several. Each names file, line or key, what was found and what is
/// expected. what() is the first of them and the number of the others.
class InputError : public std::runtime_error {
 public:
  InputError(MessageId id, const std::string& sentence)
      : InputError(std::vector{Message(id, sentence)}) {}
  /// A refusal of the offline side with its place: "place: sentence".
  template <typename Standard>
  InputError(const std::string& place, const WithId<Standard>& refused)
      : InputError(refused.id(), place + ": " + refused.sentence()) {}
  /// @param messages  one or more
  explicit InputError(std::vector<Message> messages);
  [[nodiscard]] const std::vector<Message>& messages() const { return messages_; }
  /// The same with " (where)" behind each sentence.
  [[nodiscard]] InputError met(const std::string& where) const;

 private:
  std::vector<Message> messages_;
};

}  // namespace railstep
