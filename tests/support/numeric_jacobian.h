// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <type_traits>

namespace pointplane::test
{
/** Central-difference Jacobian of f: R^N -> R^M (Eigen vectors of fixed size) at x.
 * \param step the same for every component; error is about step^2 f''' + 1e-16 / step */
template <class F, class DerivedX>
[[nodiscard]] auto numericJacobian(
    const F& f, const Eigen::MatrixBase<DerivedX>& x, double step = 1e-5)
{
    using X = typename DerivedX::PlainObject;
    using Y = typename std::decay_t<decltype(f(X(x)))>::PlainObject;
    constexpr int kRows = Y::RowsAtCompileTime;
    constexpr int kCols = X::RowsAtCompileTime;
    Eigen::Matrix<double, kRows, kCols> J;
    for (int i = 0; i < kCols; ++i)
    {
        X plus = x, minus = x;
        plus[i] += step;
        minus[i] -= step;
        J.col(i) = (f(plus) - f(minus)) / (2 * step);
    }
    return J;
}
}  // namespace pointplane::test
