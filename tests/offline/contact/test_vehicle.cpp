#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "offline/vehicle/vehicle.h"

using namespace railstep;

namespace {

/// A car body on two frames and four wheels: ten coordinates.
Vehicle car() {
  Vehicle v;
  v.bodies = {{16000., 9.85e5, 0.}, {1307.5, 738., 9.5}, {1307.5, 738., -9.5}, {906.5, 0., 10.78},
              {906.5, 0., 8.22},    {906.5, 0., -8.22},  {906.5, 0., -10.78}};
  v.suspensions = {{0, 1, 9.5, 4.3e5, 2e4},    {0, 2, -9.5, 4.3e5, 2e4},
                   {1, 3, 10.78, 1.22e6, 4e3}, {1, 4, 8.22, 1.22e6, 4e3},
                   {2, 5, -8.22, 1.22e6, 4e3}, {2, 6, -10.78, 1.22e6, 4e3}};
  v.wheels = {{3, 10.78, .46}, {4, 8.22, .46}, {5, -8.22, .46}, {6, -10.78, .46}};
  return v;
}

}  // namespace

TEST_CASE("a car of ten coordinates stands with a quarter of its weight on each wheel") {
  const VehicleMatrices m = vehicle_matrices(car());
  REQUIRE(m.mass.rows() == 10);
  CHECK((m.stiffness - m.stiffness.transpose()).norm() == 0.);
  const VehicleRest rest = vehicle_at_rest(m);
  const double weight = (16000. + 2. * 1307.5 + 4. * 906.5) * kGravity;
  for (int w = 0; w < 4; ++w) CHECK(rest.force[w] == Approx(weight / 4.).epsilon(1e-12));
  // The springs are in series, each under the weight above it.
  const double secondary = 8000. * kGravity / 4.3e5;
  const double primary = (8000. + 1307.5) * kGravity / 2. / 1.22e6;
  CHECK(rest.displacement[0] == Approx(-secondary - primary).epsilon(1e-12));
  CHECK(rest.displacement[2] == Approx(-primary).epsilon(1e-12));
  CHECK(rest.displacement[1] == Approx(0.).margin(1e-15));
  CHECK((m.stiffness * rest.displacement - m.wheels.transpose() * rest.force + m.weight).norm() <
        1e-9 * weight);
}

TEST_CASE("a load ahead of the middle loads the wheels ahead by its lever") {
  // A beam on two wheels 2.5 m apart has its centre 0.5 m ahead of their middle.
  Vehicle v;
  v.bodies = {{1000., 300., .5}};
  v.wheels = {{0, 1.25, .46}, {0, -1.25, .46}};
  const VehicleRest rest = vehicle_at_rest(vehicle_matrices(v));
  CHECK(rest.force[0] == Approx(1000. * kGravity * 1.75 / 2.5));
  CHECK(rest.force[1] == Approx(1000. * kGravity * .75 / 2.5));
}

TEST_CASE("positive pitch lowers the front") {
  const VehicleMatrices m = vehicle_matrices(car());
  Eigen::VectorXd q = Eigen::VectorXd::Zero(10);
  q[3] = 1e-3;  // leading frame, whose springs are 1.28 m ahead and behind
  const Eigen::VectorXd force = -m.stiffness * q;
  CHECK(force[6] == Approx(-1.28e-3 * 1.22e6));  // its leading wheel is pressed down
  CHECK(force[7] == Approx(1.28e-3 * 1.22e6));
  CHECK(force[3] == Approx(-2. * 1.28 * 1.28 * 1.22e6 * 1e-3));
}

TEST_CASE("bounce and pitch of a car on held wheels have the frequencies of the closed forms") {
  // By symmetry, bounce and pitch of body and frames are two masses on two springs.
  const VehicleMatrices m = vehicle_matrices(car());
  Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> modes(m.stiffness.topLeftCorner(6, 6),
                                                                  m.mass.topLeftCorner(6, 6));
  const auto two_masses = [](double upper, double lower, double k, double under) {
    // lambda2 - (k/u + (k + under)/l) lambda + k under / (u l) = 0
    const double b = k / upper + (k + under) / lower, c = k * under / (upper * lower);
    return std::pair{.5 * b - std::sqrt(.25 * b * b - c), .5 * b + std::sqrt(.25 * b * b - c)};
  };
  const auto bounce = two_masses(8000., 1307.5, 4.3e5, 2.44e6);
  const auto pitch = two_masses(9.85e5 / (2. * 9.5 * 9.5), 1307.5, 4.3e5, 2.44e6);
  const double frame = 2. * 1.28 * 1.28 * 1.22e6 / 738.;
  std::vector<double> wanted = {bounce.first, bounce.second, pitch.first,
                                pitch.second, frame,         frame};
  std::sort(wanted.begin(), wanted.end());
  for (int i = 0; i < 6; ++i)
    CHECK(modes.eigenvalues()[i] == Approx(wanted[static_cast<std::size_t>(i)]).epsilon(1e-9));
}

TEST_CASE("invalid vehicles are refused") {
  Vehicle v = car();
  v.suspensions[0].lower = 7;
  CHECK_THROWS_WITH(vehicle_matrices(v), Catch::Contains("E-VEHICLE-43"));
  v = car();
  v.bodies[2].mass = 0.;
  CHECK_THROWS_WITH(vehicle_matrices(v), Catch::Contains("E-VEHICLE-40"));
  v = car();
  v.wheels[1].body = -1;
  CHECK_THROWS_WITH(vehicle_matrices(v), Catch::Contains("E-VEHICLE-45"));
  v = car();
  v.suspensions.erase(v.suspensions.begin());  // the car body would fall
  v.suspensions.erase(v.suspensions.begin());
  CHECK_THROWS_WITH(vehicle_at_rest(vehicle_matrices(v)), Catch::Contains("E-VEHICLE-02"));
}
