/* A vehicle that railstep knows nothing of, on a railstep track: a wheel under a sprung mass, with
 * a Hertz contact that is closed in the frame in which it acts.
 *
 * Usage: own_vehicle MODEL SECONDS HERTZ [explicit]
 *   MODEL  `railstep condense` of a scene with one [[external_wheel]], in full order
 *   HERTZ  of the contact's law HERTZ d^1.5, N/m^1.5; 9e10 of a wheel of .46 m on a new rail
 * Prints a line a frame: time, force on the wheel, rail and wheel displacement.
 *
 * Each frame: ask the track what it would do without the wheel's force and how it gives way
 * (railstep_response), solve vehicle and contact together, give the force (railstep_step). With
 * "explicit" the force is that of the frame before, as where two programs exchange once a frame and
 * neither tells how it gives way: stable only while the frame is short against the contact's own
 * period. */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "loaded_model.h"
#include "sprung_wheel.h"

static int fail(const char* what, const char* why) {
  fprintf(stderr, "error: %s: %s\n", what, why);
  return 2;
}

/* Inputs of a frame: place along and across, force on the rail. */
enum { kX, kY, kForceX, kForceY, kForceZ, kInputs };

static int ride(railstep_run* run, double frame_s, double seconds, double constant,
                int explicitly) {
  const Scheme scheme = scheme_of(frame_s);
  Vehicle vehicle;
  memset(&vehicle, 0, sizeof vehicle);
  double rail = 0.0;
  const long frames = lround(seconds / frame_s);
  printf("time_s,force_n,rail_m,wheel_m\n");
  for (long n = 1; n <= frames; ++n) {
    double in[kInputs] = {0}, motion[3], compliance[9];
    in[kX] = kStart + kSpeed * ((double)n * frame_s);
    railstep_response(run, in, motion, compliance);
    const double force =
        explicitly ? hertz(constant, rail - vehicle.u[kWheel])
                   : closed_contact(&scheme, &vehicle, constant, motion[2], compliance[8]);
    vehicle = moved(&scheme, &vehicle, force);
    in[kForceZ] = -force;
    railstep_step(run, in);
    rail = motion[2] - compliance[8] * force;
    printf("%.17g,%.17g,%.17g,%.17g\n", railstep_time_s(run), force, rail, vehicle.u[kWheel]);
    if (!(fabs(force) < 1e12)) return 1;
  }
  return 0;
}

int main(int argc, char** argv) {
  if (argc < 4) return fail("usage", "own_vehicle MODEL SECONDS HERTZ [explicit]");
  Loaded loaded;
  const char* why = load_model(argv[1], &loaded);
  if (!why && railstep_external_wheels(loaded.model) != 1) why = "has not one external wheel";
  const int code = why ? fail(argv[1], why)
                       : ride(loaded.run, railstep_frame_s(loaded.model), atof(argv[2]),
                              atof(argv[3]), argc > 4);
  free_model(&loaded);
  return code;
}
