#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "study/outputs.h"
#include "study/setting.h"

namespace railstep {

/// A scene as a study steps it: its frames stay, and are what is compared.
struct Studied {
  std::filesystem::path file;
  std::vector<std::string> overrides;
  double frame = 0.;  // s
  Judged judged;
  std::int64_t frames = 0;  // of each run; 0: all of the scene's
};

/// Reads the scene. Where it starts released and no time is given, the first fifth of the run is
/// left out. Throws InputError for a scene that cannot be run, or has no track.
Studied study_of(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                 const Judged& judged);

/// "key=value" over the scene that make one setting of it: those of the study, those of the
/// setting, and for a ring in full order the bays that a window needs. Throws InputError.
std::vector<std::string> overrides_of(const Studied& study, const Setting& setting);

/// The scene with one setting. Throws InputError.
Scene scene_with(const Studied& study, const Setting& setting);

/// All frames of the scene with one setting, of which it keeps what is compared.
TraceTable run_of(const Studied& study, const Setting& setting);

/// The trace against which others are measured, and an estimate of its own error.
struct Reference {
  TraceTable trace;
  std::string how;  // words
  /// The own error, of the outputs that are judged: the change from the level before, over 2^p - 1
  /// with p the order seen over three levels, from 1 to 2; with two levels p = 1.
  double error = 0.;
};

struct Refinement {
  int elements_per_bay;  // of the coarsest level; the next has twice as many, and half the step
  double step;           // s
  double target;         // refined until its error is below,
  int most_levels;       // or so often
  /// A run: its tenth of an error stands in the place of `target`. Null: `target` it is.
  const TraceTable* judged_run = nullptr;
};

/// Full order by generalised-alpha, mesh and step refined together.
/// @param after  called after each level with the number of them done; may be empty
Reference refine(const Studied& study, const Refinement& refinement,
                 const std::function<void(int)>& after = {});

/// A trace that something else made.
/// @param error  as its maker states it
Reference named_reference(const std::filesystem::path& trace, double error);

}  // namespace railstep
