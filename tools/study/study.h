#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "study/frame_cost.h"
#include "study/reference.h"
#include "study/study_row.h"

namespace railstep {

/// Runs a scene with settings, and tells each one's error and cost.
class Study {
 public:
  /// @param small_step  s, with which models are run to tell the step's error from the others
  Study(Studied studied, Reference reference, double small_step);

  /// With its failure where the setting makes no model, or its run is lost.
  SettingRow row_of(const Setting& setting);

  /// Errors of the reference, and of a model with small steps; kept once they are known.
  /// @returns the error against the reference of full order on a mesh by small steps
  double mesh_error(int elements_per_bay);
  /// @returns what changes of the scene make of a model, both by small steps
  double change_error(const Setting& setting);
  /// @returns the difference of a model by small steps from full order on its mesh, by small steps
  double condensation_error(const std::string& model, int elements_per_bay);

  const Reference& reference() const { return reference_; }
  const Studied& studied() const { return studied_; }

 private:
  const TraceTable& by_small_steps(const std::string& model, int elements_per_bay,
                                   const std::vector<std::string>& changes = {});

  Studied studied_;
  Reference reference_;
  double small_step_;
  StepScene step_;                           // of the scene
  std::map<std::string, TraceTable> small_;  // by words_of()
  std::unique_ptr<Timing> timing_;           // once something is timed
};

/// Where a setting's error begins to be told apart: ten times the reference's own.
inline double floor_of(const Reference& reference) { return 10. * reference.error; }

}  // namespace railstep
