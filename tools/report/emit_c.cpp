#include "report/emit_c.h"

#include <fmt/core.h>

#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <string_view>

#include "online/model/load_model.h"

namespace railstep {
namespace {

using Bytes = std::vector<std::byte>;

template <typename T>
std::vector<T> values_of(const Bytes& block, std::uint64_t at, std::uint64_t bytes) {
  std::vector<T> values(static_cast<std::size_t>(bytes) / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), block.data() + at, values.size() * sizeof(T));
  return values;
}

std::string shown(std::uint64_t value) { return fmt::format("UINT64_C(0x{:x})", value); }
std::string shown(std::int64_t value) {
  // The least one has no literal of its own.
  return value == INT64_MIN ? "INT64_MIN" : fmt::format("INT64_C({})", value);
}
std::string shown(std::int32_t value) {
  return value == INT32_MIN ? "INT32_MIN" : fmt::format("{}", value);
}
std::string shown(double value) {
  if (std::isinf(value)) return value > 0. ? "INFINITY" : "-INFINITY";
  return fmt::format("{:a}", value);
}

/// One member of the structure: what its type and name are, and its values; nothing where there
/// are none, since C has no empty arrays.
struct Member {
  std::string declaration, values;
};

template <typename T>
Member member(std::string_view type, std::string_view name, const std::vector<T>& values) {
  if (values.empty()) return {};
  constexpr std::size_t kWidth = 96;
  Member made{fmt::format("  {} {}[{}];\n", type, name, values.size()), "  {"};
  std::size_t column = made.values.size();
  for (const T& value : values) {
    const std::string text = shown(value) + ",";
    if (column + text.size() > kWidth) {
      made.values += "\n   ";
      column = 3;
    }
    made.values += text;
    column += text.size();
  }
  made.values.back() = '}';
  made.values += ",\n";
  return made;
}

std::uint64_t padded(std::uint64_t bytes) { return (bytes + 7) / 8 * 8; }

/// Members that follow each other as the block's bytes do; each fills whole words.
std::array<Member, 6> members_of(const Bytes& block) {
  const BlockHeader h = header_of(block.data());
  const auto at = [&h](SectionName s) { return h.section[s].at; };
  const auto room = [&h](SectionName s) { return padded(h.section[s].bytes); };
  const std::uint64_t head = at(kColumns) + room(kColumns);
  return {
      member("uint64_t", "head", values_of<std::uint64_t>(block, 0, head)),
      member("int64_t", "words", values_of<std::int64_t>(block, at(kWords), room(kWords))),
      member("double", "reals", values_of<double>(block, at(kReals), room(kReals))),
      member("uint64_t", "structures",
             values_of<std::uint64_t>(block, at(kStructures), room(kStructures))),
      member("int32_t", "integers", values_of<std::int32_t>(block, at(kIntegers), room(kIntegers))),
      member("double", "check", values_of<double>(block, at(kCheck), room(kCheck)))};
}

/// The block's own words on itself, in a comment that they cannot end.
std::string comment(const Bytes& block) {
  const BlockSection about = header_of(block.data()).about;
  std::string text(reinterpret_cast<const char*>(block.data()) + about.at, about.bytes);
  for (std::size_t end = text.find("*/"); end != std::string::npos; end = text.find("*/"))
    text[end] = '?';
  std::string lines =
      "/* A model of a track for railstep_load(), bit by bit the block of\n"
      " * `railstep condense`.\n * ";
  for (const char c : text) {
    lines += c;
    if (c == '\n') lines += " * ";
  }
  return lines + "*/\n";
}

}  // namespace

std::string emit_c(const Bytes& block, const std::string& name) {
  std::string members, values;
  for (const Member& made : members_of(block)) {
    members += made.declaration;
    values += made.values;
  }
  std::string text =
      comment(block) + "#include <math.h>\n#include <stddef.h>\n#include <stdint.h>\n";
  text += "static const struct {\n" + members + "} " + name + " = {\n" + values + "};\n";
  text += fmt::format("static const size_t {0}_bytes = sizeof {0};\n", name);
  text += fmt::format("typedef char {0}_has_no_gaps[sizeof {0} == {1} ? 1 : -1];\n", name,
                      block.size());
  return text;
}

std::string identifier(const std::string& stem) {
  std::string name;
  for (const char c : stem) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  const bool digit = !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) != 0;
  return (digit ? "_" : "") + name + "_model";
}

}  // namespace railstep
