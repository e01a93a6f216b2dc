#pragma once
#include <string>
#include <vector>

#include "online/patch/creep.h"

namespace railstep {

/// A creep law with FASTSIM's strips.
struct NamedLaw {
  std::string name;  // "she", "fastsim:10"
  CreepLaw law;
  int strips;
};

/// Reads "she", "linear", "polach", "fastsim" (10 strips) or "fastsim:N". Throws InputError.
NamedLaw creep_law_of(const std::string& text);

/// Normalised creepages of a patch, of which a law's force over its limit is asked for.
struct CreepRequest {
  double ratio = 1.;              // a/b
  double x = 0., e = 0., p = 0.;  // normalised creepages
  double poisson = .3;
};
CreepForce solve_creep(const CreepRequest& request, const NamedLaw& law);

/// Forces of all laws over one normalised creepage, from 0 to 4, the two others those of a request.
struct CreepCurves {
  char over;  // 'x', 'e' or 'p'
  std::vector<double> at;
  struct Curve {
    std::string name;
    std::vector<double> x, y;  // forces over the limit
  };
  std::vector<Curve> curves;
};
CreepCurves creep_curves(const CreepRequest& request, char over);

}  // namespace railstep
