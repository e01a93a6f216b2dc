#include "offline/cost/cost.h"
#include "online/contact/ports.h"

namespace railstep {

Cost ports_cost(std::int64_t n, bool means) {
  constexpr std::int64_t halvings = 3;  // of a step, at most, each with a look at its end
  const Cost look = work(3 * n * n + 25 * n, n * n + 6 * n);
  const Cost matrix = work(3 * n * n + 3 * n, 2 * n * n);
  const Cost factor = work(n * n * n / 3 + 4 * n * n + 3 * n, n * n * n / 3 + 3 * n * n);
  const Cost back = work(3 * n * n + 5 * n, n * n + 4 * n), next = work(70 * n, 12 * n);
  // A law that is a mean takes up to 45 operations with its slope, and its depth six iterations of
  // both.
  const Cost law = means ? work(45 * n, 4 * n) : Cost{},
             depth = means ? work(330 * n, 8 * n) : Cost{};
  const Cost halving = work(150 * n, 20 * n) + look + law + depth;
  const Cost iteration = matrix + factor + back + next + look + 2 * law + halvings * halving;
  const Cost lone = means ? work(190 * n, 4 * n) : Cost{};  // three steps of each port alone
  return lone + work(4 * n * n + 60 * n, 2 * n * n + 8 * n) + kPortSweeps * iteration +
         2 * (look + law);
}

}  // namespace railstep
