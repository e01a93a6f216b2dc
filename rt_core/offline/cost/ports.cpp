#include "online/contact/ports.h"

#include "offline/cost/cost.h"

namespace railstep {

Cost ports_cost(std::int64_t n) {
  constexpr std::int64_t halvings = 3;  // of a step, at most, each with a look at its end
  const Cost look = work(3 * n * n + 25 * n, n * n + 6 * n);
  const Cost matrix = work(3 * n * n + 3 * n, 2 * n * n);
  const Cost factor = work(n * n * n / 3 + 4 * n * n + 3 * n, n * n * n / 3 + 3 * n * n);
  const Cost back = work(3 * n * n + 5 * n, n * n + 4 * n), next = work(70 * n, 12 * n);
  const Cost halving = work(150 * n, 20 * n) + look;
  const Cost iteration = matrix + factor + back + next + look + halvings * halving;
  return work(2 * n * n + 60 * n, n * n + 8 * n) + kPortSweeps * iteration + 2 * look;
}

}  // namespace railstep
