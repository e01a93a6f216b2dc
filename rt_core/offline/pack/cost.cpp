#include "offline/pack/cost.h"

#include "online/contact/locate.h"
#include "online/contact/ports.h"

namespace railstep {

namespace {

constexpr std::int64_t kElementRow = 27;  // unknowns of an element's nodes
constexpr std::int64_t kSeenNodes = 6;    // of the two elements that a wheel looks at, at a joint

std::int64_t solve(const Band& band) {
  return std::int64_t{band.panels} * (32 * std::int64_t{band.left} + 128);
}

/// Rows of the basis that a point of a rail touches, at most: what a line carries of three nodes.
std::int64_t carried(const Model& model, const LineModel& line) {
  std::int64_t most = 0;
  for (const std::int32_t* table : line.unknown_of)
    for (std::int32_t node = 0; node < 3 * model.elements; ++node) {
      std::int64_t here = 0;
      for (int k = 0; k < 9; ++k) here += table[9 * node + k] >= 0 ? 1 : 0;
      most = here > most ? here : most;
    }
  return most;
}

/// Unknowns that the turns over the seats around a wheel add to its row.
std::int64_t turning(const Model& model) {
  const bool turns = model.turn.lever[0] != nullptr || model.turn.lever[1] != nullptr;
  return turns ? 2 * kTurnSeats : 0;
}

std::int64_t banded(const Model& model, const LineModel& line, std::int64_t wheels) {
  const std::int64_t n = line.size;
  const std::int64_t products = 2 * n * (line.mass.count + std::int64_t{line.damping.count});
  const std::int64_t vectors = (22 + 2 * wheels) * n;  // predict, correct, forces of wheels
  const std::int64_t rows = 2 * kElementRow * (model.loads + wheels * (wheels + 3)) +
                            2 * turning(model) * wheels * (wheels + 4);
  const std::int64_t fixed = 2 * n * model.fixed.count;  // their forces; rows are counted once
  return products + vectors + rows + fixed + (1 + wheels) * solve(line.step);
}

std::int64_t condensed(const Model& model, const LineModel& line, std::int64_t wheels) {
  const std::int64_t n = line.size, k = carried(model, line);
  const std::int64_t loads = model.loads * 3 * k * 4 * n;
  const std::int64_t seen = wheels * kSeenNodes * k * 4 * n;  // nodes where contact is looked for
  const std::int64_t rows = wheels * 3 * k * 4 * n, responses = wheels * 6 * n;
  const std::int64_t products = (wheels * (wheels + 1) / 2 + 2 * wheels) * 4 * n;
  const std::int64_t moved = wheels * 4 * n, heights = wheels * 3 * 4 * n;
  const std::int64_t ports = model.fixed.count * (12 + 4 * wheels) * n;  // depths, W, forces
  const std::int64_t turned = 2 * wheels * turning(model) * 4 * n;       // read, and put in the row
  return 22 * n + ports + turned + loads + seen + rows + responses + products + moved + heights;
}

// Of a table at one place: weights of a cubic, four products with their sum, and the force times
// it.
constexpr std::int64_t kCubic = 32, kLookUp = kCubic + 9;
constexpr std::int64_t kPairLookUp = kCubic + 4 * (kLookUp + 2) + 2;

/// Residual flexibility between all wheels and from loads to wheels: in W, in the penetration, in
/// what is published.
std::int64_t residual_step(const Model& model, std::int64_t wheels) {
  const std::int64_t pairs = wheels * (wheels + 1) / 2 + wheels * model.loads + wheels * wheels;
  return pairs * kPairLookUp + 2 * wheels * kLookUp;
}

/// Products of the vehicles' matrices, three of them dense, and of their rows.
std::int64_t vehicles(const Model& model) {
  std::int64_t sum = 0;
  for (std::int32_t i = 0; i < model.vehicles; ++i) {
    const std::int64_t n = model.vehicle[i].size, wheels = model.vehicle[i].wheels;
    sum += 6 * n * n + 40 * n + wheels * (8 * n + 2 * 3 * 2 * kElementRow * model.lines);
  }
  return sum;
}

/// And to every load, once a frame.
std::int64_t residual_frame(const Model& model, std::int64_t wheels) {
  return model.loads * (model.loads + wheels) * kPairLookUp;
}

/// Locating, the capped solve of all ports and the guides' turns.
std::int64_t contact(const Model& model, std::int64_t wheels) {
  const std::int64_t ports = wheels + model.fixed.count;
  if (ports == 0) return 0;
  std::int64_t turns = 1;
  for (std::int32_t i = 0; i < model.wheelsets; ++i)
    if (model.wheelset[i].guide == Guide::augmented_lagrangian && model.wheelset[i].cap > turns)
      turns = model.wheelset[i].cap;
  const std::int64_t newton = ports * ports * ports / 3 + 12 * ports * ports + 40 * ports;
  const std::int64_t signals = wheels * (1 + std::int64_t{model.signals}) * 50;
  const std::int64_t locate = wheels * kLocateSteps * 300 + signals;
  const std::int64_t rows = 8 * model.fixed.entries + 20 * std::int64_t{model.fixed.count} +
                            wheels * model.fixed.count * 3 * kElementRow * model.lines;
  return locate + rows + turns * (kPortSweeps * newton + 60 * wheels);
}

}  // namespace

std::int64_t flops_per_frame(const Model& model) {
  const std::int64_t wheels = std::int64_t{wheel_count(model)};
  const std::int64_t contacts = std::int64_t{contact_count(model)};
  std::int64_t step = contact(model, contacts) + residual_step(model, wheels) + vehicles(model);
  for (std::int32_t l = 0; l < model.lines; ++l)
    step += model.condensed != 0 ? condensed(model, model.line[l], contacts)
                                 : banded(model, model.line[l], contacts);
  return step * model.steps_per_frame + residual_frame(model, wheels);
}

}  // namespace railstep
