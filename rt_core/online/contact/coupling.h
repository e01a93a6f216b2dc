#pragma once
#include "online/contact/ports.h"
#include "online/contact/wheel.h"
#include "online/track/residual.h"

namespace railstep {

/// A wheelset's six coordinates in a step, before wheel forces and multipliers.
struct FreeWheelset {
  double compliance[6];  // m/N or rad/(N m)
  double free[6];
};

/// A step's coupled problem: positions of the track and of the bodies on it without contact, and
/// the responses of both to contact forces. Not zero-initialised; each entry is written before it
/// is read.
struct Coupling {
  int contacts, ports;  // ports: the contacts, then the fixed ones
  WheelContact contact[kMaxWheels];
  RailForce place[kMaxWheels];
  Panels panels[kMaxWheels][kMaxLines];  // of its response, in banded lines that it moves
  double by_loads[kMaxWheels];           // residual displacement by the loads, m
  double located[kMaxWheels];            // displacement of the lines when contacts were located, m
  FreeWheelset wheelset[kMaxWheelsets];
  double vehicle[kMaxVehicles][kMaxVehicleUnknowns];  // coordinates without wheel forces
  double W[kPorts * kPorts];                          // [ports][ports] m/N
  PortLaw law[kPorts];
  double track_free[kPorts];   // penetration from the track and the frozen geometry, m
  double force[kPorts];        // N
  double penetration[kPorts];  // m
};

}  // namespace railstep
