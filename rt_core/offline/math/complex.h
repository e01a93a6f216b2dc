#pragma once
#include <complex>

namespace railstep {

using ComplexNumber = std::complex<double>;

}  // namespace railstep
