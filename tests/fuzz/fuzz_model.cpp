// A model file: patches to the block of a small scene, or a block itself. Its sums are corrected so
// that all of the loader is reached.
#include <cstring>
#include <vector>

#include "bases.h"
#include "offline/pack/artefact.h"
#include "online/model/load_model.h"
#include "oracle.h"
#include "patch.h"
#include "stepping.h"

using namespace railstep;
using namespace railstep::fuzz;

namespace {

/// The header, then the sections in their order, then the whole block.
std::vector<Room> rooms_of(const std::vector<std::byte>& block) {
  const BlockHeader header = header_of(block.data());
  std::vector<Room> rooms = {{0, sizeof(BlockHeader)}};
  for (const BlockSection& s : header.section) rooms.push_back({s.at, s.bytes});
  rooms.push_back({header.section[kReals].at, header.section[kReals].bytes});  // most of it
  rooms.push_back({0, block.size()});
  return rooms;
}

std::vector<std::byte> patched(Bytes& input) {
  std::vector<std::byte> block = base_block(input.byte());
  const std::uint8_t ending = input.byte();  // bytes cut off or added, mostly none
  apply_patches(input, rooms_of(block), block);
  if (ending % 8 == 1) block.resize(block.size() - 8u * (ending / 8u));
  if (ending % 8 == 2) block.resize(block.size() + ending);
  return block;
}

/// Checks that a loaded model is written to the same bytes, as far as a model holds them.
void check_written(const std::vector<std::byte>& block) {
  Model model;
  const LoadResult loaded = load_model(block.data(), block.size(), model);
  check(loaded.status == LoadStatus::ok, "a block loads once and not twice");
  if (model.check.frames != 8 || model.steps_per_frame > 100) return;
  const BlockHeader header = header_of(block.data());
  const char* const about = reinterpret_cast<const char*>(block.data() + header.about.at);
  const std::vector<std::byte> again =
      to_block(model, std::string(loaded.text, loaded.text_bytes),
               {std::string(about, header.about.bytes), header.static_error,
                header.receptance_error, header.transient_error});
  // The check in it is that of the model as it is now; all other bytes are the block's.
  const std::size_t from = header.section[kColumns].at, to = header.section[kCheck].at;
  check(again.size() >= to && std::memcmp(again.data() + from, block.data() + from, to - from) == 0,
        "a model is not written as it was read");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Bytes input(data, size);
  std::vector<std::byte> block;
  if (size >= 8 && std::memcmp(data, "railstep", 8) == 0) {
    const auto* const at = reinterpret_cast<const std::byte*>(data);
    block.assign(at, at + size);
    static_cast<void>(step_block(block, false));  // without correction: its sums refuse nearly all
  } else {
    block = patched(input);
  }
  sign_block(block);
  if (step_block(block, false)) {
    const Held held(block);
    if (held.small()) check_written(block);
  }
  return 0;
}
