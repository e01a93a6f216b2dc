#include "run/run_energy.h"

#include <algorithm>
#include <vector>

#include "offline/energy/system_account.h"
#include "offline/math/refuse.h"

namespace railstep {

bool has_energies(const Simulation& run) {
  if (run.packed() == nullptr) return run.system() != nullptr;
  const std::vector<PackedLine>& lines = run.packed()->lines();
  return std::none_of(lines.begin(), lines.end(),
                      [](const PackedLine& own) { return own.basis.flexibility.size() > 0; });
}

std::optional<EnergyBalance> balance_of_run(const Simulation& run, const RunRecord& record,
                                            std::int64_t frames, const FrameInputs& inputs,
                                            const std::function<void(std::int64_t)>& after) {
  if (!has_energies(run) || record.first_bad_unknown >= 0) return std::nullopt;
  const EnergyBalance found = run.system() != nullptr
                                  ? balance_of(*run.system()->packed, frames, after, inputs)
                                  : balance_of(*run.packed(), run.model(), frames, after, inputs);
  if (found.hash != state_hash(run.model(), run.state))
    fail("E-RUN-07", "a second run of the same model ended in another state");
  return found;
}

}  // namespace railstep
