#pragma once
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "offline/receptance/decay_rate.h"
#include "offline/receptance/end_reflection.h"
#include "offline/receptance/resonances.h"
#include "text/message.h"

namespace railstep {

/// A request for a receptance of a scene.
struct ReceptanceRequest {
  std::string scene;
  std::vector<std::string> overrides;
  std::string at, to;                   // sensors; no `to`: the driving point
  std::string direction, to_direction;  // "z" or "y"; none of `to`: that of `at`
  double from_hz, to_hz;                // ends included
  int points;                           // at logarithmic steps,
  std::optional<double> step_hz;        // or at equal ones
  bool condensed;                       // the model that answers, else full order
  std::vector<std::string> beside;      // "full", "condensed", "euler", "endless"
  bool decay;                           // rates along the rail
  bool reflection;                      // of the far end
};

/// One model's receptance over the frequencies.
struct ReceptanceCurve {
  std::string name;
  std::vector<std::complex<double>> value;  // m/N
};

struct ReceptanceAnswer {
  std::string force, read;  // "mid_bay.z"
  std::vector<double> hz;
  ReceptanceCurve curve;
  std::vector<ReceptanceCurve> beside;
  std::vector<double> end_effect;      // relative, at the frequencies; empty: no supports
  std::vector<Resonance> resonances;   // of vertical driving points of a rail
  std::vector<double> decay_distance;  // m; empty where no rates are asked for
  std::vector<DecayRate> decay;
  std::vector<Reflection> reflection;  // of the far end, at the frequencies; empty: not asked for
  std::vector<Message> warnings;
};

/// An end effect above this is a warning.
inline constexpr double kMostEndEffect = .01;

/// Throws InputError, in one sentence, on what the scene or the request do not allow, and Failed at
/// a frequency at which the track swings undamped.
ReceptanceAnswer solve_receptance(const ReceptanceRequest& request);

}  // namespace railstep
