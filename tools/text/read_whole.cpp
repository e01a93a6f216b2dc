// The errors of a file that is read whole are kept and thrown together.
#include <algorithm>
#include <iterator>
#include <set>
#include <string>
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

/// One error a place is enough: a key that stands for a missing one is unknown too, and a key may
/// be read twice. But two checks of a table may refuse it at its head.
bool repeats(const Kept& a, const Kept& b) {
  if (!a.source.path || !b.source.path || *a.source.path != *b.source.path) return false;
  const bool are_checks =
      a.is_refusal && b.is_refusal && a.messages.front().id != b.messages.front().id;
  return order(a) == order(b) && !are_checks;
}

[[noreturn]] void throw_in_order(std::vector<Kept> errors) {
  std::stable_sort(errors.begin(), errors.end(),
                   [](const Kept& a, const Kept& b) { return order(a) < order(b); });
  errors.erase(std::unique(errors.begin(), errors.end(), repeats), errors.end());
  std::vector<Message> messages;
  for (const Kept& error : errors)
    messages.insert(messages.end(), error.messages.begin(), error.messages.end());
  throw InputError(std::move(messages));
}

Kept kept_of(const InputError& error) {
  const auto* placed = dynamic_cast<const PlacedError*>(&error);
  return {placed ? placed->source : toml::source_region{}, error.messages(), true};
}

}  // namespace

void Table::finish() const {
  std::vector<Kept> unknown = unknown_keys(*view_->document, *view_->table, view_->name);
  if (!unknown.empty()) throw_in_order(std::move(unknown));
}

void Table::collect() const { view_->document->collects = true; }

bool Table::keep(const InputError& refusal) const {
  Document& document = *view_->document;
  if (!document.collects) return false;
  ++document.refused;
  if (!document.tainted) document.refusals.push_back(kept_of(refusal));
  return true;
}

std::size_t Table::refused() const { return view_->document->refused; }
std::size_t Table::bad_values() const { return view_->document->bad_values.size(); }
bool Table::is_tainted() const { return view_->document->tainted; }
void Table::set_tainted(bool tainted) const { view_->document->tainted = tainted; }

void Table::end_part() const { throw Ended(); }

void Table::leave_open() const { view_->document->doubtful.insert(view_->table); }

void Table::leave_open(std::string_view key) const {
  if (!has(key)) return;
  const toml::node& node = *view_->table->get(key);
  if (const toml::table* table = node.as_table()) view_->document->doubtful.insert(table);
  if (const toml::array* array = node.as_array())
    for (const toml::node& entry : *array)
      if (const toml::table* table = entry.as_table()) view_->document->doubtful.insert(table);
}

void Table::throw_kept(bool ends_early, Names keys) const {
  Document& document = *view_->document;
  if (document.refused > 0 || !document.bad_values.empty())
    for (const std::string_view key : keys) static_cast<void>(has(key));
  if (ends_early) {  // no table below is sure to be read to its end
    const std::set<std::string, std::less<>> known = document.known[view_->table];
    for (const std::string& key : known) leave_open(key);
  }
  if (!ends_early || keys.size() > 0) {
    std::vector<Kept> unknown = unknown_keys(document, *view_->table, view_->name);
    std::move(unknown.begin(), unknown.end(), std::back_inserter(document.bad_values));
  }
  throw_faults();
}

void Table::throw_faults() const {
  Document& document = *view_->document;
  document.collects = false;
  std::vector<Kept> errors = std::exchange(document.bad_values, {});
  std::vector<Kept> refusals = std::exchange(document.refusals, {});
  std::move(refusals.begin(), refusals.end(), std::back_inserter(errors));
  if (!errors.empty()) throw_in_order(std::move(errors));
}

}  // namespace railstep
