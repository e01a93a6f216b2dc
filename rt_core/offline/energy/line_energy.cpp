#include "offline/energy/line_energy.h"

namespace railstep {
namespace {

using ComplexSparse = Eigen::SparseMatrix<std::complex<double>>;

/// [Re A, -Im A], which turns [Re z, Im z] into Re(A z).
Eigen::SparseMatrix<double> real_form(const ComplexSparse& A) {
  Eigen::SparseMatrix<double> both(A.rows(), 2 * A.cols());
  both.leftCols(A.cols()) = A.real();
  both.rightCols(A.cols()) = -A.imag();
  return both;
}

/// A diagonal as a sparse matrix.
Eigen::SparseMatrix<double> diagonal(const Eigen::VectorXd& values) {
  return Eigen::SparseMatrix<double>(values.asDiagonal());
}

}  // namespace

LineEnergy::LineEnergy(const PackedLine& own, const Model& model, const LineModel& line)
    : condensed_(model.form == Form::condensed), first_(line.first) {
  const double* const constant = model.constant_force;
  if (!condensed_) {
    mass_ = own.line.mass;
    damping_ = own.line.damping;
    stiffness_ = own.line.stiffness;
    if (constant != nullptr)
      constant_ = Eigen::Map<const Eigen::VectorXd>(constant + first_, own.line.unknowns());
    return;
  }
  const Eigen::Index modes = own.modes.rate().size();
  mass_ = diagonal(Eigen::VectorXd::Ones(own.basis.omega.size()));
  damping_ = own.modes.damping();
  stiffness_ = diagonal(own.basis.omega.cwiseAbs2());
  const ComplexSparse shape = own.modes.shape();
  shape_ = real_form(shape);
  rate_ = real_form(shape * own.modes.rate().asDiagonal());
  if (constant == nullptr) return;
  // From the modal force q = shape' p; Re shape rate shape' = I gives p back.
  Eigen::VectorXd q(2 * modes);
  q << Eigen::Map<const Eigen::VectorXd>(constant + first_, modes),
      Eigen::Map<const Eigen::VectorXd>(constant + model.unknowns + first_, modes);
  constant_ = rate_ * q;
}

LineMotion LineEnergy::motion(const State& state) const {
  LineMotion at;
  if (condensed_) {
    const Eigen::Index modes = shape_.cols() / 2;
    Eigen::VectorXd z(2 * modes);
    z << Eigen::Map<const Eigen::VectorXd>(state.u + first_, modes),
        Eigen::Map<const Eigen::VectorXd>(state.v + first_, modes);
    at.u.noalias() = shape_ * z;
    at.v.noalias() = rate_ * z;
  } else {
    const Eigen::Index n = mass_.rows();
    at.u = Eigen::Map<const Eigen::VectorXd>(state.u + first_, n);
    at.v = Eigen::Map<const Eigen::VectorXd>(state.v + first_, n);
    at.g = Eigen::Map<const Eigen::VectorXd>(state.g + first_, n);
    at.Mg = mass_ * at.g;
  }
  at.Mv = mass_ * at.v;
  at.Cv = damping_ * at.v;
  at.kinetic = .5 * at.v.dot(at.Mv);
  at.strain = .5 * at.u.dot(stiffness_ * at.u);
  at.power = at.v.dot(at.Cv);
  return at;
}

double LineEnergy::constant_work(const LineMotion& before, const LineMotion& after) const {
  return constant_.size() == 0 ? 0. : constant_.dot(after.u - before.u);
}

double LineEnergy::loss(const LineMotion& before, const LineMotion& after, double dt) const {
  if (condensed_) return 0.;
  const Eigen::VectorXd eu = (after.u - before.u) - .5 * dt * (before.v + after.v);
  const Eigen::VectorXd Mev = (after.Mv - before.Mv) - .5 * dt * (before.Mg + after.Mg);
  return .5 *
             (eu.dot(before.Mg + after.Mg + before.Cv + after.Cv) - (before.v + after.v).dot(Mev)) -
         .25 * dt * (after.v - before.v).dot(after.Cv - before.Cv);
}

Eigen::VectorXd LineEnergy::unbalanced(const LineMotion& at, const double* force) const {
  const Eigen::Map<const Eigen::VectorXd> f(force + first_, at.u.size());
  return f - at.Mg - at.Cv - stiffness_ * at.u;
}

}  // namespace railstep
