#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "document.h"
#include "properties.h"

namespace railstep::property {

struct Generator {
  const char* name;
  Document (*scene)(std::uint64_t seed);
};
const std::vector<Generator>& all_generators();

/// Result of one property on one scene.
struct Result {
  enum class Kind { holds, fails, does_not_apply, refused };
  Kind kind;
  std::string figures;
};
Result result_of(const Property& property, const Document& scene, std::uint64_t seed);

inline constexpr int kShrinkSeconds = 20;

/// The smallest scene found in kShrinkSeconds on which the property still fails: tables and keys
/// are removed one by one.
Document shrunk(const Property& property, Document scene, std::uint64_t seed);

}  // namespace railstep::property
