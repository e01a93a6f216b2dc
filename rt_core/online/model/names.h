#pragma once
#include <cstddef>
#include <cstdint>

namespace railstep {

/// Names in a block's text, one a line.
struct Names {
  const char* text;
  std::size_t bytes;
  std::int32_t count;
};
struct Name {
  const char* text;  // without a zero at its end
  std::size_t bytes;
};

/// Largest number of names that are checked for equal ones.
inline constexpr std::int32_t kMostCompared = 1 << 18;

/// Splits a block's text into the columns of a trace and, after an empty line, the inputs. Views.
/// @returns whether it is such a text: only letters, digits, '_', '-' and '.', which have no
/// meaning in a table or a terminal, no two columns and no two inputs of one name; or an empty text
bool split_names(const char* text, std::size_t bytes, Names& columns, Names& inputs) noexcept;

/// The name at an index; empty if the index is out of range.
Name name_at(const Names& names, std::int32_t index) noexcept;

/// Index of the name that equals a text with a zero at its end; -1 if there is none.
std::int32_t find_name(const Names& names, const char* name) noexcept;

}  // namespace railstep
