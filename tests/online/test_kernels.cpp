#include <catch2/catch.hpp>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "online/beam/kernels.h"
#include "support/stored_kernels.h"

using namespace railstep;

namespace {

/// Whether /proc/cpuinfo lists a feature of the processor; `otherwise` if it lists none.
bool system_says(const std::string& feature, bool otherwise) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.rfind("flags", 0) == 0) {
      std::istringstream words(line);
      for (std::string word; words >> word;)
        if (word == feature) return true;
      return false;
    }
  return otherwise;
}

/// Everything that the calls for a row of elements write, in order; NaN where nothing was written.
/// A factor is given by its solutions, as some of its numbers are never read.
template <int W>
std::vector<double> all_written(const RowKernels& row, int n, std::uint64_t seed, bool half) {
  std::vector<double> all;
  const auto unset = [](std::int64_t size) {
    return std::vector<double>(static_cast<std::size_t>(size) + 1,
                               std::numeric_limits<double>::quiet_NaN());
  };
  const auto keep = [&all](const std::vector<double>& x) {
    all.insert(all.end(), x.begin(), x.end());
  };
  const auto some = [](std::vector<double> of_nodes) {
    of_nodes.resize(of_nodes.size() / 9 * W);
    return of_nodes;
  };
  const std::int64_t size = std::int64_t{W} * chain_nodes(n);
  const std::vector<double> q = some(shaken_nodes(n, seed, .3));
  const std::vector<double> d = some(shaken_nodes(n, 500 + seed, .3));
  const double* change = half ? d.data() : nullptr;
  const std::vector<std::int32_t> held{0, 1, W + 1, static_cast<std::int32_t>(size - 1)};
  const Chain chain{.beam = made_up_beam(),
                    .mass = {67.9, .0468, .304, -5.77},
                    .held = held.data(),
                    .held_count = static_cast<std::int32_t>(held.size()),
                    .elements = n};

  std::vector<double> alone = unset(size), force = unset(size);
  std::vector<double> tangents = unset(chain_tangent_doubles<W>(n));
  row.forces(chain.beam, n, q.data(), change, alone.data());
  row.tangents(chain.beam, n, q.data(), change, force.data(), tangents.data());
  keep(alone);
  keep(force);
  keep(tangents);
  row.inertia(chain, d.data(), force.data());
  keep(force);

  std::vector<double> factor = unset(chain_factor_doubles<W>(n));
  all.push_back(row.factor(chain, 4e9, .5, tangents.data(), factor.data()));
  Numbers numbers(seed);
  std::vector<double> sides, one;
  for (std::int64_t i = 0; i < size; ++i) {
    for (int s = 0; s < kChainSides; ++s) sides.push_back(numbers.next());
    one.push_back(sides.back());
  }
  row.solve(chain, factor.data(), sides.data());
  row.solve_one(chain, factor.data(), one.data());
  keep(sides);
  keep(one);
  return all;
}

template <int W>
void check_rows(const RowKernels& own, const RowKernels& base) {
  for (int n = 1; n <= 9; ++n)
    for (std::uint64_t seed = 0; seed < 5; ++seed)
      for (const bool half : {false, true}) {
        INFO(n << " elements, seed " << seed << ", half a change " << half);
        const std::vector<double> got = all_written<W>(own, n, seed, half);
        const std::vector<double> want = all_written<W>(base, n, seed, half);
        REQUIRE(got.size() == want.size());
        REQUIRE(same_bits(got.data(), want.data(), got.size()));
      }
}

}  // namespace

TEST_CASE("the kernels of this processor have the bits of the base kernels", "[kernels]") {
  if (&kernels_in_use() == &kBaseKernels)
    WARN("this processor or build has the base alone: nothing is compared");
  check_rows<9>(kernels_in_use().space, kBaseKernels.space);
  check_rows<5>(kernels_in_use().plane, kBaseKernels.plane);
}

TEST_CASE("the best kernels that the processor supports are in use", "[kernels]") {
  CHECK(std::string(kBaseKernels.name) == "base");
  const std::string own = kernels_in_use().name;
#ifdef RAILSTEP_HAS_AVX2_KERNELS
  CHECK(own == (system_says("avx2", own == "avx2") ? "avx2" : "base"));
#else
  CHECK(own == "base");
#endif
}
