#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "online/model/external_input.h"
#include "run/simulation.h"

namespace railstep {

/// The values that a vehicle outside the model needs to close its contacts in the next frame, as
/// further values of an exchange. Behind the model's inputs stand the places that its wheels will
/// have in that frame, two of each; behind the outputs
///   2 n           those places, as they were asked for
///   3 n           what the points there do without the wheels' forces in that frame, m
///   3 n (3n+1)/2  how they give way to those forces, m/N: rows of the lower triangle
/// of n wheels: external_response() after each frame, so that an answer has the whole time up to
/// the next one.
class Response {
 public:
  /// @param run  of a model with external wheels
  explicit Response(const Simulation& run);

  /// Puts the names of its values behind those of the model's.
  static void add_names(const Simulation& run, std::vector<std::string>& inputs,
                        std::vector<std::string>& outputs);
  std::size_t count() const noexcept { return (kExternalPlaces + 3) * wheels_ + triangle(); }

  /// @param places  [2 wheels] x and y of each
  void ask(const double* places) noexcept;
  /// @param given   [model.inputs] of the last frame
  /// @param values  [count()] overwritten
  /// @returns the status of the places asked for
  Status answer(Simulation& run, const double* given, double* values) noexcept;

 private:
  std::size_t triangle() const noexcept { return 3 * wheels_ * (3 * wheels_ + 1) / 2; }

  std::size_t wheels_;
  std::vector<double> places_, inputs_, compliance_;
};

}  // namespace railstep
