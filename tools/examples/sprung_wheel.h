/* The vehicle of the examples: a wheel under a sprung mass, with a Hertz contact. Plain C99 that
 * knows nothing of railstep, as a vehicle model of your own would. */
#ifndef SPRUNG_WHEEL_H
#define SPRUNG_WHEEL_H

#include <math.h>

/* The vehicle: two masses over each other, m; up positive, 0 where the wheel touches a level rail
 * and the spring is slack. */
enum { kWheel, kBody, kMasses };
static const double kMass[kMasses] = {900.0, 5000.0};   /* kg */
static const double kStiffness = 1.0e6, kDamping = 2e4; /* N/m, N s/m */
static const double kGravity = 9.81;                    /* m/s2 */
static const double kStart = 0.3, kSpeed = 30.0;        /* m, m/s */
static const double kRhoInf = 0.6; /* of its generalised-alpha, as the track's */

/* Constants of its own time scheme (Chung and Hulbert 1993, with the true acceleration as Arnold
 * and Bruls 2007 have it). */
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

/* The contact closed in the frame: the rail is displaced by rail_free - rail_compliance f under a
 * force f on the wheel, and the wheel moves by what the vehicle's own step makes of f. */
static double closed_contact(const Scheme* s, const Vehicle* from, double constant,
                             double rail_free, double rail_compliance) {
  const double wheel_free = moved(s, from, 0.0).u[kWheel];
  const double give = moved(s, from, 1.0).u[kWheel] - wheel_free; /* of the wheel, m/N */
  return contact_force(constant, rail_free - wheel_free, rail_compliance + give);
}

#endif
