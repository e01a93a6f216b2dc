// The program's receptance command on the shipped scenes, and its agreement with a hammer blow in
// time.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <string>
#include <unsupported/Eigen/FFT>
#include <vector>

#include "build/build.h"
#include "offline/receptance/full_order.h"
#include "online/track/track_sensor.h"
#include "scene/scene.h"
#include "support/condensed_tracks.h"
#include "support/plotted.h"
#include "support/program.h"
#include "support/shipped.h"

using namespace railstep;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;

namespace {

using Value = std::complex<double>;

nlohmann::json answer(const std::string& words) {
  const Ran ran = railstep_program("receptance --json " + words);
  INFO(words << ": " << ran.err);
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  return nlohmann::json::parse(ran.out);
}

std::vector<Value> values_of(const nlohmann::json& told) {
  std::vector<Value> values;
  for (std::size_t i = 0; i < told.at("magnitude_m_per_n").size(); ++i)
    values.push_back(
        std::polar(told["magnitude_m_per_n"][i].get<double>(), told["phase_rad"][i].get<double>()));
  return values;
}

/// Expects exit code 2 and one error, in words with this among them and as JSON.
void check_refused(const std::string& words, const std::string& sentence) {
  const Ran ran = railstep_program("receptance --json " + words);
  INFO(words << ": " << ran.err);
  CHECK(ran.code == 2);
  CHECK(nlohmann::json::parse(ran.out).at("errors").size() == 1);
  CHECK_THAT(ran.err, Catch::Contains(sentence));
}

const std::string kS1 = shipped("receptance_s1");
const std::string kBand = " --from 50 --to-hz 400";

}  // namespace

TEST_CASE("the command answers at the requested frequencies", "[receptance]") {
  const nlohmann::json usual = answer(kS1 + " --at mid_bay" + kBand);
  const auto hz = usual.at("frequency_hz").get<std::vector<double>>();
  REQUIRE(hz.size() == 200);
  CHECK(hz.front() == 50.);
  CHECK(hz.back() == 400.);
  CHECK_THAT(hz[1] / hz[0], WithinRel(std::pow(8., 1. / 199.), 1e-12));
  CHECK(usual.at("magnitude_m_per_n").size() == 200);
  // rail-data.md, section 3: 11.695 nm/N at -23.2 degrees. Bounds: 2 %, 1 degree.
  CHECK_THAT(usual["magnitude_m_per_n"][0].get<double>(), WithinRel(11.695e-9, .02));
  CHECK_THAT(usual["phase_rad"][0].get<double>(), WithinAbs(-23.2 * M_PI / 180., M_PI / 180.));
  CHECK(usual.at("warnings").empty());
  const auto stepped = answer(kS1 +
                              " --at over_sleeper --to sleeper --from 100 --to-hz 111 "
                              "--step-hz 4")
                           .at("frequency_hz")
                           .get<std::vector<double>>();
  CHECK(stepped == std::vector<double>{100., 104., 108., 111.});
  const nlohmann::json one = answer(kS1 + " --at mid_bay --from 70 --to-hz 70 --points 5");
  CHECK(one.at("frequency_hz").size() == 1);
  for (const char* alone : {"--from 70", "--from 70 --points 1", "--from 70 --to-hz 70 --points 1"})
    CHECK(answer(kS1 + " --at mid_bay " + alone) == one);
}

TEST_CASE("swapping force and response leaves the receptance the same, in lateral direction too",
          "[receptance]") {
  const std::string scene = shipped("ballasted_track");
  const auto there = values_of(answer(scene + " --at pad --to sleeper --points 4" + kBand)),
             back = values_of(answer(scene + " --at sleeper --to pad --points 4" + kBand));
  for (std::size_t i = 0; i < 4; ++i) CHECK(std::abs(there[i] / back[i] - 1.) < 1e-10);
  const auto across = values_of(answer(
                 scene + " --at pad --direction y --to-direction z --to pad --points 3" + kBand)),
             up = values_of(
                 answer(scene + " --at pad --direction z --to-direction y --points 3" + kBand)),
             along = values_of(answer(scene + " --at pad --direction y --points 3" + kBand));
  for (std::size_t i = 0; i < 3; ++i) {
    // Sleepers that roll couple y and z by some percent. Bound: 1e-10 of the lateral receptance.
    CHECK(std::abs(across[i] - up[i]) < 1e-10 * std::abs(along[i]));
    CHECK(std::abs(across[i]) > 1e-3 * std::abs(along[i]));
    CHECK(std::abs(across[i]) < std::abs(along[i]));
  }
}

TEST_CASE("the answer has the receptances of other models beside it", "[receptance]") {
  const std::string words = kS1 +
                            " --at mid_bay --points 12 --set track.bays=40 --set "
                            "'sensor[0].position_m=12.3' --set 'sensor[1].position_m=12' --set "
                            "'sensor[2].sleeper=20' --set 'condense.modes_per_bay=2.5'" +
                            kBand;
  const nlohmann::json told = answer(words + " --beside condensed,euler,endless");
  const auto full = values_of(told);
  const auto condensed = values_of(told.at("beside").at("condensed")),
             euler = values_of(told.at("beside").at("euler")),
             endless = values_of(told.at("beside").at("endless"));
  for (std::size_t i = 0; i < full.size(); ++i) {
    // Up to 400 Hz, waves in 40 bays decay to 1e-7 at the ends and the mesh errs by 1e-4 (its own
    // sizes, as in the tests of receptances). Modes up to 1 kHz err by (f/1 kHz)^2 of the 5 %
    // residual.
    CHECK(std::abs(full[i] / endless[i] - 1.) < 2e-4);
    CHECK(std::abs(full[i] / condensed[i] - 1.) < 1e-2);
    CHECK(std::abs(full[i] / euler[i]) > 1.03);
  }
  const nlohmann::json other = answer(words + " --model condensed --beside full");
  CHECK(other.at("model") == "condensed");
  CHECK(values_of(other) == condensed);
  CHECK(values_of(other.at("beside").at("full")) == full);
}

TEST_CASE("the answer has resonances, decay rates and warnings", "[receptance]") {
  const nlohmann::json told = answer(kS1 + " --at mid_bay --from 40 --to-hz 1300 --decay-rate");
  REQUIRE(told.at("resonances").size() == 4);
  CHECK(told["resonances"][3]["name"] == "pinned-pinned");
  CHECK_THAT(told["resonances"][3]["frequency_hz"].get<double>(), WithinRel(1067.25, .01));
  const nlohmann::json& decay = told.at("decay_rate");
  CHECK(decay.at("distance_m").size() == 29);
  CHECK(decay.at("band_hz") ==
        std::vector<int>{100, 125, 160, 200, 250, 315, 400, 500, 630, 800, 1000});
  // The sleeper's anti-resonance stops waves, the pinned-pinned resonance lets them run.
  const auto rate = decay.at("db_per_m").get<std::vector<double>>();
  CHECK(*std::max_element(rate.begin(), rate.end()) == rate[4]);
  CHECK(*std::min_element(rate.begin(), rate.end()) == rate[10]);
  const nlohmann::json shorter =
      answer(kS1 +
             " --at mid_bay --from 40 --to-hz 800 --decay-rate --set track.bays=16 --set "
             "'sensor[0].position_m=5.1' --set 'sensor[1].position_m=4.8' --set "
             "'sensor[2].sleeper=8'");
  REQUIRE(shorter.at("warnings").size() == 2);
  CHECK(shorter["warnings"][0]["id"] == "W-RECEPTANCE-01");
  CHECK(shorter["warnings"][1]["id"] == "W-RECEPTANCE-03");
  const auto hz = shorter.at("frequency_hz").get<std::vector<double>>();
  const auto effect = shorter.at("end_effect").get<std::vector<double>>();
  for (std::size_t i = 0; i < hz.size(); ++i) {
    if (hz[i] < 400.) CHECK(effect[i] < .01);
    if (hz[i] > 600.) CHECK(effect[i] > .01);
  }
}

TEST_CASE("a hammer blow in time gives the same receptance", "[receptance]") {
  // 24 bays of S1 under a blow of 0.2 ms and 1 N, 0.4 s at 20 us: displacements have fallen to 1e-4
  // of their peak. Fourier sums at multiples of 2.5 Hz are divided by the blow's transform, T
  // sinc^2. The bound is 1 % up to 700 Hz. There omega dt is .09, and the scheme lowers the
  // frequency by (omega dt)^2/6 = 1.3e-3. A slope of 20 dB per octave makes three times that.
  // Narrow resonances above 700 Hz have larger errors.
  constexpr double dt = 20e-6, blow = 1e-4;
  constexpr int steps = 20'000;
  for (const bool condensed : {false, true}) {
    Scene scene = read_scene(kS1, {"track.bays=24", "sensor[0].position_m=7.5",
                                   "sensor[1].position_m=7.2", "sensor[2].sleeper=12"});
    const Track track = track_of(scene);
    const Functional here = rail_point({0, 7.5, 0., 0., 2}), sleeper{.sleeper = {{0, 12, 2, 1.}}};
    Traffic traffic;
    traffic.loads = {{.rail = 0,
                      .start = 7.5,
                      .stop = 20.,
                      .force = 1.,
                      .table = {0., 0., blow, 1., 2. * blow, 0.}}};
    traffic.track_sensors = {{.displacement = 1., .track = here},
                             {.displacement = 1., .track = sleeper}};
    PackOptions options = full_order(dt);
    if (condensed) {
      options.scheme = held_force(dt, .6);
      options.reduction = Reduction{.limit = {100'000, 2500.}};
    }
    ModelRun run(track, traffic, options);
    std::vector<Value> history[2];
    double track_sensors[2];
    for (auto& h : history) h.push_back(0.);
    for (int i = 0; i < steps; ++i) {
      run.step();
      read_track_sensors(run.model(), run.state, run.outputs, track_sensors);
      for (int k = 0; k < 2; ++k) history[k].push_back(track_sensors[k]);
    }
    for (auto& h : history) h.back() *= .5;  // trapezoidal rule; the first sample is 0
    FullOrderReceptance full(track, {here, {here, sleeper}});
    Eigen::FFT<double> fft;
    std::vector<Value> transform[2];
    for (int k = 0; k < 2; ++k) {
      history[k].pop_back();  // the last sample, 1e-4 of the peak
      fft.fwd(transform[k], history[k]);
    }
    double worst = 0.;
    for (int n = 8; n <= 280; ++n) {
      const double hz = n / (steps * dt), w = 2. * M_PI * hz, half = .5 * w * blow;
      const Value force = blow * std::pow(std::sin(half) / half, 2) * std::polar(1., -w * blow);
      const Eigen::VectorXcd want = full.at(hz);
      for (int k = 0; k < 2; ++k) {
        const Value got = dt * transform[k][static_cast<std::size_t>(n)] / force;
        const double error = std::abs(got - want[k]) / std::abs(want[k]);
        CAPTURE(condensed, hz, k, std::abs(want[k]), error);
        CHECK(error < .01);
        worst = std::max(worst, error);
      }
    }
    CAPTURE(condensed, worst);
    CHECK(worst > 0.);
  }
}

TEST_CASE("receptance refuses in one sentence a track or a point that has none", "[receptance]") {
  check_refused(kS1 + " --at nowhere" + kBand, "mid_bay, over_sleeper, sleeper");
  check_refused(kS1 + " --at mid_bay --to nowhere" + kBand, "'nowhere'; expected one of mid_bay");
  check_refused(kS1 + " --at mid_bay --from 500 --to-hz 400", "E-RECEPTANCE-14");
  check_refused(kS1 + " --at mid_bay --from 0 --to-hz 400", "--from");
  check_refused(kS1 + " --at mid_bay --from nan --to-hz 400", "--from");
  check_refused(kS1 + " --at mid_bay --direction y" + kBand, "E-RECEPTANCE-22");
  check_refused(kS1 + " --at mid_bay --direction x" + kBand, "--direction");
  check_refused(kS1 + " --at mid_bay --points 0" + kBand, "--points");
  check_refused(kS1 + " --at mid_bay --from 70 --report one.html", "E-RECEPTANCE-21");
  check_refused(kS1 + " --at mid_bay --points 1" + kBand, "E-RECEPTANCE-15");
  check_refused(kS1 + " --at mid_bay --points 9 --step-hz 3" + kBand, "--step-hz");
  check_refused(kS1 + " --at mid_bay --step-hz 0.001" + kBand, "E-RECEPTANCE-16");
  check_refused(kS1 + " --at mid_bay --beside nastran" + kBand, "--beside");
  check_refused(kS1 + " --at mid_bay --decay-rate --from 40 --to-hz 80", "E-RECEPTANCE-19");
  check_refused(kS1 + " --at sleeper --decay-rate" + kBand, "E-RECEPTANCE-18");
  check_refused(shipped("ballasted_track") + " --at sleeper --direction y" + kBand,
                "E-RECEPTANCE-23");
  check_refused(shipped("ballasted_track") + " --at pad --direction y --beside euler" + kBand,
                "vertical");
  check_refused(shipped("wheelset_on_track") + " --at wheelset" + kBand, "E-RECEPTANCE-17");
  check_refused(shipped("double_pendulum") + " --at A" + kBand, "bodies and beams");
  check_refused(shipped("free_rail") + " --at mid_bay" + kBand, "E-RECEPTANCE-24");
  check_refused(kS1 + " --at mid_bay --set rail.axial_force_n=-1e9" + kBand, "E-TRACK-33");
  check_refused(shipped("free_rail") +
                    " --set 'sensor=[{name=\"a\", on=\"rail\", position_m=1.0}]' --at a --model "
                    "condensed" +
                    kBand,
                "E-TRACK-35");
}

TEST_CASE("a free rail answers with its mass below its modes", "[receptance]") {
  // At 1 Hz the middle of a 2 m rail moves as -1/(m omega^2), to (1 Hz/290 Hz)^2 = 1.2e-5.
  const nlohmann::json told = answer(
      shipped("free_rail") +
      " --set 'sensor=[{name=\"a\", on=\"rail\", position_m=1.0}]' --at a --from 1 --to-hz 1");
  const double mass = 7850. * 8.7e-3 * 2.;
  CHECK_THAT(told["magnitude_m_per_n"][0].get<double>(),
             WithinRel(1. / (mass * 4. * M_PI * M_PI), 5e-5));
  CHECK(told["phase_rad"][0].get<double>() == M_PI);
  CHECK_FALSE(told.contains("end_effect"));
}

TEST_CASE("receptance writes its curves and its report", "[receptance]") {
  const auto folder = fresh_folder("receptance");
  const std::string csv = (folder / "curves.csv").string(), page = (folder / "page.html").string();
  const nlohmann::json told = answer(kS1 +
                                     " --at mid_bay --beside euler --decay-rate --points 60 "
                                     "--from 40 --to-hz 1300 --csv " +
                                     csv + " --report " + page);
  const std::string text = text_of(csv), html = text_of(page);
  CHECK(text.substr(0, text.find('\n')) ==
        "frequency_hz,full.magnitude_m_per_n,full.phase_rad,euler.magnitude_m_per_n,"
        "euler.phase_rad,end_effect");
  CHECK(std::count(text.begin(), text.end(), '\n') == 61);
  double first_hz = 0., magnitude = 0.;
  REQUIRE(std::sscanf(text.c_str() + text.find('\n'), "%lf,%lf", &first_hz, &magnitude) == 2);
  CHECK(first_hz == told["frequency_hz"][0].get<double>());
  CHECK(magnitude == told["magnitude_m_per_n"][0].get<double>());
  const auto hz = told["frequency_hz"].get<std::vector<double>>();
  const auto drawn = [&](const char* heading, const char* name, bool log_y) {
    return plotted(html, std::string("<h2>") + heading, name, true, log_y);
  };
  const auto check_curve = [&](const nlohmann::json& of, const char* name) {
    auto nm = of["magnitude_m_per_n"].get<std::vector<double>>(),
         degrees = of["phase_rad"].get<std::vector<double>>();
    for (double& each : nm) each *= 1e9;
    for (double& each : degrees) each *= 180. / M_PI;
    check_drawn(drawn("Magnitude", name, true), hz, nm, 1e-3);  // a logarithm's pixel is wider
    check_drawn(drawn("Phase", name, false), hz, degrees, 1e-3);
  };
  check_curve(told, "full order");
  check_curve(told["beside"]["euler"], "Euler-Bernoulli");
  // The bands are numbered from 0 along the axis, on which their frequencies are written.
  const auto rate = told["decay_rate"]["db_per_m"].get<std::vector<double>>();
  const Curve decay = plotted(html, "<h2>Track decay rate", "", false, true);
  REQUIRE(decay.y.size() == rate.size());
  for (std::size_t i = 0; i < rate.size(); ++i) CHECK_THAT(decay.y[i], WithinRel(rate[i], 1e-3));
  for (const char* name : {"track on ballast", "sleeper anti-resonance", "rail on pads",
                           "pinned-pinned", "Euler-Bernoulli", "dB/m"})
    CHECK_THAT(html, Catch::Contains(name));
  CHECK_THAT(html, !Catch::Contains("http-equiv") && !Catch::Contains("<script src"));
}
