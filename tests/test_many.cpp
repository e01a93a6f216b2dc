#include <algorithm>
#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "heap_count.h"
#include "online/step/many.h"
#include "simulation.h"

using namespace railstep;

namespace {

const std::string kFolder = std::string(RAILSTEP_SOURCE) + "/config/scenes/";
constexpr int kStates = 11;

std::size_t size(std::int64_t n) { return static_cast<std::size_t>(n); }

/// States of a model, each with its own start, number of steps made and inputs.
struct States {
  const Model& model;
  std::vector<double> memory, inputs;
  std::vector<State> state;
  std::vector<Outputs> outputs;

  explicit States(const Model& of)
      : model(of),
        memory(size(kStates * state_doubles(of))),
        inputs(size(kStates * of.inputs)),
        outputs(kStates) {
    std::memset(outputs.data(), 0, sizeof(Outputs) * outputs.size());
    for (int i = 0; i < kStates; ++i) {
      state.push_back(state_on(of, memory.data() + i * state_doubles(of)));
      State& s = state.back();
      reset(of, s);
      for (std::int32_t k = 0; k < of.unknowns; ++k) s.v[k] += 1e-6 * i;
      for (std::int32_t k = 0; k < of.inputs; ++k)
        inputs[size(i * of.inputs + k)] = 1e-3 * i * (k + 1);
      publish_start(of, s, outputs[size(i)]);
    }
  }
  const double* input(int i) const {
    return model.inputs > 0 ? inputs.data() + i * model.inputs : nullptr;
  }
  Status alone(int i, Workspace& w) {
    Outputs& out = outputs[size(i)];
    return model.inputs > 0 ? advance_frame(model, input(i), state[size(i)], w, out)
                            : advance_frame(model, state[size(i)], w, out);
  }
  /// Every third state is a frame ahead, and the one behind it two.
  void stagger(Workspace& w) {
    for (int i = 0; i < kStates; ++i)
      for (int n = 0; n < i % 3; ++n) (void)alone(i, w);
  }
};

/// Scratch for one state, and for many.
struct Scratch {
  std::vector<double> one;
  std::vector<std::byte> shared;
  Workspace workspace;
  ManyWorkspace many;

  explicit Scratch(const Model& model)
      : one(size(workspace_doubles(model))),
        shared(size(many_bytes(model))),
        workspace(workspace_on(model, one.data())),
        many(many_workspace_on(model, shared.data())) {}
  /// Whatever is left in it must not matter; all bits set are NaN.
  void spoil(const Model& model) {
    std::memset(shared.data(), 0xff, shared.size());
    many = many_workspace_on(model, shared.data());
  }
};

template <class T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  const auto bytes = [](const std::vector<T>& of) {
    return reinterpret_cast<const unsigned char*>(of.data());
  };
  return std::equal(bytes(a), bytes(a) + sizeof(T) * a.size(), bytes(b));
}

/// Whether all bits of states and outputs are the same, padding included: it was zeroed.
bool same(const States& a, const States& b) {
  for (std::size_t i = 0; i < kStates; ++i)
    if (a.state[i].steps != b.state[i].steps || a.state[i].latched != b.state[i].latched)
      return false;
  return same_bytes(a.memory, b.memory) && same_bytes(a.outputs, b.outputs);
}

/// Steps the first `count` states alone and together, and compares after each frame.
bool same_after(States& alone, States& together, Scratch& scratch, int count, int frames) {
  bool all = true;
  for (int n = 0; n < frames; ++n) {
    Status met = Status::ok;
    for (int i = 0; i < count; ++i) met = met | alone.alone(i, scratch.workspace);
    scratch.spoil(alone.model);
    const std::int64_t before = heap_calls();  // which the building of the model has raised
    all = all && before > 0;
    const Status found = advance_frames(together.model, together.input(0), together.state.data(),
                                        count, scratch.many, together.outputs.data());
    all = all && heap_calls() == before && found == met && same(alone, together);
  }
  return all;
}

std::vector<std::string> external_wheels() {
  return {"load=[]", "step.dt_s=1e-4", "step.frame_s=1e-4",
          "external_wheel=[{name=\"a\", rail=\"left\", limit_n=1e6}]"};
}

}  // namespace

TEST_CASE("states stepped together have the bits of each alone, in every scene", "[many]") {
  int scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder))
    for (const char* kind : {"full", "modal"}) {
      AnyScene scene = read_any_scene(entry.path());
      if (Scene* const track = std::get_if<Scene>(&scene)) {
        if (!track->step) continue;  // it is not run
        track->condense.kind =
            kind == std::string("modal") ? std::optional(ReductionKind::modal) : std::nullopt;
      } else if (kind == std::string("modal")) {
        continue;  // a system has no modes
      }
      const auto run = simulation_of(scene);
      const Model& model = run->model();
      Scratch scratch(model);
      States alone(model), together(model);
      CAPTURE(entry.path().stem().string(), kind);
      const std::uint64_t start = state_hash(model, alone.state[0]);
      CHECK(same_after(alone, together, scratch, kStates, 3));
      alone.stagger(scratch.workspace);
      together.stagger(scratch.workspace);
      CHECK(same_after(alone, together, scratch, kStates, 3));
      CHECK(start != state_hash(model, alone.state[0]));  // it moved
      CHECK(state_hash(model, alone.state[0]) != state_hash(model, alone.state[3]));
      ++scenes;
    }
  CHECK(scenes >= 28);
}

TEST_CASE("any number of states goes together, each with inputs of its own", "[many]") {
  for (const char* kind : {"full", "modal"}) {
    const std::string condensed = std::string("condense.kind=\"") + kind + "\"";
    const Simulation pushed(read_scene(
        kFolder + "wheelset_on_track.toml",
        {"wheelset[0].force=[{direction=\"y\", input=\"push\", limit_n=1e3}]", condensed}));
    std::vector<std::string> keys = external_wheels();
    keys.push_back(condensed);
    const Simulation outside(read_scene(kFolder + "moving_load.toml", keys));
    for (const Simulation* run : {&pushed, &outside})
      for (const int count : {0, 1, 2, 4, 8, 9, kStates}) {
        Scratch scratch(run->model());
        States alone(run->model()), together(run->model());
        CAPTURE(kind, count, run->model().inputs);
        CHECK(same_after(alone, together, scratch, count, 12));
      }
  }
}

TEST_CASE("states go together in every scheme", "[many]") {
  for (const char* key : {"step.scheme=\"tr-bdf2\"", "step.scheme=\"newmark\"",
                          "step.contact=\"discrete-gradient\""}) {
    const bool condensed = std::string(key).find("gradient") != std::string::npos;
    const Simulation run(
        read_scene(kFolder + "bogie_at_speed.toml",
                   {key, std::string("condense.kind=\"") + (condensed ? "modal\"" : "full\"")}));
    Scratch scratch(run.model());
    States alone(run.model()), together(run.model());
    CAPTURE(key);
    CHECK(same_after(alone, together, scratch, kStates, 5));
  }
}

TEST_CASE("a state that ends as no number or meets a cap leaves the others alone", "[many]") {
  for (const char* kind : {"full", "modal"})
    for (const char* name : {"wheelset_on_track", "bogie_at_speed", "moving_load"}) {
      const Simulation run(
          read_scene(kFolder + name + ".toml", {std::string("condense.kind=\"") + kind + "\""}));
      Model model = run.model();
      if (model.wheelsets > 0) model.wheelset[0].cap = 1;
      Scratch scratch(model);
      States alone(model), together(model), calm(model);
      for (States* s : {&alone, &together}) {
        s->state[0].u[0] = std::numeric_limits<double>::quiet_NaN();  // the first finds for all
        s->state[5].v[2] = std::numeric_limits<double>::infinity();
        if (model.wheelsets > 0) s->state[9].v[model.bodies] = 1e3;           // m/s, off its guide
        if (model.vehicles > 0) s->state[9].v[model.vehicle[0].first] = 1e6;  // off the rail
      }
      CAPTURE(kind, name);
      int stopped = 0, unsolved = 0;
      for (int n = 0; n < 4; ++n) {
        CHECK(same_after(alone, together, scratch, kStates, 1));
        for (int i = 0; i < kStates; ++i) (void)calm.alone(i, scratch.workspace);
        for (const Outputs& out : together.outputs)
          unsolved +=
              has(out.status, Status::cap_reached) || has(out.status, Status::contact_ill_posed)
                  ? 1
                  : 0;
      }
      for (std::size_t i = 0; i < kStates; ++i) {
        stopped += has(together.outputs[i].status, Status::nonfinite_state) ? 1 : 0;
        if (i == 0 || i == 5 || i == 9) continue;
        CHECK(state_hash(model, together.state[i]) == state_hash(model, calm.state[i]));
      }
      CHECK(stopped == 2);
      // Contacts of what is no number are not solved, nor is a guide that may turn once.
      CHECK(unsolved == (model.wheelsets > 0 ? 3 : model.vehicles > 0 ? 2 : 0));
    }
}

TEST_CASE("on a track without end a state may start whole periods further along it", "[many]") {
  // The bodies and rails are those of step 0; what differs is the irregularity under the wheels.
  for (const bool rough : {false, true}) {
    std::vector<std::string> keys;
    if (rough) keys.emplace_back("irregularity.spectrum=\"german_low\"");
    const Simulation run(read_scene(kFolder + "endless_track.toml", keys));
    const Model& model = run.model();
    const std::int64_t period = model.endless.course.period;
    REQUIRE(period < 1000);
    Scratch scratch(model);
    States states(model);
    for (int i = 0; i < 3; ++i) {
      reset(model, states.state[size(i)]);
      states.state[size(i)].steps = 7 * i * period;
    }
    for (int n = 0; n < 30; ++n)
      (void)advance_frames(model, states.state.data(), 3, scratch.many, states.outputs.data());
    const std::size_t doubles = size(state_doubles(model));
    for (std::size_t i = 1; i < 3; ++i) {
      const double* first = states.state[0].u;
      CHECK(std::equal(first, first + doubles, states.state[i].u) != rough);
    }
  }
}
