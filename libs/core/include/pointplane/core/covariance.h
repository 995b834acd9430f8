// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/check.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include <algorithm>

namespace pointplane
{
/** First-order propagation J S J^T, made exactly symmetric. */
template <class DerivedJ, class DerivedS>
[[nodiscard]] auto propagate(
    const Eigen::MatrixBase<DerivedJ>& J, const Eigen::MatrixBase<DerivedS>& S)
{
    constexpr int kRows = DerivedJ::RowsAtCompileTime;
    Eigen::Matrix<double, kRows, kRows> out = J * S * J.transpose();
    out = (0.5 * (out + out.transpose())).eval();
    return out;
}

/** True when S is finite, symmetric and strictly positive definite. */
template <class Derived>
[[nodiscard]] bool isPositiveDefinite(const Eigen::MatrixBase<Derived>& S)
{
    if (!S.allFinite() || !S.isApprox(S.transpose(), 1e-9))
    {
        return false;
    }
    const Eigen::LLT<typename Derived::PlainObject> llt(S);
    return llt.info() == Eigen::Success;
}

/** The nearest symmetric matrix whose eigenvalues are at least `floor`.
 * \throws std::invalid_argument if S is not finite */
template <class Derived>
[[nodiscard]] typename Derived::PlainObject withEigenvalueFloor(
    const Eigen::MatrixBase<Derived>& S, double floor)
{
    using Plain = typename Derived::PlainObject;
    POINTPLANE_CHECK(S.allFinite(), "covariance is not finite");
    const Eigen::SelfAdjointEigenSolver<Plain> es((0.5 * (S + S.transpose())).eval());
    if (es.eigenvalues().minCoeff() >= floor)
    {
        return 0.5 * (S + S.transpose());
    }
    const auto clamped = es.eigenvalues().cwiseMax(floor).eval();
    Plain out = es.eigenvectors() * clamped.asDiagonal() * es.eigenvectors().transpose();
    return 0.5 * (out + out.transpose());
}

/** S with all eigenvalues raised to at least 1e-14 and 1e-12 of their sum. Smaller ones are lost in
 * rounding as soon as the matrix is transformed or factorised in another order.
 * \throws std::invalid_argument if S is not finite */
template <class Derived>
[[nodiscard]] typename Derived::PlainObject strictlyPositive(const Eigen::MatrixBase<Derived>& S)
{
    constexpr double kLeastVariance = 1e-14, kLeastShare = 1e-12;
    return withEigenvalueFloor(S, std::max(kLeastVariance, kLeastShare * S.trace()));
}
}  // namespace pointplane
