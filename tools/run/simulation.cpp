#include "run/simulation.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

#include "online/model/load_model.h"
#include "online/step/self_check.h"
#include "online/step/trace_row.h"
#include "text/files.h"

namespace railstep {
namespace {

/// The format of a block that is long enough to have one.
std::uint16_t major_of(const std::vector<std::byte>& block) {
  std::uint16_t major = 0;
  std::memcpy(&major, block.data() + offsetof(BlockHeader, major), sizeof major);
  return major;
}

/// Why a model file was refused.
Message refusal(LoadStatus status, const std::string& file, const std::vector<std::byte>& block) {
  const auto message = [&](MessageId id, const std::string& sentence) {
    return Message(id, file + ": " + sentence);
  };
  constexpr const char* kAgain = "; write it again with `railstep condense`";
  switch (status) {
    case LoadStatus::ok:
    case LoadStatus::misaligned:
      break;
    case LoadStatus::not_a_model:
      return message("E-MODEL-05",
                     "this is not a model; expected one that `railstep condense` "
                     "wrote");
    case LoadStatus::other_version:
      return message("E-MODEL-08", fmt::format("the model has format {}; expected format {}{}",
                                               major_of(block), kBlockMajor, kAgain));
    case LoadStatus::other_byte_order:
      return message("E-MODEL-09",
                     std::string("the model is from a machine with another byte order") + kAgain);
    case LoadStatus::wrong_size:
      return message("E-MODEL-10",
                     std::string("the model is shorter or longer than its header says") + kAgain);
    case LoadStatus::wrong_header:
      return message("E-MODEL-11",
                     std::string("the header of the model does not match its CRC-32") + kAgain);
    case LoadStatus::wrong_sum:
      return message("E-MODEL-12",
                     std::string("the content of the model does not match its SHA-256") + kAgain);
    case LoadStatus::bad_content:
      return message(
          "E-MODEL-06",
          std::string("a number of the model is not finite or out of its range") + kAgain);
  }
  return message("E-MODEL-13", "the model cannot be placed in memory");
}

std::vector<std::string> lines_of(const char* text, std::size_t bytes) {
  std::vector<std::string> lines(1);
  for (std::size_t i = 0; i < bytes; ++i)
    if (text[i] == '\n')
      lines.emplace_back();
    else
      lines.back() += text[i];
  return lines;
}

}  // namespace

std::vector<std::byte> read_bytes(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored) ||
      std::filesystem::is_character_file(file, ignored))  // which might never end
    throw InputError("E-MODEL-01", fmt::format("{}: this is a folder or a device; expected a file",
                                               file.string()));
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw InputError(
        "E-FILE-04",
        fmt::format("{}: the file cannot be opened; expected a file that is there and may be read",
                    file.string()));
  note_read_file(file);
  std::vector<std::byte> bytes;
  constexpr std::size_t kPiece = 1u << 20;
  for (std::size_t got = 1; got > 0;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kPiece);
    in.read(reinterpret_cast<char*>(bytes.data() + before), kPiece);
    got = static_cast<std::size_t>(in.gcount());
    bytes.resize(before + got);
  }
  if (in.bad())
    throw InputError("E-FILE-05", fmt::format("{}: the file cannot be read", file.string()));
  return bytes;
}

Simulation::Simulation(const Scene& scene)
    : built_(std::make_unique<Built>(scene)), block_(block_of(*built_)) {
  load(scene.file.string());
}

Simulation::Simulation(const SystemScene& scene)
    : system_(std::make_unique<BuiltSystem>(scene)), block_(block_of(*system_)) {
  load(scene.file.string());
}

Simulation::Simulation(const std::filesystem::path& artefact)
    : Simulation(read_bytes(artefact), artefact.string()) {}

Simulation::Simulation(std::vector<std::byte> block, const std::string& name)
    : block_(std::move(block)) {
  load(name);
  Outputs outputs{};
  std::vector<double> row(columns_.size());
  if (!self_check(model_, state, workspace, outputs, row.data()))
    throw InputError("E-MODEL-04",
                     fmt::format("{}: the model steps to other bits on this machine than on the "
                                 "one that wrote it; write it again with `railstep condense`",
                                 name));
}

void Simulation::load(const std::string& name) {
  const LoadResult result = load_model(block_.data(), block_.size(), model_);
  if (result.status != LoadStatus::ok)
    throw InputError(std::vector{refusal(result.status, name, block_)});
  columns_ = lines_of(result.text, result.text_bytes);
  const auto end = std::find(columns_.begin(), columns_.end(), "");
  if (end != columns_.end()) inputs_.assign(end + 1, columns_.end());
  columns_.erase(end, columns_.end());
  if (columns_.size() != static_cast<std::size_t>(trace_columns(model_)) ||
      inputs_.size() != static_cast<std::size_t>(model_.inputs))
    throw InputError(std::vector{refusal(LoadStatus::bad_content, name, block_)});
  place();
}

void Simulation::place() {
  memory_.resize(static_cast<std::size_t>(state_doubles(model_)));
  scratch_.resize(static_cast<std::size_t>(workspace_doubles(model_)));
  state = state_on(model_, memory_.data());
  workspace = workspace_on(model_, scratch_.data());
  reset(model_, state);
}

std::unique_ptr<Simulation> simulation_of(const AnyScene& scene) {
  return std::visit([](const auto& kind) { return std::make_unique<Simulation>(kind); }, scene);
}

bool is_artefact(const std::filesystem::path& file) {
  std::error_code ignored;  // a pipe gives its bytes once, and a scene may come through one
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  std::ifstream in(file, std::ios::binary);
  char start[64] = {};
  in.read(start, sizeof start);
  const std::string_view text(start, static_cast<std::size_t>(in.gcount()));
  if (text.starts_with("railstep")) return true;
  if (text.find('\0') != std::string_view::npos)
    throw InputError("E-MODEL-07",
                     fmt::format("{}: the file begins neither as a model nor as text; expected a "
                                 "scene (TOML), or a model that `railstep condense` wrote",
                                 file.string()));
  return false;
}

}  // namespace railstep
