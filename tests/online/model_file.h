#pragma once
// A model file in memory with a state to step, for programs that need only the online library.
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <vector>

#include "online/model/load_model.h"
#include "online/model/state.h"

namespace railstep {

class ModelFile {
 public:
  /// If the file is not a model of this version, `model` is null and an error is printed.
  explicit ModelFile(const char* path) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> content{std::istreambuf_iterator<char>(file), {}};
    block_.resize(content.size() / sizeof(std::int64_t) + 1);  // whole words: aligned
    if (!content.empty()) std::memcpy(block_.data(), content.data(), content.size());
    auto loaded = std::make_unique<Model>();
    if (load_model(block_.data(), content.size(), *loaded).status != LoadStatus::ok) {
      std::fprintf(stderr, "error: %s: no model file of this version\n", path);
      return;
    }
    model = std::move(loaded);
    memory_.resize(static_cast<std::size_t>(state_doubles(*model)));
    scratch_.resize(static_cast<std::size_t>(workspace_doubles(*model)));
    state = state_on(*model, memory_.data());
    workspace = workspace_on(*model, scratch_.data());
    reset(*model, state);
  }

  /// Makes every guide and every system iterate up to its cap: no tolerance can be met, and
  /// Newton's matrix, unless it is kept, is built again in each iteration.
  void go_to_caps() {
    SystemModel& system = model->system;
    system.tolerance = system.joint_tolerance = -1.;
    if (system.renew == Renew::every_step) system.renew = Renew::every_iteration;
    for (WheelsetModel& wheelset : model->wheelset) wheelset.tolerance = -1.;
  }

  std::unique_ptr<Model> model;
  State state{};
  Workspace workspace{};

 private:
  std::vector<std::int64_t> block_;
  std::vector<double> memory_, scratch_;
};

}  // namespace railstep
