#include "offline/pack/artefact.h"

#include <array>
#include <bit>
#include <cstring>

#include "offline/math/refuse.h"
#include "online/math/sha256.h"
#include "online/model/describe.h"
#include "online/model/load_model.h"
#include "online/step/self_check.h"
#include "online/step/trace_row.h"

namespace railstep {

namespace {

static_assert(std::endian::native == std::endian::little, "a block is little-endian");

using Bytes = std::vector<std::byte>;

/// Puts a model's numbers into the sections of a payload.
class Writer {
 public:
  explicit Writer(std::array<Bytes, kSections>& sections) : section_(sections) {}

  void count(std::int32_t& value, std::int64_t most) {
    if (value < 0 || value > most)
      refuse("E-PACK-01", "the model does not fit into a model file: one of its counts is " +
                              std::to_string(value) + "; expected 0 to " + std::to_string(most));
    integer(value);
  }
  void integer(std::int64_t value) { put(kWords, &value, 1); }
  void real(double value) { put(kReals, &value, 1); }
  void bound(double value) { real(value); }
  void reals(const double* values, std::int64_t n) { array(kReals, values, n); }
  void integers(const std::int32_t* values, std::int64_t n) { array(kIntegers, values, n); }
  template <typename T>
  void structures(const T* values, std::int64_t n) {
    array(kStructures, values, n);
  }

 private:
  template <typename T>
  void array(SectionName to, const T* values, std::int64_t n) {
    if (values == nullptr) n = 0;
    integer(n);
    if (n > 0) put(to, values, static_cast<std::size_t>(n));
  }
  template <typename T>
  void put(SectionName to, const T* values, std::size_t n) {
    const auto* const at = reinterpret_cast<const std::byte*>(values);
    section_[to].insert(section_[to].end(), at, at + n * sizeof(T));
  }

  std::array<Bytes, kSections>& section_;
};

/// First frames and their sum; no frames while the check has not been made.
struct Check {
  std::int64_t frames = 0;
  std::uint64_t hash = 0;
  std::vector<double> row = {};
};

Bytes bytes_of(const void* from, std::size_t count) {
  const auto* const at = static_cast<const std::byte*>(from);
  return {at, at + count};
}

/// Appends a section to the block, padded to 8 bytes.
BlockSection append(const Bytes& bytes, Bytes& block) {
  const BlockSection section{block.size(), bytes.size()};
  block.insert(block.end(), bytes.begin(), bytes.end());
  block.resize((block.size() + 7) / 8 * 8);
  return section;
}

BlockHeader stated(const Model& model, const BlockNotes& notes, const Check& check) {
  BlockHeader h{};
  std::memcpy(h.magic, "railstep", sizeof h.magic);
  h.byte_order = kByteOrder;
  h.major = kBlockMajor;
  h.minor = kBlockMinor;
  h.real_bytes = sizeof(double);
  h.step_s = model.scheme.dt;
  h.steps_per_frame = model.steps_per_frame;
  h.caps = caps_of(model);
  h.flops_per_frame = model.cost.flops;
  h.bytes_per_frame = model.cost.bytes;
  h.instructions_per_frame = model.cost.instructions;
  h.state_bytes = state_doubles(model) * 8;
  h.workspace_bytes = workspace_doubles(model) * 8;
  h.static_error = notes.static_error;
  h.receptance_error = notes.receptance_error;
  h.transient_error = notes.transient_error;
  h.check_hash = check.hash;
  h.check_frames = check.frames;
  return h;
}

Bytes assemble(const Model& model, const std::string& columns, const BlockNotes& notes,
               const Check& check) {
  std::array<Bytes, kSections> sections;
  sections[kColumns] = bytes_of(columns.data(), columns.size());
  sections[kCheck] = bytes_of(check.row.data(), check.row.size() * sizeof(double));
  Writer writer(sections);
  Model copy = model;  // describe() also reads into one
  describe(writer, copy);
  describe_start(writer, copy);
  BlockHeader header = stated(model, notes, check);
  Bytes block(sizeof header);
  header.about = append(bytes_of(notes.about.data(), notes.about.size()), block);
  header.header_bytes = static_cast<std::uint32_t>(block.size());
  for (std::size_t s = 0; s < kSections; ++s) header.section[s] = append(sections[s], block);
  header.bytes = block.size();
  sha256(block.data() + header.header_bytes, block.size() - header.header_bytes, header.sum);
  std::memcpy(block.data(), &header, sizeof header);
  const auto* const at = reinterpret_cast<const unsigned char*>(block.data());
  header.crc = header_crc(at, header.header_bytes);
  std::memcpy(block.data() + kCrcAt, &header.crc, sizeof header.crc);
  return block;
}

/// Steps the first frames of a block. No frames if it does not load or does not stay finite.
Check checked(const Bytes& block) {
  Model model;
  if (load_model(block.data(), block.size(), model).status != LoadStatus::ok) return {};
  const auto doubles = [](std::int64_t n) {
    return std::vector<double>(static_cast<std::size_t>(n));
  };
  std::vector<double> memory = doubles(state_doubles(model)),
                      scratch = doubles(workspace_doubles(model));
  State state = state_on(model, memory.data());
  Workspace workspace = workspace_on(model, scratch.data());
  Outputs outputs{};
  Check check{kCheckFrames, 0, doubles(trace_columns(model))};
  run_check(model, kCheckFrames, state, workspace, outputs, check.row.data());
  if (has(state.latched, Status::nonfinite_state)) return {};
  check.hash = state_hash(model, state);
  return check;
}

}  // namespace

std::vector<std::byte> to_block(const Model& model, const std::string& columns,
                                const BlockNotes& notes) {
  return assemble(model, columns, notes, checked(assemble(model, columns, notes, {})));
}

std::string sum_of(const std::vector<std::byte>& block) {
  static const char* const digits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : header_of(block.data()).sum) {
    text += digits[byte >> 4];
    text += digits[byte & 15];
  }
  return text;
}

}  // namespace railstep
