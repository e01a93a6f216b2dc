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
  const char* text;  // without a zero behind it
  std::size_t bytes;
};

/// Names of which it is looked at whether two are equal; of more it is not.
inline constexpr std::int32_t kMostCompared = 1 << 18;

/// A block's text into the columns of a trace and, behind an empty line, the inputs. Views.
/// @returns whether it is such a text: letters, digits, '_', '-' and '.' alone, which mean nothing
/// to a table or a terminal, and no two columns and no two inputs of one name; or nothing at all
bool split_names(const char* text, std::size_t bytes, Names& columns, Names& inputs) noexcept;

/// One of them; of no bytes where there is none.
Name name_at(const Names& names, std::int32_t index) noexcept;

/// Which of them equals a text that ends by a zero; -1: none.
std::int32_t find_name(const Names& names, const char* name) noexcept;

}  // namespace railstep
