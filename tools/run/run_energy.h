#pragma once
#include <cstdint>
#include <functional>
#include <optional>

#include "offline/energy/energy_account.h"
#include "run/simulate.h"

namespace railstep {

/// Whether the energies of a run can be told. They cannot of a model file, which has no matrices,
/// and of truncated damped modes, whose forces do work that no matrix of theirs takes up.
bool has_energies(const Simulation& run);

/// The energies of what was run, from a second pass over it; none where there are none, and of a
/// run that did not stay finite. Throws std::runtime_error where that pass ends in another state.
/// @param record  of the run, which began at its model's start
/// @param after   called after every frame with the number of frames done; may be empty
std::optional<EnergyBalance> balance_of_run(const Simulation& run, const RunRecord& record,
                                            std::int64_t frames, const FrameInputs& inputs = {},
                                            const std::function<void(std::int64_t)>& after = {});

}  // namespace railstep
