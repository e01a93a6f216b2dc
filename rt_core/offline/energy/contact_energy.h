#pragma once
#include "online/contact/wheel.h"
#include "online/track/moving_load.h"
#include "online/track/residual.h"

namespace railstep {

/// Contacts and residual flexibility in a state as it stands, whatever its step held frozen. With a
/// the approach of wheels and rails by lines and bodies, G the residual flexibility between all
/// ports and F their vertical forces (loads P, wheels -f): w = G F, and d = a + w, f = C d^1.5 on
/// wheels of Hertz contacts; f of the state on bilateral ones. Flanges have no part in G.
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

StandingContacts standing_contacts(const Model& model, const State& state);

/// What the dampers of vehicles' contacts and of flanges take of a step, (fbar - k dbar) dd, J.
double contact_dissipation(const Model& model, const StandingContacts& before,
                           const StandingContacts& after, const double* mean_force);

/// Work of the loads on what they move by G, and of whatever carries loads and wheels along, J. The
/// change of place alone changes the energy by F' dG F / 2 under loads, and takes as much from
/// where d = a + w under wheels:
///   sum over loads of Fbar dw - (F0' w1 - F1' w0) / 2,
/// where the second term is -F0' dG F1 / 2 by the symmetry of G. Without wheels it is the change of
/// the residual energy.
double residual_work(const StandingContacts& before, const StandingContacts& after);

}  // namespace railstep
