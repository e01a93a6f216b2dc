#include "text/message.h"

#include <fmt/core.h>

#include <utility>

namespace railstep {
namespace {

std::string summary(const std::vector<Message>& messages) {
  std::string first = messages.front().line();
  const std::size_t others = messages.size() - 1;
  if (others == 0) return first;
  return fmt::format("{} (and {} more error{})", first, others, others == 1 ? "" : "s");
}

}  // namespace

InputError::InputError(std::vector<Message> messages)
    : std::runtime_error(summary(messages)), messages_(std::move(messages)) {}

InputError InputError::met(const std::string& where) const {
  std::vector<Message> messages = messages_;
  for (Message& message : messages) message.text += " (" + where + ")";
  return InputError(std::move(messages));
}

}  // namespace railstep
