#pragma once
#include "online/contact/wheel.h"
#include "online/track/moving_load.h"
#include "online/track/residual.h"

namespace railstep {

/// Contacts and residual flexibility in a state, without quantities that its step held frozen. a is
/// the approach of wheels and rails by lines and bodies, G the residual flexibility between all
/// ports, and F their vertical forces (loads P, wheels -f). Then w = G F. On wheels with Hertz
/// contacts d = a + w and f = C d^1.5; on bilateral ones f is that of the state. Flanges have no
/// part in G.
struct StandingContacts {
  int loads, contacts;
  PlacedLoad load[kMaxLoads];
  WheelContact contact[kMaxWheels];
  double approach[kMaxWheels];   // a, m; negative is a gap
  double force[kMaxRailForces];  // F: of loads, then contacts, N
  double moved[kMaxRailForces];  // w, m
  double depth[kMaxWheels];      // d, m
  double hertz;                  // sum 2/5 C d^2.5, and k d^2 / 2 of linear contacts, J
  double residual;               // F' G F / 2, J
};

inline ContactIds contacts(const StandingContacts& c) { return {0, c.contacts}; }

StandingContacts standing_contacts(const Model& model, const State& state);

/// Energy that dampers of vehicles' contacts and of flanges dissipate in a step,
/// (fbar - k dbar) dd, J.
double contact_dissipation(const Model& model, const StandingContacts& before,
                           const StandingContacts& after, const double* mean_force);

/// Work of the loads on residual displacements, and of the carriers that move loads and wheels
/// along, J. The change of place alone changes the energy by F' dG F / 2 under loads, and by the
/// opposite amount at wheels with d = a + w:
///   sum over loads of Fbar dw - (F0' w1 - F1' w0) / 2,
/// where the second term is -F0' dG F1 / 2 by the symmetry of G. Without wheels it is the change of
/// the residual energy.
double residual_work(const StandingContacts& before, const StandingContacts& after);

}  // namespace railstep
