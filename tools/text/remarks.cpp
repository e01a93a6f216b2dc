#include "text/remarks.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "text/message_json.h"
#include "text/one_line.h"

namespace railstep {
namespace {

constexpr std::string_view kError = "error";

}  // namespace

void Remarks::add(const char* word, const std::optional<Message>& said) {
  if (said) all_.push_back({word, *said});
}

bool Remarks::has_errors() const {
  return std::any_of(all_.begin(), all_.end(), [](const Remark& r) { return r.word == kError; });
}

void Remarks::print() {
  for (; printed_ < all_.size(); ++printed_)
    fmt::print(stderr, "{}: {}\n", all_[printed_].word, one_line(all_[printed_].message.line()));
}

void Remarks::add_to(nlohmann::ordered_json& result) const {
  std::vector<Message> errors, warnings;
  for (const Remark& remark : all_)
    (remark.word == kError ? errors : warnings).push_back(remark.message);
  result["errors"] = to_json(errors);
  result["warnings"] = to_json(warnings);
}

void print_json(const nlohmann::ordered_json& result) {
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  fmt::print("{}\n", result.dump(2, ' ', false, kReplace));
}

}  // namespace railstep
