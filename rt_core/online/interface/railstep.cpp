#include "online/interface/railstep.h"

#include <cstring>

#include "online/model/load_model.h"
#include "online/model/names.h"
#include "online/model/snapshot.h"
#include "online/step/self_check.h"
#include "online/step/step.h"
#include "online/step/trace_row.h"

using namespace railstep;

struct railstep_model {
  Model model;
  Names outputs, inputs;
};

/// Its arrays follow it in the caller's memory.
struct railstep_run {
  const railstep_model* of;
  State state;
  Workspace workspace;
  Outputs outputs;
  double* row;
};

namespace {

bool is_aligned(const void* memory) noexcept {
  return reinterpret_cast<std::uintptr_t>(memory) % alignof(double) == 0;
}

std::int32_t result_of(LoadStatus status) noexcept {
  switch (status) {
    case LoadStatus::ok:
      return RAILSTEP_OK;
    case LoadStatus::misaligned:
      return RAILSTEP_MISALIGNED;
    case LoadStatus::not_a_model:
      return RAILSTEP_NOT_A_MODEL;
    case LoadStatus::other_version:
      return RAILSTEP_OTHER_VERSION;
    case LoadStatus::other_byte_order:
      return RAILSTEP_OTHER_BYTE_ORDER;
    case LoadStatus::wrong_size:
      return RAILSTEP_WRONG_SIZE;
    case LoadStatus::wrong_header:
    case LoadStatus::wrong_sum:
      return RAILSTEP_WRONG_SUM;
    case LoadStatus::bad_content:
      return RAILSTEP_BAD_CONTENT;
  }
  return RAILSTEP_BAD_CONTENT;
}

std::int32_t result_of(SnapshotStatus status) noexcept {
  switch (status) {
    case SnapshotStatus::ok:
      return RAILSTEP_OK;
    case SnapshotStatus::not_a_snapshot:
      return RAILSTEP_NOT_A_SNAPSHOT;
    case SnapshotStatus::other_version:
      return RAILSTEP_OTHER_VERSION;
    case SnapshotStatus::wrong_size:
      return RAILSTEP_WRONG_SIZE;
    case SnapshotStatus::wrong_sum:
      return RAILSTEP_WRONG_SUM;
    case SnapshotStatus::other_model:
      return RAILSTEP_OTHER_MODEL;
    case SnapshotStatus::bad_content:
      return RAILSTEP_BAD_CONTENT;
  }
  return RAILSTEP_BAD_CONTENT;
}

std::size_t copy_name(const Names& names, std::int32_t index, char* to,
                      std::size_t bytes) noexcept {
  const Name found = name_at(names, index);
  if (bytes == 0) return found.bytes;
  const std::size_t kept = found.bytes < bytes - 1 ? found.bytes : bytes - 1;
  std::memcpy(to, found.text, kept);
  to[kept] = 0;
  return found.bytes;
}

void begin(railstep_run& run) noexcept {
  const Model& model = run.of->model;
  publish_start(model, run.state, run.outputs);
  trace_row(model, run.state, run.outputs, run.row);
}

}  // namespace

std::int32_t railstep_version(void) noexcept { return RAILSTEP_VERSION; }

const char* railstep_result_text(std::int32_t result) noexcept {
  switch (result) {
    case RAILSTEP_OK:
      return "no error";
    case RAILSTEP_MISALIGNED:
      return "a block or memory does not start at a multiple of 8 bytes";
    case RAILSTEP_NOT_A_MODEL:
      return "not a model; expected a file that `railstep condense` wrote";
    case RAILSTEP_OTHER_VERSION:
      return "the model or the snapshot has another format; write it again";
    case RAILSTEP_WRONG_SIZE:
      return "shorter or longer than its header says; write it again";
    case RAILSTEP_WRONG_SUM:
      return "the content does not match its check sums; write it again";
    case RAILSTEP_BAD_CONTENT:
      return "a number is out of its range";
    case RAILSTEP_TOO_LITTLE_MEMORY:
      return "too little memory";
    case RAILSTEP_NOT_A_SNAPSHOT:
      return "not a snapshot";
    case RAILSTEP_OTHER_MODEL:
      return "the snapshot is from another model";
    case RAILSTEP_OTHER_BYTE_ORDER:
      return "from a machine with another byte order; write it again";
    case RAILSTEP_OTHER_BITS:
      return "this machine steps the model to other bits than the one that wrote it";
    default:
      return "not a result of this library";
  }
}

const char* railstep_status_name(std::uint32_t status) noexcept {
  const StatusText* const text = text_of(static_cast<Status>(status));
  return text != nullptr ? text->name : "";
}

const char* railstep_status_text(std::uint32_t status) noexcept {
  const StatusText* const text = text_of(static_cast<Status>(status));
  return text != nullptr ? text->sentence : "";
}

std::size_t railstep_model_bytes(void) noexcept { return sizeof(railstep_model); }

std::int32_t railstep_load(const void* block, std::size_t block_bytes, void* memory,
                           std::size_t memory_bytes, const railstep_model** model) noexcept {
  if (model == nullptr) return RAILSTEP_TOO_LITTLE_MEMORY;
  *model = nullptr;
  if (!is_aligned(memory)) return RAILSTEP_MISALIGNED;
  if (memory == nullptr || memory_bytes < sizeof(railstep_model)) return RAILSTEP_TOO_LITTLE_MEMORY;
  if (block == nullptr) return RAILSTEP_NOT_A_MODEL;
  auto* const made = static_cast<railstep_model*>(memory);
  const LoadResult result = load_model(block, block_bytes, made->model);
  if (result.status != LoadStatus::ok) return result_of(result.status);
  if (!split_names(result.text, result.text_bytes, made->outputs, made->inputs) ||
      made->outputs.count != trace_columns(made->model) || made->inputs.count != made->model.inputs)
    return RAILSTEP_BAD_CONTENT;
  *model = made;
  return RAILSTEP_OK;
}

double railstep_frame_s(const railstep_model* model) noexcept {
  return model->model.scheme.dt * model->model.steps_per_frame;
}

std::int64_t railstep_frames(const railstep_model* model) noexcept {
  return model->model.steps / model->model.steps_per_frame;
}

std::int32_t railstep_inputs(const railstep_model* model) noexcept { return model->inputs.count; }
std::int32_t railstep_outputs(const railstep_model* model) noexcept { return model->outputs.count; }

std::int32_t railstep_find_input(const railstep_model* model, const char* name) noexcept {
  return find_name(model->inputs, name);
}
std::int32_t railstep_find_output(const railstep_model* model, const char* name) noexcept {
  return find_name(model->outputs, name);
}

std::size_t railstep_input_name(const railstep_model* model, std::int32_t index, char* name,
                                std::size_t bytes) noexcept {
  return copy_name(model->inputs, index, name, bytes);
}
std::size_t railstep_output_name(const railstep_model* model, std::int32_t index, char* name,
                                 std::size_t bytes) noexcept {
  return copy_name(model->outputs, index, name, bytes);
}

std::size_t railstep_run_bytes(const railstep_model* model) noexcept {
  const std::int64_t doubles =
      state_doubles(model->model) + workspace_doubles(model->model) + model->outputs.count;
  return sizeof(railstep_run) + sizeof(double) * static_cast<std::size_t>(doubles);
}

std::int32_t railstep_start(const railstep_model* model, void* memory, std::size_t bytes,
                            railstep_run** run) noexcept {
  if (run == nullptr) return RAILSTEP_TOO_LITTLE_MEMORY;
  *run = nullptr;
  if (!is_aligned(memory)) return RAILSTEP_MISALIGNED;
  if (memory == nullptr || bytes < railstep_run_bytes(model)) return RAILSTEP_TOO_LITTLE_MEMORY;
  std::memset(memory, 0, railstep_run_bytes(model));
  auto* const made = static_cast<railstep_run*>(memory);
  auto* const state = reinterpret_cast<double*>(made + 1);
  double* const scratch = state + state_doubles(model->model);
  made->of = model;
  made->state = state_on(model->model, state);
  made->workspace = workspace_on(model->model, scratch);
  made->row = scratch + workspace_doubles(model->model);
  railstep_reset(made);
  *run = made;
  return RAILSTEP_OK;
}

void railstep_reset(railstep_run* run) noexcept {
  reset(run->of->model, run->state);
  begin(*run);
}

std::int32_t railstep_self_check(railstep_run* run) noexcept {
  const bool same = self_check(run->of->model, run->state, run->workspace, run->outputs, run->row);
  begin(*run);
  return same ? RAILSTEP_OK : RAILSTEP_OTHER_BITS;
}

std::uint32_t railstep_step(railstep_run* run, const double* inputs) noexcept {
  const Model& model = run->of->model;
  const Status met = inputs != nullptr
                         ? advance_frame(model, inputs, run->state, run->workspace, run->outputs)
                         : advance_frame(model, run->state, run->workspace, run->outputs);
  trace_row(model, run->state, run->outputs, run->row);
  return static_cast<std::uint32_t>(met);
}

void railstep_read(const railstep_run* run, double* outputs) noexcept {
  std::memcpy(outputs, run->row, sizeof(double) * static_cast<std::size_t>(run->of->outputs.count));
}

std::int64_t railstep_steps(const railstep_run* run) noexcept { return run->state.steps; }

double railstep_time_s(const railstep_run* run) noexcept {
  return static_cast<double>(run->state.steps) * run->of->model.scheme.dt;
}

std::uint64_t railstep_hash(const railstep_run* run) noexcept {
  return state_hash(run->of->model, run->state);
}

std::int32_t railstep_external_wheels(const railstep_model* model) noexcept {
  return model->model.external_wheels;
}

std::uint32_t railstep_response(railstep_run* run, const double* inputs, double* free_motion,
                                double* compliance) noexcept {
  const double* const given = inputs != nullptr ? inputs : run->state.input;
  return static_cast<std::uint32_t>(external_response(run->of->model, given, run->state,
                                                      run->workspace, free_motion, compliance));
}

std::size_t railstep_snapshot_bytes(const railstep_model* model) noexcept {
  return snapshot_bytes(model->model);
}

void railstep_save(const railstep_run* run, void* snapshot) noexcept {
  save_snapshot(run->of->model, run->state, static_cast<unsigned char*>(snapshot));
}

std::int32_t railstep_restore(railstep_run* run, const void* snapshot, std::size_t bytes) noexcept {
  if (snapshot == nullptr) return RAILSTEP_NOT_A_SNAPSHOT;
  const SnapshotStatus status = restore_snapshot(run->of->model, snapshot, bytes, run->state);
  if (status == SnapshotStatus::ok) begin(*run);
  return result_of(status);
}
