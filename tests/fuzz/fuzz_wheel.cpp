// A running surface (TOML): of a wheel or of a rail, each put on the other shipped one.
#include <cmath>
#include <optional>

#include "mutate.h"
#include "offline/profile/elastic_touch.h"
#include "oracle.h"
#include "section/running_profile.h"

using namespace railstep;
using namespace railstep::fuzz;

namespace {

const std::filesystem::path kShipped =
    std::filesystem::path(RAILSTEP_SOURCE) / "config" / "profiles";

void check_surface(const RunningSurface& surface) {
  check(surface.first() < surface.last(), "a surface without width");
  for (int i = 0; i <= 50; ++i) {
    const double y = surface.first() + (surface.last() - surface.first()) * i / 50.;
    check(std::isfinite(surface.at(y).height), "a height that is not finite");
  }
}

/// An accepted surface touches at finite places and carries its load, or a refusal says why not.
void check_pair(const RunningSurface& wheel, const RunningSurface& rail) {
  const WheelRail pair{wheel, rail, .75, .46};
  const auto refuse_or = [](const auto& f) {
    try {
      f();
    } catch (const Refused& refusal) {
      check_sentence(refusal.sentence());
    }
  };
  refuse_or([&] {
    const WheelsetTouch t = touch(pair, 2e-3, true);
    check(std::isfinite(t.roll) && std::isfinite(t.radius_difference()), "a place of no number");
  });
  refuse_or([&] {
    const WheelsetLoaded w = loaded(pair, {}, 1e-3, 5e4);
    double sum = 0.;
    for (const WheelPatch& p : w.right.patches) sum += p.upright;
    check(std::abs(sum / 5e4 - 1.) < 1e-3, "a load that is not carried");
  });
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  return mutate_text(data, size, most, seed);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto file = written("input.toml", text_of(data, size));
  static const RunningSurface wheel = read_wheel_profile(kShipped / "s1002.toml").growth;
  static const RunningSurface rail =
      read_placed_rail(kShipped / "60e1.toml", {.025, 1.435}).surface;
  std::optional<RunningSurface> own;
  if (accepts([&] { own = read_wheel_profile(file).growth; })) {
    check_surface(*own);
    check_pair(*own, rail);
  }
  if (accepts([&] { own = read_placed_rail(file, {.025, 1.435}).surface; })) {
    check_surface(*own);
    check_pair(wheel, *own);
  }
  return 0;
}
