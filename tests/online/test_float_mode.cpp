#include <fenv.h>  // feenableexcept, an extension of glibc

#include <catch2/catch.hpp>
#include <limits>

#include "online/math/float_mode.h"

using namespace railstep;

namespace {

// volatile: the sums must be made at run time, in the mode of that moment.
double multiply(double x, double y) {
  volatile double a = x, b = y;
  volatile double c = a * b;
  return c;
}

double add(double x, double y) {
  volatile double a = x, b = y;
  volatile double c = a + b;
  return c;
}

constexpr double kSmallest = std::numeric_limits<double>::min();

}  // namespace

TEST_CASE("inside the guard subnormal results and operands are zero, outside they are not",
          "[float]") {
  const double subnormal = kSmallest / 4.0;
  CHECK(multiply(kSmallest, 0.5) > 0.0);
  double result = 1.0, operand = 1.0;
  {
    const FloatMode guard;
    result = multiply(kSmallest, 0.5);
    operand = multiply(subnormal, 0x1p60);
  }
  CHECK(result == 0.0);
  CHECK(operand == 0.0);
  CHECK(multiply(kSmallest, 0.5) > 0.0);
  CHECK(multiply(subnormal, 0x1p60) > 0.0);
}

TEST_CASE("inside the guard sums round to nearest, after it as the caller chose", "[float]") {
  REQUIRE(fesetround(FE_UPWARD) == 0);
  const auto word = FloatMode::read();
  const double before = add(1.0, 0x1p-60);
  double inside = 0.0;
  {
    const FloatMode guard;
    inside = add(1.0, 0x1p-60);
  }
  const double after = add(1.0, 0x1p-60);
  const auto restored = FloatMode::read();
  fesetround(FE_TONEAREST);
  CHECK(before > 1.0);
  CHECK(inside == 1.0);
  CHECK(after == before);
  // The caller's own word, except for sticky flags that its own sum raised before it was read.
  CHECK((restored | 0x3fu) == (word | 0x3fu));
}

TEST_CASE(
    "inside the guard nothing traps even if the caller traps, and the caller's flags stay as they "
    "were",
    "[float]") {
  feclearexcept(FE_ALL_EXCEPT);
  if (feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW) == -1) return;  // no traps here
  const auto word = FloatMode::read();
  double inside = 0.0;
  {
    const FloatMode guard;
    inside = add(multiply(1e300, 1e300), -multiply(1e300, 1e300));
  }
  const auto restored = FloatMode::read();
  fedisableexcept(FE_ALL_EXCEPT);
  CHECK_FALSE(inside == inside);
  CHECK(restored == word);
}

TEST_CASE("inside the guard the control word is the same, whatever the caller's is", "[float]") {
  FloatMode::Word usual;
  {
    const FloatMode guard;
    usual = FloatMode::read();
  }
  for (const int rounding : {FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO, FE_TONEAREST}) {
    fesetround(rounding);
    feenableexcept(FE_ALL_EXCEPT);
    FloatMode::Word inside;
    {
      const FloatMode guard;
      inside = FloatMode::read();
    }
    fedisableexcept(FE_ALL_EXCEPT);
    fesetround(FE_TONEAREST);
    CHECK(inside == usual);
  }
}

TEST_CASE("guards nest", "[float]") {
  double inner = 1.0, outer = 1.0;
  {
    const FloatMode first;
    {
      const FloatMode second;
      inner = multiply(kSmallest, 0.5);
    }
    outer = multiply(kSmallest, 0.5);
  }
  CHECK(inner == 0.0);
  CHECK(outer == 0.0);
}
