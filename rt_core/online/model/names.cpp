#include "online/model/names.h"

#include <initializer_list>

namespace railstep {

namespace {

Name first_of(const char* text, std::size_t bytes) noexcept {
  std::size_t length = 0;
  while (length < bytes && text[length] != '\n') ++length;
  return {text, length};
}

/// Calls visit(index, name) for each name until one call returns true.
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

bool is_plain(Name name) noexcept {
  for (std::size_t i = 0; i < name.bytes; ++i) {
    const char c = name.text[i];
    if (!((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
          c == '-' || c == '.'))
      return false;
  }
  return name.bytes > 0;
}

/// FNV-1a with a mixed last step, as only the lowest bits choose a place.
std::uint64_t hash_of(Name name) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (std::size_t i = 0; i < name.bytes; ++i)
    hash = (hash ^ static_cast<unsigned char>(name.text[i])) * 0x100000001b3ULL;
  return (hash ^ hash >> 32) | 1u;  // never 0, which is an empty place
}

/// Whether no two names are equal, by their hashes. There is no memory for all of them: it takes
/// one share of the names after another, each in a table that it half fills.
bool are_distinct(const Names& names) noexcept {
  constexpr std::uint64_t kPlaces = 1024, kShare = kPlaces / 2;
  const auto shares = static_cast<std::uint64_t>(names.count) / (kShare / 2) + 1;
  bool distinct = true;
  for (std::uint64_t share = 0; share < shares && distinct; ++share) {
    std::uint64_t place[kPlaces] = {}, held = 0;
    for_names(names, [&](std::int32_t, Name name) noexcept {
      const std::uint64_t hash = hash_of(name);
      if ((hash >> 32) % shares != share) return false;
      std::uint64_t at = hash / 2 % kPlaces;
      while (place[at] != 0 && place[at] != hash) at = (at + 1) % kPlaces;
      // A share of twice its expected size does not happen by chance.
      distinct = place[at] != hash && ++held <= kShare;
      place[at] = hash;
      return !distinct;
    });
  }
  return distinct;
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
  if (bytes >= (std::size_t{1} << 30)) return false;
  bool named = true;
  const auto look = [&](std::int32_t, Name name) noexcept {
    named = named && is_plain(name);
    return !named;
  };
  for (const Names* const names : {&columns, &inputs}) {
    for_names(*names, look);
    if (named && names->count <= kMostCompared) named = are_distinct(*names);
  }
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
    while (k < own.bytes && name[k] == own.text[k]) ++k;  // a zero in `name` ends the loop too
    if (k == own.bytes && name[k] == 0) wanted = i;
    return wanted >= 0;
  });
  return wanted;
}

}  // namespace railstep
