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

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "railstep.h"

/* The vehicle: two masses over each other, m; up positive, 0 where the wheel touches a level rail
 * and the spring is slack. */
enum { kWheel, kBody, kMasses };
static const double kMass[kMasses] = {900.0, 5000.0};   /* kg */
static const double kStiffness = 1.0e6, kDamping = 2e4; /* N/m, N s/m */
static const double kGravity = 9.81;                    /* m/s2 */
static const double kStart = 0.3, kSpeed = 30.0;        /* m, m/s */
static const double kRhoInf = 0.6; /* of its generalised-alpha, as the track's */

/* Of its own time scheme (Chung and Hulbert 1993, with the true acceleration as Arnold and Bruls
 * 2007 have it). */
typedef struct {
  double dt, beta, gamma, alpha_m, alpha_f;
} Scheme;

typedef struct {
  double u[kMasses], v[kMasses]; /* m, m/s */
  double a[kMasses];             /* the scheme's acceleration */
  double g[kMasses];             /* the true one */
} Vehicle;

static Scheme scheme_of(double dt) {
  Scheme s;
  s.dt = dt;
  s.alpha_m = (2.0 * kRhoInf - 1.0) / (kRhoInf + 1.0);
  s.alpha_f = kRhoInf / (kRhoInf + 1.0);
  s.gamma = 0.5 + s.alpha_f - s.alpha_m;
  s.beta = 0.25 * (s.gamma + 0.5) * (s.gamma + 0.5);
  return s;
}

/* The vehicle at the frame's end under a force on the wheel. */
static Vehicle moved(const Scheme* s, const Vehicle* from, double force) {
  /* u1 = u_known + du g1, v1 = v_known + dv g1 */
  const double ratio = (1.0 - s->alpha_f) / (1.0 - s->alpha_m);
  const double du = s->dt * s->dt * s->beta * ratio, dv = s->dt * s->gamma * ratio;
  double a_known[kMasses], u[kMasses], v[kMasses];
  for (int i = 0; i < kMasses; ++i) {
    a_known[i] = (s->alpha_f * from->g[i] - s->alpha_m * from->a[i]) / (1.0 - s->alpha_m);
    u[i] = from->u[i] + s->dt * from->v[i] +
           s->dt * s->dt * ((0.5 - s->beta) * from->a[i] + s->beta * a_known[i]);
    v[i] = from->v[i] + s->dt * ((1.0 - s->gamma) * from->a[i] + s->gamma * a_known[i]);
  }
  /* m g1 + spring and damper = force - weight, two by two */
  const double c = kDamping * dv + kStiffness * du;
  const double pull = kStiffness * (u[kBody] - u[kWheel]) + kDamping * (v[kBody] - v[kWheel]);
  const double f0 = force + pull - kMass[kWheel] * kGravity, f1 = -pull - kMass[kBody] * kGravity;
  const double a = kMass[kWheel] + c, d = kMass[kBody] + c, det = a * d - c * c;
  Vehicle to;
  to.g[kWheel] = (d * f0 + c * f1) / det;
  to.g[kBody] = (a * f1 + c * f0) / det;
  for (int i = 0; i < kMasses; ++i) {
    to.a[i] = a_known[i] + ratio * to.g[i];
    to.u[i] = u[i] + du * to.g[i];
    to.v[i] = v[i] + dv * to.g[i];
  }
  return to;
}

static double hertz(double constant, double d) { return d > 0.0 ? constant * d * sqrt(d) : 0.0; }

/* The force that wheel and rail agree on: f = hertz(d_free - w f), which has one root. */
static double contact_force(double constant, double d_free, double w) {
  if (d_free <= 0.0) return 0.0;
  double d = d_free;
  for (int n = 0; n < 60; ++n) {
    const double miss = d + w * hertz(constant, d) - d_free;
    const double step = miss / (1.0 + 1.5 * w * constant * sqrt(d));
    d -= step;
    if (d <= 0.0) d = 0.5 * (d + step);
    if (fabs(step) <= 1e-16 * d_free) break;
  }
  return hertz(constant, d);
}

static void* whole_file(const char* name, size_t* bytes) {
  FILE* const file = fopen(name, "rb");
  if (!file) return NULL;
  fseek(file, 0, SEEK_END);
  const long size = ftell(file);
  fseek(file, 0, SEEK_SET);
  void* const block = size > 0 ? malloc((size_t)size) : NULL;
  *bytes = block ? fread(block, 1, (size_t)size, file) : 0;
  fclose(file);
  return block;
}

static int fail(const char* what, const char* why) {
  fprintf(stderr, "error: %s: %s\n", what, why);
  return 2;
}

/* What a frame is given: place along and across, force on the rail. */
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
    const Vehicle free_vehicle = moved(&scheme, &vehicle, 0.0);
    const Vehicle pushed = moved(&scheme, &vehicle, 1.0);
    const double give = pushed.u[kWheel] - free_vehicle.u[kWheel]; /* of the wheel, m/N */
    const double force = explicitly ? hertz(constant, rail - vehicle.u[kWheel])
                                    : contact_force(constant, motion[2] - free_vehicle.u[kWheel],
                                                    compliance[8] + give);
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
  size_t bytes = 0;
  void* const block = whole_file(argv[1], &bytes);
  if (!block) return fail(argv[1], "cannot be read");
  const railstep_model* model = NULL;
  void* const place = malloc(railstep_model_bytes());
  int32_t result = railstep_load(block, bytes, place, railstep_model_bytes(), &model);
  if (result != RAILSTEP_OK) return fail(argv[1], railstep_result_text(result));
  if (railstep_external_wheels(model) != 1) return fail(argv[1], "has not one external wheel");
  railstep_run* run = NULL;
  const size_t size = railstep_run_bytes(model);
  void* const memory = malloc(size);
  result = railstep_start(model, memory, size, &run);
  if (result != RAILSTEP_OK) return fail(argv[1], railstep_result_text(result));
  const int code = ride(run, railstep_frame_s(model), atof(argv[2]), atof(argv[3]), argc > 4);
  free(memory);
  free(place);
  free(block);
  return code;
}
