#include "online/model/load_model.h"

#include <cstring>

#include "online/math/bytes.h"
#include "online/math/finite.h"
#include "online/math/sha256.h"
#include "online/model/caps.h"
#include "online/model/describe.h"
#include "online/model/load_system.h"
#include "online/model/load_track.h"
#include "online/model/names.h"

namespace railstep {

namespace {

/// Bytes of a section that have not been read yet.
struct Rest {
  const unsigned char* at;
  std::uint64_t left;
};

/// Reads a payload in the order of describe.h. After the first number that does not fit, all counts
/// are 0.
class Reader {
 public:
  Reader(const unsigned char* block, const BlockHeader& header) noexcept {
    for (std::size_t s = 0; s < kSections; ++s)
      rest_[s] = {block + header.section[s].at, header.section[s].bytes};
  }

  /// Whether all numbers so far were valid, and whether no bytes are left.
  bool good() const noexcept { return good_; }
  bool at_end() const noexcept {
    return rest_[kWords].left == 0 && rest_[kReals].left == 0 && rest_[kStructures].left == 0 &&
           rest_[kIntegers].left == 0;
  }

  void count(std::int32_t& value, std::int64_t most) noexcept {
    const std::int64_t found = word();
    if (found < 0 || found > most) good_ = false;
    value = good_ ? static_cast<std::int32_t>(found) : 0;
  }
  void integer(std::int64_t& value) noexcept { value = word(); }
  void bound(double& value) noexcept {
    const double* const found = take<double>(kReals, 1);
    value = found != nullptr ? *found : 0.;
    if (value != value) good_ = false;
  }
  void real(double& value) noexcept {
    bound(value);
    if (!is_moderate(value)) good_ = false;
  }
  void reals(const double*& values, std::int64_t n) noexcept {
    array(values, kReals, n, true);
    if (values == nullptr) return;
    for (std::int64_t i = 0; i < n; ++i)
      if (!is_moderate(values[i])) good_ = false;
  }
  void integers(const std::int32_t*& values, std::int64_t n) noexcept {
    array(values, kIntegers, n, false);
  }
  template <typename T>
  void structures(const T*& values, std::int64_t n) noexcept {
    array(values, kStructures, n, false);
  }

 private:
  std::int64_t word() noexcept {
    const std::int64_t* const found = take<std::int64_t>(kWords, 1);
    return found != nullptr ? *found : 0;
  }

  template <typename T>
  void array(const T*& values, SectionName from, std::int64_t n, bool may_be_none) noexcept {
    values = nullptr;
    const std::int64_t found = word();
    if (found == 0 && (may_be_none || n == 0)) return;
    if (found != n || n < 0) good_ = false;
    if (good_) values = take<T>(from, static_cast<std::uint64_t>(n));
  }

  /// The next n of a section, or null.
  template <typename T>
  const T* take(SectionName from, std::uint64_t n) noexcept {
    Rest& rest = rest_[from];
    if (n > rest.left / sizeof(T)) good_ = false;
    if (!good_) return nullptr;
    const auto* const found = reinterpret_cast<const T*>(rest.at);
    rest.at += n * sizeof(T);
    rest.left -= n * sizeof(T);
    return found;
  }

  Rest rest_[kSections];
  bool good_ = true;
};

std::uint64_t padded(std::uint64_t bytes) noexcept { return (bytes + 7) / 8 * 8; }

/// Whether the sections fill the block one after another, each within the bytes that are left.
bool sections_are_valid(const BlockHeader& h) noexcept {
  if (h.about.at != sizeof(BlockHeader) || h.about.bytes > h.header_bytes - sizeof(BlockHeader) ||
      sizeof(BlockHeader) + padded(h.about.bytes) != h.header_bytes)
    return false;
  std::uint64_t at = h.header_bytes;
  for (const BlockSection& s : h.section) {
    if (s.at != at || s.bytes > h.bytes - at || padded(s.bytes) > h.bytes - at) return false;
    at += padded(s.bytes);
  }
  return at == h.bytes;
}

/// Whether the padding between sections is 0, so that a model has one form.
bool gaps_are_zero(const unsigned char* at, const BlockHeader& h) noexcept {
  const auto zero_behind = [at](const BlockSection& s) {
    for (std::uint64_t i = s.at + s.bytes; i < s.at + padded(s.bytes); ++i)
      if (at[i] != 0) return false;
    return true;
  };
  for (const BlockSection& s : h.section)
    if (!zero_behind(s)) return false;
  return zero_behind(h.about);
}

/// Checks the header of a block as it was given, and its sums.
LoadStatus check_header(const unsigned char* at, std::size_t bytes, BlockHeader& h) noexcept {
  if (bytes < 8 || !same_bytes(at, "railstep", 8)) return LoadStatus::not_a_model;
  if (bytes < offsetof(BlockHeader, real_bytes)) return LoadStatus::wrong_size;
  std::memcpy(&h, at, bytes < sizeof h ? bytes : sizeof h);
  if (h.byte_order == 0x04030201) return LoadStatus::other_byte_order;
  if (h.byte_order != kByteOrder || h.major != kBlockMajor) return LoadStatus::other_version;
  if (bytes < sizeof h || h.bytes != bytes || bytes % 8 != 0) return LoadStatus::wrong_size;
  if (h.header_bytes < sizeof h || h.header_bytes > bytes || h.header_bytes % 8 != 0 ||
      h.crc != header_crc(at, h.header_bytes))
    return LoadStatus::wrong_header;
  if (h.real_bytes != sizeof(double) || !sections_are_valid(h)) return LoadStatus::bad_content;
  unsigned char sum[32];
  sha256(at + h.header_bytes, bytes - h.header_bytes, sum);
  if (!same_bytes(sum, h.sum, 32)) return LoadStatus::wrong_sum;
  return gaps_are_zero(at, h) ? LoadStatus::ok : LoadStatus::bad_content;
}

/// Whether a header states what its payload says.
bool states(const BlockHeader& h, const Model& m) noexcept {
  const BlockCaps own = caps_of(m);
  return h.step_s == m.scheme.dt && h.steps_per_frame == m.steps_per_frame &&
         h.caps.locate == own.locate && h.caps.ports == own.ports && h.caps.guides == own.guides &&
         h.caps.system == own.system && h.flops_per_frame == m.cost.flops &&
         h.bytes_per_frame == m.cost.bytes && h.instructions_per_frame == m.cost.instructions &&
         h.state_bytes == state_doubles(m) * 8 && h.workspace_bytes == workspace_doubles(m) * 8;
}

/// Whether the check compares a row of the trace, or there is no check.
bool check_is_valid(const BlockHeader& h) noexcept {
  const std::uint64_t doubles = h.section[kCheck].bytes / 8;
  if (h.check_frames == 0) return doubles == 0;
  return h.check_frames > 0 && h.check_frames <= kMostCheckFrames && doubles > 0 &&
         h.section[kCheck].bytes % 8 == 0;
}

/// A step of two stages needs a track alone in full order, whose forces the model knows at any
/// time. Mean contact forces are held over the step.
bool scheme_is_valid(const Model& m) noexcept {
  if (m.scheme.mean != 0 && (m.form == Form::banded || m.scheme.theta != 1.)) return false;
  if (!(m.scheme.stage_fraction >= 0.) || !(m.scheme.stage_fraction < 1.)) return false;
  return m.scheme.stage_fraction == 0. || (m.form == Form::banded && m.system.unknowns == 0);
}

/// Flops that a step of any model of these sizes has at its caps, most of them of a track alone
/// (offline/cost counts them all). The number that a model states must not be less, else it bounds
/// nothing.
std::int64_t least_step_flops(const Model& m) noexcept {
  std::int64_t sum = 21 * (std::int64_t{m.unknowns} - m.line_unknowns);
  for (std::int32_t l = 0; l < m.lines; ++l) {
    const LineModel& line = m.line[l];
    const std::int64_t n = line.size, left = line.step.left, panels = line.step.panels;
    // Columns of a panel before the first unknown take no work.
    const std::int64_t first = left / kLanes < panels ? left / kLanes : panels;
    const std::int64_t columns = kLanes * (first * (first - 1) / 2) + (panels - first) * left;
    sum += m.form == Form::condensed ? 22 * n : 22 * n + 4 * kLanes * columns + 160 * panels;
  }
  std::int64_t elements = 0;
  for (std::int32_t b = 0; b < m.system.beams; ++b)
    elements +=
        (m.system.beam[b].planar != 0 ? 3'000 : 12'000) * std::int64_t{m.system.beam[b].elements};
  return sum + (std::int64_t{m.system.cap} + 1) * (27 * std::int64_t{m.system.unknowns} + elements);
}

/// The stated work of a frame is at least that of its steps.
bool cost_is_valid(const Model& m) noexcept {
  return m.cost.flops / m.steps_per_frame >= least_step_flops(m) && m.cost.flops >= 1 &&
         m.cost.bytes >= 1 && m.cost.instructions >= m.cost.flops;
}

/// A run has whole frames.
bool frames_are_valid(const Model& m) noexcept {
  return m.steps_per_frame >= 1 && m.steps >= 1 && m.steps % m.steps_per_frame == 0;
}

/// Checks all that a step relies on beyond the counts.
bool is_valid(const Model& m) noexcept {
  if (!is_above_zero(m.scheme.dt) || !frames_are_valid(m) || !inputs_are_valid(m)) return false;
  if (!scheme_is_valid(m)) return false;
  if (m.elements < 1 && m.system.unknowns < 1) return false;
  if (m.elements > 0 && !track_is_valid(m)) return false;
  return (m.system.unknowns == 0 || system_is_valid(m)) && cost_is_valid(m);
}

bool start_is_valid(const Model& m) noexcept {
  if (start_doubles(m) == 0) return true;  // nothing on rigid rails has a motion of its own
  return m.start != nullptr && (m.system.unknowns == 0 || system_start_is_valid(m));
}

bool names_are_valid(const unsigned char* at, const BlockSection& text) noexcept {
  Names columns, inputs;
  return split_names(reinterpret_cast<const char*>(at + text.at),
                     static_cast<std::size_t>(text.bytes), columns, inputs);
}

bool read_payload(const unsigned char* at, const BlockHeader& h, Model& model) noexcept {
  if (!names_are_valid(at, h.section[kColumns])) return false;
  Reader reader(at, h);
  describe(reader, model);
  if (!reader.good() || !is_valid(model)) return false;
  describe_start(reader, model);
  return reader.good() && reader.at_end() && start_is_valid(model) && states(h, model) &&
         check_is_valid(h);
}

}  // namespace

BlockCaps caps_of(const Model& m) noexcept {
  BlockCaps caps{kLocateSteps, kPortSweeps, 0, m.system.unknowns > 0 ? m.system.cap : 0};
  for (std::int32_t i = 0; i < m.wheelsets; ++i)
    if (m.wheelset[i].cap > caps.guides) caps.guides = m.wheelset[i].cap;
  return caps;
}

LoadResult load_model(const void* block, std::size_t bytes, Model& model) noexcept {
  const auto* const at = static_cast<const unsigned char*>(block);
  const auto refused = [](LoadStatus status) { return LoadResult{status, nullptr, 0}; };
  if (reinterpret_cast<std::uintptr_t>(block) % 8 != 0) return refused(LoadStatus::misaligned);
  BlockHeader header;
  const LoadStatus status = check_header(at, bytes, header);
  if (status != LoadStatus::ok) return refused(status);
  model = Model{};
  if (!read_payload(at, header, model)) return refused(LoadStatus::bad_content);
  std::memcpy(model.sum, header.sum, sizeof model.sum);
  model.check = {static_cast<std::int32_t>(header.check_frames),
                 static_cast<std::int32_t>(header.section[kCheck].bytes / 8), header.check_hash,
                 reinterpret_cast<const double*>(at + header.section[kCheck].at)};
  return {LoadStatus::ok, reinterpret_cast<const char*>(at + header.section[kColumns].at),
          static_cast<std::size_t>(header.section[kColumns].bytes)};
}

BlockHeader header_of(const void* block) noexcept {
  BlockHeader header;
  std::memcpy(&header, block, sizeof header);
  return header;
}

}  // namespace railstep
