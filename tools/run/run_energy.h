#pragma once
#include <cstdint>
#include <functional>
#include <optional>

#include "offline/energy/energy_account.h"
#include "run/simulate.h"

namespace railstep {

/// Whether the energies of a run are known. They are not for a model file, which has no matrices,
/// and not for truncated damped modes, whose forces do work that is in none of their matrices.
bool has_energies(const Simulation& run);

/// The energies of a run, from a second pass over it; nothing where they are not known, and for a
/// run that did not stay finite. Throws Failed where that pass ends in another state.
/// @param record  of the run, which began at its model's start
/// @param after   called after every frame with the number of frames done; may be empty
std::optional<EnergyBalance> balance_of_run(const Simulation& run, const RunRecord& record,
                                            std::int64_t frames, const FrameInputs& inputs = {},
                                            const std::function<void(std::int64_t)>& after = {});

}  // namespace railstep
