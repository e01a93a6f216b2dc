#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace railstep {

/// The meaning of a message or a status bit, and the advice on it.
struct Explanation {
  std::string_view id;    // "E-SUPPORT-03", "W-RUN-01", "off_rail"
  std::string_view text;  // Markdown
};

/// All of docs/messages, in the order of its files.
std::vector<Explanation> explanations();

/// Up to the first full stop, in one line.
std::string first_sentence(const Explanation& explanation);

/// The files of docs/messages, as the build took them in.
std::span<const std::string_view> message_pages();

}  // namespace railstep
