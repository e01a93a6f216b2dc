#pragma once

namespace railstep {

/// Lean of a rail: the axes y', z' of its section, rotated about x against those of the track,
///   e_y' = (0, cosine, sine),   e_z' = (0, -sine, cosine).
/// Rails lean inwards: sine > 0 on the left (+y), below 0 on the right. Unknowns of a rail's nodes
/// and places in its section count along its own axes.
struct Cant {
  double cosine = 1., sine = 0.;
};

/// Components of a vector of the track along a rail's axes. @param own must not alias `track`
inline void to_rail(const Cant& cant, const double* track, double* own) noexcept {
  own[0] = track[0];
  own[1] = cant.cosine * track[1] + cant.sine * track[2];
  own[2] = cant.cosine * track[2] - cant.sine * track[1];
}

/// The reverse. @param track must not alias `own`
inline void to_track(const Cant& cant, const double* own, double* track) noexcept {
  track[0] = own[0];
  track[1] = cant.cosine * own[1] - cant.sine * own[2];
  track[2] = cant.cosine * own[2] + cant.sine * own[1];
}

/// Row of the height of the section's point (y, z) in a node's unknowns [r, a, b], rail axes.
inline void height_row(const Cant& cant, double y, double z, double* row) noexcept {
  const double lever[3] = {1., y, z};
  for (int i = 0; i < 3; ++i) {
    row[3 * i] = 0.;
    row[3 * i + 1] = cant.sine * lever[i];
    row[3 * i + 2] = cant.cosine * lever[i];
  }
}

/// The highest point of a railhead, which level wheels touch: in the section, and its height above
/// the rail's axis, m. The crown is a circle about a point below z = top on y = 0.
struct CrownTop {
  double y, z, height;
};
inline CrownTop crown_top(const Cant& cant, double top, double radius) noexcept {
  return {radius * cant.sine, top - radius * (1. - cant.cosine),
          top - (top - radius) * (1. - cant.cosine)};
}

}  // namespace railstep
