// A profile (TOML): half an outline with arcs.
#include "mutate.h"
#include "oracle.h"
#include "outlines.h"

using namespace railstep;
using namespace railstep::fuzz;

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  return mutate_text(data, size, most, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = written("input.toml", text_of(data, size));
  accepts([&] { check_outline(read_profile(file)); });
  return 0;
}
