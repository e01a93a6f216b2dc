#pragma once
#include <string>
#include <vector>

#include "scene/scene.h"

namespace railstep {

/// The choices in stepping a scene.
struct Setting {
  /// "KIND[:AMOUNT][:bare][:UNKNOWNS]": the kind of [condense] or "full", how much it keeps
  /// (modes_per_bay, of "guyan" and "irs" nodes_per_bay), without residual flexibility, and
  /// track.unknowns where they are not the scene's.
  std::string model;
  int elements_per_bay;  // 0: of rigid rails, which have no mesh
  /// "own" as the scene says. In full order "generalised-alpha:RHO", "newmark", "hht:ALPHA",
  /// "backward-euler", "tr-bdf2"; of condensed models "held:RHO", "discrete-gradient".
  std::string scheme;
  double step;  // s
  /// "key=value" over the scene besides.
  std::vector<std::string> changes = {};
};

bool is_condensed(const std::string& model);
bool is_of_condensed(const std::string& scheme);

/// The scene's own elements per bay; 0 of rigid rails.
int mesh_of(const Scene& scene);

/// "key=value" over a scene that make it so; frames stay as they are. Throws InputError for a model
/// or a scheme that there is not.
std::vector<std::string> overrides_of(const Setting& setting);

/// "modal:2, 2 elements a bay, held:0.6, 50 us, contact.creep="polach""
std::string words_of(const Setting& setting);

/// Lists of which all that go together are taken.
struct Choices {
  std::vector<std::string> models;
  std::vector<int> meshes;  // elements per bay
  std::vector<std::string> schemes;
  std::vector<double> steps;             // s
  std::vector<std::string> varied = {};  // "key=a,b,c" each
};

/// The choices of a study: models of both ends of the ladder, meshes and steps about the scene's
/// own, the schemes that its contacts allow.
Choices default_choices(const Scene& scene);

/// The same where a list is empty; steps the longest first.
Choices filled(Choices choices, const Scene& scene);

/// Whether a model is stepped by a scheme.
bool goes_with(const std::string& model, const std::string& scheme);

/// Change by change, model by model, mesh by mesh, scheme by scheme, the longest step first. Throws
/// InputError where what is varied is not a list, or is one of the other choices.
std::vector<Setting> settings_of(const Choices& choices);

/// The scheme by which a model is run with small steps. In full order generalised-alpha, but where
/// the scene gives numbers of another scheme, which stand in its way, that one.
std::string plain_scheme(const std::string& model, const StepScene& step);

}  // namespace railstep
