#include "online/model/names.h"

namespace railstep {

namespace {

Name first_of(const char* text, std::size_t bytes) noexcept {
  std::size_t length = 0;
  while (length < bytes && text[length] != '\n') ++length;
  return {text, length};
}

/// Calls visit(index, name) for each until one returns true.
template <typename Visit>
void for_names(const Names& names, Visit visit) noexcept {
  const char* at = names.text;
  std::size_t left = names.bytes;
  for (std::int32_t i = 0; i < names.count; ++i) {
    const Name found = first_of(at, left);
    if (visit(i, found)) return;
    const std::size_t used = found.bytes < left ? found.bytes + 1 : left;
    at += used;
    left -= used;
  }
}

Names names_in(const char* text, std::size_t bytes) noexcept {
  std::int32_t count = bytes > 0 ? 1 : 0;
  for (std::size_t i = 0; i < bytes; ++i) count += text[i] == '\n' ? 1 : 0;
  return {text, bytes, count};
}

}  // namespace

bool split_names(const char* text, std::size_t bytes, Names& columns, Names& inputs) noexcept {
  std::size_t end = 0;
  while (end + 1 < bytes && !(text[end] == '\n' && text[end + 1] == '\n')) ++end;
  const bool both = end + 1 < bytes;
  columns = names_in(text, both ? end : bytes);
  inputs = both ? names_in(text + end + 2, bytes - end - 2) : Names{text, 0, 0};
  bool named = bytes < (std::size_t{1} << 30);
  const auto look = [&](std::int32_t, Name name) noexcept {
    named = named && name.bytes > 0;
    return false;
  };
  for_names(columns, look);
  for_names(inputs, look);
  return named;
}

Name name_at(const Names& names, std::int32_t index) noexcept {
  Name wanted{names.text, 0};
  for_names(names, [&](std::int32_t i, Name name) noexcept {
    if (i == index) wanted = name;
    return i == index;
  });
  return wanted;
}

std::int32_t find_name(const Names& names, const char* name) noexcept {
  std::int32_t wanted = -1;
  for_names(names, [&](std::int32_t i, Name own) noexcept {
    std::size_t k = 0;
    while (k < own.bytes && name[k] == own.text[k]) ++k;  // a zero in `name` ends it too
    if (k == own.bytes && name[k] == 0) wanted = i;
    return wanted >= 0;
  });
  return wanted;
}

}  // namespace railstep
