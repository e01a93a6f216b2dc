#include "online/beam/beam.h"

#include "online/math/vector3.h"

namespace railstep {

namespace {

constexpr int kVectors = 5, kComponents = 15;  // V, and its components

/// V of one point, [5][3].
void vectors(const BeamPoint& p, const double* q, double V[kVectors][3]) noexcept {
  for (int k = 0; k < 3; ++k)
    for (int field = 0; field < 3; ++field) {
      const double* node = q + 3 * field + k;
      V[field][k] = (p.slope[0] * node[0] + p.slope[1] * node[9]) + p.slope[2] * node[18];
      if (field > 0)
        V[field + 2][k] = (p.value[0] * node[0] + p.value[1] * node[9]) + p.value[2] * node[18];
    }
}

/// Change of the products from rest.
void strains(const BeamPoint& p, const double V[kVectors][3], double s[kProducts]) noexcept {
  for (int k = 0; k < kProducts; ++k) {
    const int i = kProductOf[k][0], j = kProductOf[k][1];
    s[k] = (i == j ? .5 : 1.) * dot(V[i], V[j]) - p.rest[k];
  }
}

/// dU/ds = p0 + C s.
void stresses(const BeamPoint& p, const double s[kProducts], double stress[kProducts]) noexcept {
  for (int k = 0; k < kProducts; ++k) stress[k] = p.preload[k];
  for (int l = 0; l < kProducts; ++l)
    for (int k = 0; k < kProducts; ++k) stress[k] += p.stiffness[l][k] * s[l];
}

/// dU/dV, [5][3]: each product's stress times the other vector.
void vector_forces(const double stress[kProducts], const double V[kVectors][3],
                   double F[kVectors][3]) noexcept {
  for (int i = 0; i < kVectors; ++i)
    for (int c = 0; c < 3; ++c) F[i][c] = 0.;
  for (int k = 0; k < kProducts; ++k) {
    const int i = kProductOf[k][0], j = kProductOf[k][1];
    for (int c = 0; c < 3; ++c) F[i][c] += stress[k] * V[j][c];
    if (i != j)
      for (int c = 0; c < 3; ++c) F[j][c] += stress[k] * V[i][c];
  }
}

/// Nodal forces of the forces on V: the transpose of vectors().
void add_nodal(const BeamPoint& p, const double F[kVectors][3], double* force) noexcept {
  for (int node = 0; node < 3; ++node)
    for (int k = 0; k < 3; ++k) {
      double* at = force + 9 * node + k;
      at[0] += p.slope[node] * F[0][k];
      at[3] += p.slope[node] * F[1][k] + p.value[node] * F[3][k];
      at[6] += p.slope[node] * F[2][k] + p.value[node] * F[4][k];
    }
}

/// ds/dV, [15 products][15 components of V].
void product_rows(const double V[kVectors][3], double G[kProducts][kComponents]) noexcept {
  for (int k = 0; k < kProducts; ++k) {
    for (int c = 0; c < kComponents; ++c) G[k][c] = 0.;
    const int i = kProductOf[k][0], j = kProductOf[k][1];
    for (int c = 0; c < 3; ++c) {
      G[k][3 * i + c] = V[j][c];
      G[k][3 * j + c] = V[i][c];
    }
  }
}

/// d2U/dV2 = G' C G, and each product's stress on the identity between its vectors; upper triangle.
void vector_tangent(const BeamPoint& p, const double stress[kProducts], const double V[kVectors][3],
                    double K[kComponents][kComponents]) noexcept {
  double G[kProducts][kComponents], CG[kProducts][kComponents];
  product_rows(V, G);
  for (int k = 0; k < kProducts; ++k) {
    for (int c = 0; c < kComponents; ++c) CG[k][c] = 0.;
    for (int l = 0; l < kProducts; ++l)
      for (int c = 0; c < kComponents; ++c) CG[k][c] += p.stiffness[k][l] * G[l][c];
  }
  for (int r = 0; r < kComponents; ++r)
    for (int c = r; c < kComponents; ++c) {
      double sum = 0.;
      for (int k = 0; k < kProducts; ++k) sum += G[k][r] * CG[k][c];
      K[r][c] = sum;
    }
  for (int k = 0; k < kProducts; ++k)
    for (int c = 0; c < 3; ++c) K[3 * kProductOf[k][0] + c][3 * kProductOf[k][1] + c] += stress[k];
}

void add_nodal_tangent(const BeamPoint& p, const double K[kComponents][kComponents],
                       double* tangent) noexcept {
  // Coefficient of node coordinate (node, field) in vector v of V.
  double B[9][kVectors];
  for (int node = 0; node < 3; ++node)
    for (int field = 0; field < 3; ++field)
      for (int v = 0; v < kVectors; ++v)
        B[3 * node + field][v] =
            v == field ? p.slope[node] : (field > 0 && v == field + 2 ? p.value[node] : 0.);
  for (int m = 0; m < 9; ++m)
    for (int n = m; n < 9; ++n)
      for (int i = 0; i < 3; ++i)
        for (int j = m == n ? i : 0; j < 3; ++j) {
          double sum = 0.;
          for (int v = 0; v < kVectors; ++v)
            for (int w = 0; w < kVectors; ++w) {
              const int r = 3 * v + i, c = 3 * w + j;
              sum += (B[m][v] * B[n][w]) * (r <= c ? K[r][c] : K[c][r]);
            }
          tangent[27 * (3 * m + i) + 3 * n + j] += sum;
        }
}

}  // namespace

void beam_force(const Beam& beam, const double* q, double* force) noexcept {
  for (int i = 0; i < kBeamUnknowns; ++i) force[i] = 0.;
  for (int g = 0; g < beam.points; ++g) {
    const BeamPoint& p = beam.point[g];
    double V[kVectors][3], s[kProducts], stress[kProducts], F[kVectors][3];
    vectors(p, q, V);
    strains(p, V, s);
    stresses(p, s, stress);
    vector_forces(stress, V, F);
    add_nodal(p, F, force);
  }
}

void beam_tangent(const Beam& beam, const double* q, double* force, double* tangent) noexcept {
  for (int i = 0; i < kBeamUnknowns; ++i) force[i] = 0.;
  for (int i = 0; i < kBeamUnknowns * kBeamUnknowns; ++i) tangent[i] = 0.;
  for (int g = 0; g < beam.points; ++g) {
    const BeamPoint& p = beam.point[g];
    double V[kVectors][3], s[kProducts], stress[kProducts], F[kVectors][3];
    double K[kComponents][kComponents];
    vectors(p, q, V);
    strains(p, V, s);
    stresses(p, s, stress);
    vector_forces(stress, V, F);
    add_nodal(p, F, force);
    vector_tangent(p, stress, V, K);
    add_nodal_tangent(p, K, tangent);
  }
  for (int i = 0; i < kBeamUnknowns; ++i)
    for (int j = 0; j < i; ++j) tangent[kBeamUnknowns * i + j] = tangent[kBeamUnknowns * j + i];
}

}  // namespace railstep
