#pragma once
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <vector>

#include "support/exact_contact.h"

namespace railstep::exact {

// The Manchester passenger vehicle on rigid rails in a steady curve with nothing linearised but the
// law of creep: frames on the circle itself, finite rotations, wheels as in exact_contact.h.
// Written apart from rt_core, with its own data.

template <typename T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
constexpr int kBodies = 7;  // the car, two bogies, four wheelsets
constexpr int kSize = 6 * kBodies;
template <typename T>
using Motions = Eigen::Matrix<T, kSize, 1>;

template <typename T>
Matrix3<T> skew(const Vector3<T>& v) {
  Matrix3<T> m;
  m << T(0), -v[2], v[1], v[2], T(0), -v[0], -v[1], v[0], T(0);
  return m;
}
/// I + a [w] + b [w]^2 with the factors of the rotation and of its rate, by series.
template <typename T>
Matrix3<T> series(const Vector3<T>& w, bool rate) {
  const T s = dot(w, w);
  const T even = .5 * (1. - s / 12. * (1. - s / 30. * (1. - s / 56.)));
  const T odd = 1. - s / 6. * (1. - s / 20. * (1. - s / 42.));
  const T third = (1. - s / 20. * (1. - s / 42. * (1. - s / 72.))) / 6.;
  const Matrix3<T> S = skew(w), square = S * S;
  if (rate) return Matrix3<T>::Identity() + even * S + third * square;
  return Matrix3<T>::Identity() + odd * S + even * square;
}
template <typename T>
Matrix3<T> rotation(const Vector3<T>& w) {
  return series(w, false);
}
template <typename T>
Matrix3<T> rate_matrix(const Vector3<T>& w) {
  return series(w, true);
}

struct Curve {
  double slope, speed, curvature, cant;  // of the treads; m/s; 1/m; m, outer rail raised
};
struct Wheel {
  double q, y, t_x;  // N; y on the rail, outwards
};

class Vehicle {
 public:
  explicit Vehicle(const Curve& curve, const Flange& flange = {}) : c_(curve), flange_(flange) {
    surfaces_.push_back(tread_surface(curve.slope));
    if (flange.friction > 0.) surfaces_.push_back(flange_surface(flange));
    beta_ = -(curve.curvature < 0. ? -1. : 1.) * std::asin(curve.cant / (2. * kHalfDistance));
    const double bogie_load = (32000. + 2. * 2615.) / 8. * kGravity, car_load = 8000. * kGravity;
    for (int i = 0; i < 4; ++i)
      for (const double side : {1., -1.})
        elements_.push_back({1 + i / 2,
                             3 + i,
                             kPlace[3 + i],
                             side,
                             .46,
                             {31.391e6, 3.884e6, 1.22e6},
                             {15e3, 2e3, 4e3},
                             bogie_load,
                             0.});
    for (const int bogie : {1, 2}) {
      for (const double side : {1., -1.})
        elements_.push_back({0,
                             bogie,
                             kPlace[bogie],
                             side,
                             .8275,
                             {160e3, 160e3, 430e3},
                             {0., 32e3, 20e3},
                             car_load,
                             10.5e3});
      elements_.push_back({0, bogie, kPlace[bogie], 0., .8275, {}, {}, 0., 940e3});
    }
  }

  /// The steady state: displacements, and of wheelsets the rate of the spin beyond speed / radius
  /// in the place of its angle. @param from  where Newton's method begins
  Motions<double> steady(Motions<double> x) const {
    for (int i = 0; i < 60; ++i) {
      const Motions<double> left = residual<double>(x);
      const Eigen::MatrixXd J = slopes(x);
      const Eigen::VectorXd step =
          J.bottomRightCorner(kSize - 1, kSize - 1).partialPivLu().solve(-left.tail(kSize - 1));
      const double most = step.cwiseAbs().maxCoeff();
      x.tail(kSize - 1) += std::min(1., 2e-2 / most) * step;
      if (most < 1e-11) break;
    }
    return x;
  }
  /// Derivatives of the forces that are left, over the motions at the same places as in steady().
  Eigen::MatrixXd slopes(const Motions<double>& x) const {
    constexpr double kStep = 1e-30;
    Eigen::MatrixXd J(kSize, kSize);
    for (int n = 0; n < kSize; ++n) {
      Motions<Complex> y = x.cast<Complex>();
      y[n] += Complex(0., kStep);
      J.col(n) = residual<Complex>(y).imag() / kStep;
    }
    return J;
  }
  static Motions<double> at_rest() {
    Motions<double> x = Motions<double>::Zero();
    const double load = (32000. + 2. * 2615. + 4. * 1813.) * kGravity / 8.;
    for (int i = 0; i < kBodies; ++i) x[6 * i + 2] = -std::pow(load / kTreadHertz, 2. / 3.);
    return x;
  }
  /// Left and right wheel of each wheelset.
  std::vector<Wheel> wheels(const Motions<double>& x) const {
    std::vector<Wheel> all;
    Motions<double> u, v;
    unpack(x, u, v);
    for (int i = 3; i < kBodies; ++i)
      for (const double side : {1., -1.}) {
        const Eigen::Matrix<double, 6, 1> own_u = u.segment<6>(6 * i), own_v = v.segment<6>(6 * i);
        const Eigen::Matrix<double, 6, 1> f = contact<double>(side, own_u, own_v);
        all.push_back({f[2], -side * f[1], f[0]});
      }
    return all;
  }
  double drag(const Motions<double>& x) const { return -residual<double>(x)[0]; }

 private:
  static constexpr double kGravity = 9.81;
  static constexpr double kPlace[kBodies] = {0., 9.5, -9.5, 10.78, 8.22, -8.22, -10.78};
  static constexpr std::array<double, kBodies> kHeight = {1.8, .6, .6, .46, .46, .46, .46};
  static constexpr std::array<double, kBodies> kMass = {32000., 2615., 2615., 1813.,
                                                        1813.,  1813., 1813.};
  static double inertia(int body, int axis) {
    constexpr double kOf[3][3] = {
        {56800., 1.97e6, 1.97e6}, {1722., 1476., 3067.}, {1120., 112., 1120.}};
    return kOf[body == 0 ? 0 : body < 3 ? 1 : 2][axis];
  }
  struct Element {
    int a, b;
    double place, y, height;
    std::array<double, 3> k, c;
    double preload, roll;  // N upwards on `a`; N m/rad
  };
  template <typename T>
  struct Pose {
    Vector3<T> centre, rate, turning;
    Matrix3<T> turned;
  };

  template <typename T>
  Vector3<T> up() const {
    return {T(0), T(std::sin(beta_)), T(std::cos(beta_))};
  }
  template <typename T>
  Vector3<T> inwards() const {
    return {T(0), T(std::cos(beta_)), T(-std::sin(beta_))};
  }
  /// Place and rotation of the track's frame at one place in the one at another.
  void between(double from, double to, Eigen::Vector3d& origin, Eigen::Matrix3d& turned) const {
    const double way = to - from, angle = c_.curvature * way;
    Eigen::Matrix3d X, Z;
    X << 1., 0., 0., 0., std::cos(beta_), -std::sin(beta_), 0., std::sin(beta_), std::cos(beta_);
    Z << std::cos(angle), -std::sin(angle), 0., std::sin(angle), std::cos(angle), 0., 0., 0., 1.;
    const Eigen::Vector3d level(std::sin(angle) / c_.curvature,
                                (1. - std::cos(angle)) / c_.curvature, 0.);
    origin = X.transpose() * level;
    turned = X.transpose() * Z * X;
  }

  template <typename T>
  Pose<T> pose(int i, const Motions<T>& u, const Motions<T>& v) const {
    Pose<T> p;
    p.centre = u.template segment<3>(6 * i);
    p.centre[2] += kHeight[static_cast<std::size_t>(i)];
    p.rate = v.template segment<3>(6 * i);
    const Vector3<T> angle = u.template segment<3>(6 * i + 3),
                     turning = v.template segment<3>(6 * i + 3);
    if (i < 3) {
      p.turned = rotation<T>(angle);
      p.turning = rate_matrix<T>(angle) * turning;
      return p;
    }
    const Vector3<T> x = ahead<T>(angle[2]), e = axle<T>(angle[0], angle[2]);
    p.turned.col(0) = x;
    p.turned.col(1) = e;
    p.turned.col(2) = cross<T>(x, e);
    p.turning = turning[0] * x;
    p.turning[2] += turning[2];
    return p;
  }

  /// Force of the rail over the motions of a wheelset.
  template <typename T>
  Eigen::Matrix<T, 6, 1> contact(double side, const Eigen::Matrix<T, 6, 1>& u,
                                 const Eigen::Matrix<T, 6, 1>& v) const {
    const Vector3<T> c{u[0], u[1], kRadius + u[2]}, x = ahead<T>(u[5]), e = axle<T>(u[3], u[5]);
    const double V = c_.speed;
    Vector3<T> turning = V * c_.curvature * up<T>() + v[3] * x + (V / kRadius + v[4]) * e;
    turning[2] += v[5];
    Vector3<T> speed = V * c_.curvature * u[0] * inwards<T>();
    speed[0] += V * (1. - c_.curvature * dot<T>(c, inwards<T>()));
    for (int d = 0; d < 3; ++d) speed[d] += v[d];
    std::vector<Touch<T>> touches;
    T all(0);
    for (const Surface& s : surfaces_) {
      touches.push_back(touch<T>(s, side, c, e));
      all += touches.back().force;
    }
    Vector3<T> force = Vector3<T>::Zero(), moment = Vector3<T>::Zero();
    for (const Touch<T>& at : touches) {
      if (flange_.friction > 0. && !(std::real(at.force) > 0.)) continue;
      const Vector3<T> slip = speed + cross<T>(turning, at.arm),
                       lateral{T(0), at.normal[2], -at.normal[1]};
      const Creep<T> creep =
          creep_force<T>(flange_, at.force, at.force / all, slip[0] / V, dot<T>(slip, lateral) / V,
                         dot<T>(turning, at.normal) / V);
      Vector3<T> own = at.force * at.normal + creep.y * lateral;
      own[0] += creep.x;
      force += own;
      moment += cross<T>(at.arm, own) + creep.moment * at.normal;
    }
    Eigen::Matrix<T, 6, 1> sum;
    sum << force, dot<T>(moment, x), dot<T>(moment, e), moment[2];
    return sum;
  }

  template <typename T>
  void unpack(const Motions<T>& x, Motions<T>& u, Motions<T>& v) const {
    u = x;
    v.setZero();
    for (int i = 3; i < kBodies; ++i) {
      v[6 * i + 4] = x[6 * i + 4];
      u[6 * i + 4] = T(0);
    }
  }

  /// Forces less inertia of a steady state over all motions.
  template <typename T>
  Motions<T> residual(const Motions<T>& x) const {
    Motions<T> u, v, sum;
    unpack(x, u, v);
    std::array<Vector3<T>, kBodies> F, M;
    std::array<Pose<T>, kBodies> poses;
    for (int i = 0; i < kBodies; ++i) {
      const auto b = static_cast<std::size_t>(i);
      poses[b] = pose<T>(i, u, v);
      F[b] = -kMass[b] * kGravity * up<T>();
      M[b].setZero();
    }
    for (const Element& own : elements_) add_element(own, poses, F, M);
    for (int i = 0; i < kBodies; ++i) {
      const auto b = static_cast<std::size_t>(i);
      subtract_inertia(i, poses[b], v, F[b], M[b]);
      const Vector3<T> angle = u.template segment<3>(6 * i + 3);
      sum.template segment<3>(6 * i) = F[b];
      if (i < 3) {
        sum.template segment<3>(6 * i + 3) = rate_matrix<T>(angle).transpose() * M[b];
        continue;
      }
      const Vector3<T> e = axle<T>(angle[0], angle[2]);
      sum[6 * i + 3] = dot<T>(M[b], ahead<T>(angle[2]));
      sum[6 * i + 4] = spin_inertia_moment(i, v, e);
      sum[6 * i + 5] = M[b][2];
      const Eigen::Matrix<T, 6, 1> own_u = u.template segment<6>(6 * i),
                                   own_v = v.template segment<6>(6 * i);
      for (const double side : {1., -1.})
        sum.template segment<6>(6 * i) += contact<T>(side, own_u, own_v);
    }
    return sum;
  }

  template <typename T>
  void add_element(const Element& own, const std::array<Pose<T>, kBodies>& poses,
                   std::array<Vector3<T>, kBodies>& F, std::array<Vector3<T>, kBodies>& M) const {
    const auto a = static_cast<std::size_t>(own.a), b = static_cast<std::size_t>(own.b);
    Eigen::Vector3d level;
    Eigen::Matrix3d frame;
    between(kPlace[b], kPlace[a], level, frame);
    const Vector3<T> origin = level.cast<T>();
    const Matrix3<T> R = frame.cast<T>();
    const Vector3<T> at_a{T(own.place - kPlace[a]), T(own.y), T(own.height - kHeight[a])},
        at_b{T(own.place - kPlace[b]), T(own.y), T(own.height - kHeight[b])};
    const Matrix3<T> turned_a = R * poses[a].turned, &turned_b = poses[b].turned;
    const Vector3<T> arm_a = turned_a * at_a, arm_b = turned_b * at_b,
                     turning_a = R * poses[a].turning, &turning_b = poses[b].turning;
    const Vector3<T> d = origin + R * poses[a].centre + arm_a - poses[b].centre - arm_b;
    const Vector3<T> rate =
        R * poses[a].rate + cross<T>(turning_a, arm_a) - poses[b].rate - cross<T>(turning_b, arm_b);
    const Matrix3<T> between_both = turned_b.transpose() * turned_a;
    const Vector3<T> w = .5 * Vector3<T>{between_both(2, 1) - between_both(1, 2),
                                         between_both(0, 2) - between_both(2, 0),
                                         between_both(1, 0) - between_both(0, 1)};
    const Matrix3<T> middle = turned_b * rotation<T>(.5 * w);
    const Vector3<T> turning = .5 * (turning_a + turning_b);
    const Vector3<T> inside = middle.transpose() * d,
                     rate_inside = middle.transpose() * (rate - cross<T>(turning, d));
    Vector3<T> f;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      f[row] = -(own.k[k] * inside[row] + own.c[k] * rate_inside[row]);
    }
    f[2] += own.preload;
    f = middle * f;
    const Vector3<T> t = middle * Vector3<T>{-own.roll * w[0], T(0), T(0)};
    const Vector3<T> on_b = -f;
    F[b] += on_b;
    M[b] += cross<T>(arm_b + .5 * d, on_b) - t;
    F[a] += R.transpose() * f;
    M[a] += R.transpose() * (cross<T>(arm_a - .5 * d, f) + t);
  }

  template <typename T>
  void subtract_inertia(int i, const Pose<T>& p, const Motions<T>& v, Vector3<T>& F,
                        Vector3<T>& M) const {
    const double V = c_.speed, K = c_.curvature;
    const Vector3<T> k = up<T>(), turning = V * K * k;
    F -= kMass[static_cast<std::size_t>(i)] * V * V *
         (K * inwards<T>() - K * K * (p.centre - dot<T>(k, p.centre) * k));
    Vector3<T> momentum;
    if (i < 3) {
      Vector3<T> inside = p.turned.transpose() * turning;
      for (int d = 0; d < 3; ++d) inside[d] *= inertia(i, d);
      momentum = p.turned * inside;
    } else {
      momentum = spinning(i, v, Vector3<T>(p.turned.col(1)));
    }
    M -= cross<T>(turning, momentum);
  }
  template <typename T>
  Vector3<T> spinning(int i, const Motions<T>& v, const Vector3<T>& e) const {
    const Vector3<T> turning = c_.speed * c_.curvature * up<T>();
    const T along = dot<T>(turning, e), spin = c_.speed / kRadius + v[6 * i + 4];
    return inertia(i, 0) * (turning - along * e) + (inertia(i, 1) * (along + spin)) * e;
  }
  template <typename T>
  T spin_inertia_moment(int i, const Motions<T>& v, const Vector3<T>& e) const {
    const Vector3<T> turning = c_.speed * c_.curvature * up<T>();
    return -dot<T>(cross<T>(turning, spinning(i, v, e)), e);
  }

  Curve c_;
  Flange flange_;
  double beta_;
  std::vector<Surface> surfaces_;
  std::vector<Element> elements_;
};

struct Steady {
  std::vector<Wheel> wheels;   // left and right of each wheelset
  std::vector<double> y, yaw;  // m and rad, of the wheelsets
  double drag;                 // N
  Eigen::MatrixXd slopes;      // [kSize][kSize] as of Vehicle
};

/// The steady state by continuation in the curvature.
inline Steady steady_state(Curve curve, const Flange& flange = {}) {
  const Curve full = curve;
  Motions<double> x = Vehicle::at_rest();
  const std::vector<double> linear = {.05, .2, .5, 1.},
                            limited = {.02, .1, .2, .3, .4, .5, .6, .7, .8, .9, 1.};
  for (const double part : flange.friction > 0. ? limited : linear) {
    curve.curvature = part * full.curvature;
    curve.cant = part * full.cant;
    x = Vehicle(curve, flange).steady(x);
  }
  const Vehicle vehicle(curve, flange);
  Steady found{vehicle.wheels(x), {}, {}, vehicle.drag(x), vehicle.slopes(x)};
  for (int i = 3; i < kBodies; ++i) {
    found.y.push_back(x[6 * i + 1]);
    found.yaw.push_back(x[6 * i + 5]);
  }
  return found;
}

}  // namespace railstep::exact
