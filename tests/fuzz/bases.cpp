#include "bases.h"

#include <array>
#include <iterator>

#include "oracle.h"
#include "run/simulation.h"

namespace railstep::fuzz {
namespace {

constexpr const char* kScenes[] = {"loads",    "wheelset", "modal_wheelset", "vehicles", "external",
                                   "endless",  "hanging",  "rough",          "pendulum", "crank",
                                   "on_rails", "guided",   "joints_tr_bdf2"};

}  // namespace

std::size_t base_count() { return std::size(kScenes); }

std::string base_scene(std::size_t which) {
  return std::string(RAILSTEP_SOURCE) + "/tests/fuzz/corpus/scene/" +
         kScenes[which % std::size(kScenes)] + ".toml";
}

const std::vector<std::byte>& base_block(std::size_t which) {
  static std::array<std::vector<std::byte>, std::size(kScenes)> made;
  std::vector<std::byte>& block = made[which % made.size()];
  if (block.empty()) block = simulation_of(read_any_scene(base_scene(which)))->block();
  return block;
}

}  // namespace railstep::fuzz
