#include "offline/math/gauss.h"

#include <cmath>
#include <string>

#include "offline/math/refuse.h"

namespace railstep {

std::vector<GaussPoint> gauss(int points) {
  switch (points) {
    case 1:
      return {{0., 2.}};
    case 2: {
      const double x = 1. / std::sqrt(3.);
      return {{-x, 1.}, {x, 1.}};
    }
    case 3: {
      const double x = std::sqrt(.6);
      return {{-x, 5. / 9.}, {0., 8. / 9.}, {x, 5. / 9.}};
    }
    case 4: {
      const double root = 2. / 7. * std::sqrt(1.2);
      const double x1 = std::sqrt(3. / 7. - root), x2 = std::sqrt(3. / 7. + root);
      const double w1 = (18. + std::sqrt(30.)) / 36., w2 = (18. - std::sqrt(30.)) / 36.;
      return {{-x2, w2}, {-x1, w1}, {x1, w1}, {x2, w2}};
    }
    case 5: {
      const double root = 2. * std::sqrt(10. / 7.);
      const double x1 = std::sqrt(5. - root) / 3., x2 = std::sqrt(5. + root) / 3.;
      const double w1 = (322. + 13. * std::sqrt(70.)) / 900.;
      const double w2 = (322. - 13. * std::sqrt(70.)) / 900.;
      return {{-x2, w2}, {-x1, w1}, {0., 128. / 225.}, {x1, w1}, {x2, w2}};
    }
    default:
      refuse("E-MATH-01", "axial points: " + std::to_string(points) + "; expected 1 to 5");
  }
}

}  // namespace railstep
