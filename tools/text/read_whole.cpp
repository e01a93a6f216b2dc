// The errors of a file that is read whole are kept and thrown together.
#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "text/read.h"
#include "text/read_document.h"

namespace railstep {
namespace {

/// Where an error belongs: in the file's order, then what --set gave, then errors of other files.
auto order(const Kept& error) {
  const toml::source_region& at = error.source;
  const bool is_option = at.path && at.path->starts_with("--set");
  return std::tuple(!at.path, is_option, at.begin.line, at.begin.column);
}

/// A key that stands for a missing one is unknown too: one error a place is enough.
bool same_place(const Kept& a, const Kept& b) {
  return a.source.path && b.source.path && *a.source.path == *b.source.path && order(a) == order(b);
}

[[noreturn]] void throw_in_order(std::vector<Kept> errors) {
  std::stable_sort(errors.begin(), errors.end(),
                   [](const Kept& a, const Kept& b) { return order(a) < order(b); });
  errors.erase(std::unique(errors.begin(), errors.end(), same_place), errors.end());
  std::vector<Message> messages;
  for (const Kept& error : errors)
    messages.insert(messages.end(), error.messages.begin(), error.messages.end());
  throw InputError(std::move(messages));
}

Kept kept_of(const InputError& error) {
  const auto* placed = dynamic_cast<const PlacedError*>(&error);
  return {placed ? placed->source : toml::source_region{}, error.messages()};
}

}  // namespace

void Table::finish() const {
  std::vector<Kept> unknown = unknown_keys(*view_->document, *view_->table, view_->name);
  if (!unknown.empty()) throw_in_order(std::move(unknown));
}

void Table::collect() const { view_->document->collects = true; }

bool Table::keep(const InputError& refusal) const {
  if (!view_->document->collects) return false;
  view_->document->refusals.push_back(kept_of(refusal));
  return true;
}

void Table::stop_if_refused() const {
  if (view_->document->bad_values.empty() && !view_->document->refusals.empty())
    throw_in_order(std::exchange(view_->document->refusals, {}));
}

bool Table::is_faultless() const {
  return view_->document->bad_values.empty() && view_->document->refusals.empty();
}

void Table::throw_kept(const InputError* last) const {
  Document& document = *view_->document;
  if (last) {
    document.refusals.push_back(kept_of(*last));
  } else if (document.refusals.empty()) {
    // All was read: a key that no getter asked for is unknown.
    std::vector<Kept> unknown = unknown_keys(document, *view_->table, view_->name);
    std::move(unknown.begin(), unknown.end(), std::back_inserter(document.bad_values));
  }
  throw_faults();
}

void Table::throw_faults() const {
  Document& document = *view_->document;
  document.collects = false;
  std::vector<Kept> bad_values = std::exchange(document.bad_values, {});
  std::vector<Kept> refusals = std::exchange(document.refusals, {});
  if (!bad_values.empty()) throw_in_order(std::move(bad_values));
  if (!refusals.empty()) throw_in_order(std::move(refusals));
}

}  // namespace railstep
