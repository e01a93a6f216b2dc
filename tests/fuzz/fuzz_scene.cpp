// A scene file (TOML), of a track or of bodies and beams.
#include "mutate.h"
#include "oracle.h"
#include "scenes.h"

using namespace railstep::fuzz;

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  return mutate_text(data, size, most, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  run_scene(written("input.toml", text_of(data, size)));
  return 0;
}
