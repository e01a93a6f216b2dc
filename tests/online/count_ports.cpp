// Solves random ports, hard ones among them, with arithmetic that counts (counted/counted.h). Fails
// if a solve takes more than rt_core/offline/cost states, if one with a definite W does not
// converge, or if no other uses its whole cap.
#include "offline/cost/cost.h"
#include "online/contact/ports.h"

using namespace railstep;

namespace {

/// Numbers in [0, 1), the same on every machine (Knuth's MMIX).
class Random {
 public:
  double next() {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(static_cast<std::int64_t>(state_ >> 11)) * 0x1p-53;
  }
  /// A number from 10^from to 10^to; each power of ten is equally likely.
  double spread(int from, int to) {
    double x = 1. + 9. * next();
    for (int power = from + static_cast<int>(next() * (to - from)); power > 0; --power) x *= 10.;
    return x;
  }

 private:
  std::uint64_t state_ = 1;
};

struct Ports {
  double W[kPorts * kPorts], d_free[kPorts], f[kPorts], d[kPorts];
  PortLaw law[kPorts];
};

/// @param indefinite  W is not positive definite: most such solves use their whole cap
/// @param means       some contacts' laws are means over a step
void fill(Random& random, int n, bool indefinite, bool means, Ports& ports) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      const double own = i == j ? 1. : (indefinite ? 4. : .9 / n) * (random.next() - .5);
      ports.W[i * n + j] = ports.W[j * n + i] = 1e-8 * own;
    }
  for (int i = 0; i < n; ++i) {
    ports.d_free[i] = 1e-3 * (random.next() - .3);
    ports.f[i] = random.next() < .5 ? 0. : random.spread(0, 6);
    const bool hertz = random.next() < .6;
    ports.law[i] = {hertz ? random.spread(8, 12) : 0., hertz ? 0. : random.spread(5, 9),
                    hertz ? 0. : 1e4 * (random.next() - .5), !hertz && random.next() < .3};
    ports.law[i].mean = means && hertz && random.next() < .8;
    if (ports.law[i].mean) ports.law[i].from = 1e-3 * (random.next() - .5);
  }
}

/// The most flops of random solves. @param capped  counts those that use the whole cap
/// @param lost  counts those with a definite W that do not converge
std::int64_t most_flops(int n, bool means, int& capped, int& lost) {
  Random random;
  static Ports ports;
  std::int64_t most = 0;
  for (int trial = 0; trial < 400; ++trial) {
    fill(random, n, trial % 2 == 1, means, ports);
    counted::flops = 0;
    const PortResult got = solve_ports(n, ports.W, ports.law, ports.d_free, ports.f, ports.d);
    if (counted::flops > most) most = counted::flops;
    if (got.iterations == kPortSweeps) ++capped;
    if (trial % 2 == 0 && got.status != PortStatus::converged) ++lost;
  }
  return most;
}

}  // namespace

int main() {
  int capped = 0, lost = 0;
  std::printf("ports     most   stated\n");
  for (const bool means : {false, true})
    for (int n = 1; n <= kPorts; n += n < 8 ? 1 : 4) {
      const std::int64_t most = most_flops(n, means, capped, lost),
                         stated = ports_cost(n, means).flops;
      std::printf("%5d %8" PRId64 " %8" PRId64 "\n", n, most, stated);
      if (most > stated) {
        std::fprintf(stderr, "error: %d ports take more flops than is stated\n", n);
        return 1;
      }
    }
  std::printf("%d solves used their whole cap, %d were lost\n", capped, lost);
  return capped > 100 && lost == 0 ? 0 : 1;
}
