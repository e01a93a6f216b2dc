// A wheel on rings of bays in Floquet modes, compared with a long track of full order, as CSV on
// stdout for docs/endless.md: errors of its contact force, of the rail under it, of a sleeper that
// it passes and of that sleeper's pad force. For an even rail they are relative to the peak. For a
// rail with waves that pass at a frequency, only the part that the waves add is compared, relative
// to its peak. Each error is of every step ("all"), and of the difference below 500 Hz ("band").
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "endless_scene.h"
#include "offline/start/start.h"
#include "offline/track/functional.h"
#include "online/track/track_sensor.h"

namespace railstep {
namespace {

constexpr double kStep = 4e-5, kEnd = .4, kSettled = .3;  // s; errors count after kSettled
constexpr double kFrequencies[] = {0., 20., 50., 100., 200., 500., 1000.};  // Hz; 0: an even rail
constexpr double kBand = 500.;                                              // Hz
constexpr int kFirstSeat = 91;  // of the long track: ahead of the wheel at the start, 54 m
constexpr int kSeats = 22;      // passed in the run, and one more

const char* const kNames[] = {"contact_force", "rail", "sleeper", "pad_force"};
using Quantities = std::array<std::vector<double>, 4>;

/// Half of a quarter of a car on one wheel, on a rail with waves of 1e-2 m Hz / frequency.
Traffic wheel_over(double x, double hz) {
  RunningVehicle v;
  v.vehicle = sprung_mass(4650., 906.5, 1.22e6, 20e3).vehicle;
  v.start = x;
  v.speed = kSpeed;
  Traffic traffic{.vehicles = {v}, .head = {.081, .3, .035}};
  if (hz == 0.) return traffic;
  constexpr int kSamples = 32;  // per wave: the spline errs by 4e-6
  std::vector<double> wave(kSamples);
  for (std::size_t k = 0; k < wave.size(); ++k)
    wave[k] = 1e-2 / hz * std::sin(2. * M_PI * static_cast<double>(k) / kSamples);
  traffic.irregularities.push_back({0, 2, fit_signal(wave, x, kSpeed / hz / kSamples, true)});
  return traffic;
}

/// Adds sensors of a sleeper's height and of its pad's force.
void add_seat(const Track& track, int seat, std::vector<TrackSensor>& track_sensors) {
  Functional sleeper;
  sleeper.sleeper.push_back({0, seat, 2, 1.});
  track_sensors.push_back({.displacement = 1., .track = sleeper});
  track_sensors.push_back({.displacement = track.support.stiffness[2],
                           .velocity = track.support.damping[2],
                           .track = pad_gap(track, 0, seat)});
}

/// Results of a run with `finer` steps per kStep: forces in the middle of each kStep, where the
/// ring's held forces count, all else at its end.
/// @param seat  index of the track sensors to read after n steps of kStep
template <typename Seat>
Quantities heard(const Track& track, PackedModel& packed, int finer, const Seat& seat) {
  packed.set_start(start_in_equilibrium(track, packed, 0.));
  Run run(packed);
  std::vector<double> track_sensor(static_cast<std::size_t>(packed.model().track_sensor.count));
  Quantities found;
  for (int n = 1; n <= std::lround(kEnd / kStep); ++n) {
    const bool wanted = n * kStep > kSettled;
    for (int part = 1; part <= finer; ++part) {
      const Outputs& out = run.frame();
      if (wanted && part == (finer + 1) / 2) found[0].push_back(out.contact_force[0]);
    }
    if (!wanted) continue;
    read_track_sensors(packed.model(), run.state(), run.outputs(), track_sensor.data());
    found[1].push_back(run.outputs().contact_rail_z[0]);
    for (const std::size_t k : {0u, 1u}) found[2 + k].push_back(track_sensor[2 * seat(n) + k]);
  }
  return found;
}

Quantities reference(double hz, int finer) {
  const Track track = track_of(200, 8, 1);
  Traffic traffic = wheel_over(54., hz);
  for (int seat = 0; seat < kSeats; ++seat)
    add_seat(track, kFirstSeat + seat, traffic.track_sensors);
  PackedModel packed(track, traffic,
                     {.scheme = generalised_alpha(kStep / finer, .6), .residual_points = 8});
  return heard(track, packed, finer, [](int n) {
    return static_cast<std::size_t>(std::floor(kSpeed * kStep * n / .6 + 1e-9));
  });
}

Quantities on_ring(double hz, int bays, int modes) {
  const Track ring = ring_of(bays, 1, 8);
  Traffic traffic = wheel_over(0., hz);
  add_seat(ring, bays / 2 + 1, traffic.track_sensors);
  PackedModel packed(ring, traffic, ring_options(bays, modes, kStep));
  return heard(ring, packed, 1, [](int) { return std::size_t{0}; });
}

/// Difference of a rail with waves from an even rail.
Quantities added(Quantities with, const Quantities& even) {
  for (std::size_t q = 0; q < with.size(); ++q)
    for (std::size_t i = 0; i < with[q].size(); ++i) with[q][i] -= even[q][i];
  return with;
}

/// Results for all frequencies, each by made(hz).
template <typename Made>
std::vector<Quantities> all(const Made& made) {
  std::vector<Quantities> found;
  for (const double hz : kFrequencies)
    found.push_back(found.empty() ? made(hz) : added(made(hz), found.front()));
  return found;
}

/// Largest difference below kBand over the peak. A Hann window as long as kBand's period averages
/// the differences; it halves a wave of kBand.
double error_in_band(const std::vector<double>& got, const std::vector<double>& want) {
  const auto width = static_cast<std::size_t>(std::lround(1. / (kBand * kStep)));
  double largest = 0., peak = 0.;
  for (std::size_t from = 0; from + width <= want.size(); ++from) {
    double mean = 0.;
    for (std::size_t k = 0; k < width; ++k) {
      const double turn = 2. * M_PI * (static_cast<double>(k) + .5) / static_cast<double>(width);
      mean += (1. - std::cos(turn)) * (got[from + k] - want[from + k]);
    }
    largest = std::max(largest, std::fabs(mean) / static_cast<double>(width));
  }
  for (const double value : want) peak = std::max(peak, std::fabs(value));
  return largest / peak;
}

void print(const std::string& what, const std::vector<Quantities>& got,
           const std::vector<Quantities>& want) {
  struct {
    double (*error)(const std::vector<double>&, const std::vector<double>&);
    const char* band;
  } constexpr kErrors[] = {{error_over_peak, "all"}, {error_in_band, "band"}};
  for (const auto& [error, band] : kErrors)
    for (std::size_t q = 0; q < std::size(kNames); ++q) {
      std::printf("%s,%s,%s", what.c_str(), kNames[q], band);
      for (std::size_t i = 0; i < want.size(); ++i)
        std::printf(",%.1e", error(got[i][q], want[i][q]));
      std::printf("\n");
    }
  std::fflush(stdout);
}

void table() {
  std::printf("bays,modes_per_bay,quantity,frequencies");
  for (const double hz : kFrequencies) std::printf(",error_%g_hz", hz);
  std::printf("\n");
  const std::vector<Quantities> want = all([](double hz) { return reference(hz, 4); });
  print("reference,", all([](double hz) { return reference(hz, 2); }), want);
  for (const int bays : {16, 24, 40})
    for (const int modes : {1, 2, 3})
      print(std::to_string(bays) + "," + std::to_string(modes),
            all([&](double hz) { return on_ring(hz, bays, modes); }), want);
}

}  // namespace
}  // namespace railstep

int main() { railstep::table(); }
