// Comparison of constraint methods, as CSV on stdout for docs/joints.md.
// Usage: joints_table ways|penalty|baumgarte|tangent|tolerance
// rigid|flexible|four_bar|four_bar_doubled
#include <cstdio>
#include <stdexcept>

#include "joints_scenes.h"

namespace railstep {
namespace {

constexpr double kSteps[] = {4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4, 1e-4};  // s
constexpr int kCaps[] = {1, 2, 3, 20};

struct NamedScheme {
  const char* name;
  double rho;  // of generalised-alpha; below 0: backward Euler; above 1: energy-momentum
};
constexpr NamedScheme kSchemes[] = {{"euler", -1.},
                                    {"generalised_alpha_0.6", .6},
                                    {"generalised_alpha_0.9", .9},
                                    {"generalised_alpha_1", 1.},
                                    {"energy_momentum", 2.}};

struct Way {
  const char* name;
  ConstraintMethod constraint_method;
  double alpha_dt = 0.;  // Baumgarte's alpha = beta times the step; 0: the default
  double alpha = 0.;     // the same in 1/s, if it does not depend on the step
};
constexpr Way kWays[] = {{"augmented_lagrangian", ConstraintMethod::augmented_lagrangian},
                         {"baumgarte", ConstraintMethod::baumgarte},
                         {"baumgarte_20_per_s", ConstraintMethod::baumgarte, 0., 20.},
                         {"baumgarte_1_per_dt", ConstraintMethod::baumgarte, 1.},
                         {"index_1", ConstraintMethod::baumgarte, 0., 1e-9},
                         {"gear_gupta_leimkuhler", ConstraintMethod::gear_gupta_leimkuhler},
                         {"direct", ConstraintMethod::direct}};

bool allowed(ConstraintMethod hold, const NamedScheme& scheme) {
  if (hold == ConstraintMethod::direct && scheme.rho == 1.)
    return false;  // refused: it is not stable
  return scheme.rho <= 1. || hold == ConstraintMethod::augmented_lagrangian ||
         hold == ConstraintMethod::direct;
}

SystemOptions options_of(const Way& way, const NamedScheme& scheme, double dt, int cap) {
  SystemOptions o;
  o.scheme = scheme.rho < 0.   ? backward_euler(dt)
             : scheme.rho > 1. ? energy_momentum(dt)
                               : generalised_alpha(dt, scheme.rho);
  o.energy_momentum = scheme.rho > 1.;
  o.constraint_method = way.constraint_method;
  o.alpha = o.beta = way.alpha > 0. ? way.alpha : way.alpha_dt / dt;
  o.cap = cap;
  o.penalty = 1e9;  // the default, set so that the table shows it
  return o;
}

class Table {
 public:
  explicit Table(JointScene scene) : scene_(std::move(scene)) {
    std::printf(
        "scene,way,scheme,dt_s,cap,penalty,alpha_per_s,beta_per_s,tangent,tolerance,violation_m,"
        "drift_m_per_s,violation_velocity_m_per_s,energy_error_j,energy_end_j,error_1s_m,"
        "reference_error_m,mean_iterations,max_iterations,capped,redundant,step_us,end_s,joint_"
        "tolerance\n");
  }

  void row(const Way& way, const NamedScheme& scheme, const SystemOptions& o) const {
    const RunResult r = measure(scene_.system, o, scene_.until, scene_.reference);
    const bool own = o.alpha > 0. || o.beta > 0.;
    const double alpha = own ? o.alpha : .2 / o.scheme.dt, beta = own ? o.beta : .2 / o.scheme.dt;
    const char* tangent = o.renew == Renew::every_iteration ? "every_iteration"
                          : o.renew == Renew::every_step    ? "every_step"
                                                            : "kept";
    const bool damped = way.constraint_method == ConstraintMethod::baumgarte;
    std::printf("%s,%s,%s,%g,%d,%g,%g,%g,%s,%.2e,", scene_.name.c_str(), way.name, scheme.name,
                o.scheme.dt, o.cap, o.penalty, damped ? alpha : 0., damped ? beta : 0., tangent,
                o.tolerance);
    std::printf("%.3e,%.2e,%.3e,%.3e,%.3e,%.3e,%.0e,", r.position, r.drift, r.velocity, r.energy,
                r.energy_end, r.error, scene_.reference_error);
    std::printf("%.3f,%d,%.4f,%.4f,%.2f,%g,%g\n", r.mean_iterations, r.most_iterations, r.capped,
                r.redundant, r.step_us, r.end, o.joint_tolerance);
    std::fflush(stdout);
  }

 private:
  JointScene scene_;
};

void ways(const Table& table) {
  for (const Way& way : kWays)
    for (const NamedScheme& scheme : kSchemes)
      for (const double dt : kSteps)
        for (const int cap : kCaps)
          if (allowed(way.constraint_method, scheme))
            table.row(way, scheme, options_of(way, scheme, dt, cap));
}

void penalties(const Table& table) {
  for (const NamedScheme& scheme : {kSchemes[2], kSchemes[4]})
    for (const double dt : {4e-3, 1e-3, 2.5e-4})
      for (const int cap : {2, 20})
        for (double penalty = 1e3; penalty < 2e13; penalty *= 10.) {
          SystemOptions o = options_of(kWays[0], scheme, dt, cap);
          o.penalty = penalty;
          table.row(kWays[0], scheme, o);
        }
}

/// beta = ratio alpha: aperiodic below 1, critical at 1, oscillating above.
void dampings(const Table& table) {
  for (const double dt : {4e-3, 1e-3, 2.5e-4})
    for (const double alpha_dt : {.002, .01, .02, .05, .1, .2, .3, .5, 1., 2., 5.})
      for (const double ratio : {.5, 1., 1.4142135623730951, 2.}) {
        SystemOptions o = options_of(kWays[1], kSchemes[2], dt, 20);
        o.alpha = alpha_dt / dt;
        o.beta = ratio * o.alpha;
        table.row(kWays[1], kSchemes[2], o);
      }
}

void tangents(const Table& table) {
  for (const Way& way : kWays)
    for (const double dt : {4e-3, 1e-3, 2.5e-4})
      for (const Renew renew : {Renew::every_iteration, Renew::every_step, Renew::kept})
        for (const NamedScheme& scheme : {kSchemes[2], kSchemes[4]}) {
          if (!allowed(way.constraint_method, scheme)) continue;
          SystemOptions o = options_of(way, scheme, dt, 20);
          o.renew = renew;
          table.row(way, scheme, o);
        }
}

/// Varies the two tolerances of Newton's iterations.
void tolerances(const Table& table) {
  for (const NamedScheme& scheme : {kSchemes[2], kSchemes[4]})
    for (const double dt : {4e-3, 1e-3, 2.5e-4})
      for (const double forces : {1e-4, 1e-6, 1e-8, 1e-10})
        for (const double joints : {1e-6, 1e-8, 1e-10, 1e-12}) {
          SystemOptions o = options_of(kWays[0], scheme, dt, 20);
          o.tolerance = forces;
          o.joint_tolerance = joints;
          table.row(kWays[0], scheme, o);
        }
}

JointScene scene_of(const std::string& name) {
  if (name == "rigid") return rigid_pendulum();
  if (name == "flexible") return flexible_pendulum();
  if (name == "four_bar" || name == "four_bar_doubled") return four_bar(name != "four_bar");
  throw std::invalid_argument("unknown scene " + name);
}

void print_table(const std::string& name, const Table& table) {
  if (name == "ways") return ways(table);
  if (name == "penalty") return penalties(table);
  if (name == "baumgarte") return dampings(table);
  if (name == "tangent") return tangents(table);
  if (name == "tolerance") return tolerances(table);
  throw std::invalid_argument("unknown table " + name);
}

}  // namespace
}  // namespace railstep

int main(int count, char** words) {
  if (count != 3) {
    std::fprintf(stderr,
                 "usage: joints_table ways|penalty|baumgarte|tangent|tolerance "
                 "rigid|flexible|four_bar|four_bar_doubled\n");
    return 2;
  }
  try {
    railstep::print_table(words[1], railstep::Table(railstep::scene_of(words[2])));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
  return 0;
}
