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

/** The nearest symmetric matrix whose eigenvalues are at least `floor`; S must be finite. */
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

/** Positive definite by a margin that stays when it is copied, transformed or factorised in another
 * order: what is smaller than the 1e-12th part of all eigenvalues drowns in rounding, when nothing
 * is known of other directions. S must be finite. */
template <class Derived>
[[nodiscard]] typename Derived::PlainObject strictlyPositive(const Eigen::MatrixBase<Derived>& S)
{
    constexpr double kLeastVariance = 1e-14, kLeastShare = 1e-12;
    return withEigenvalueFloor(S, std::max(kLeastVariance, kLeastShare * S.trace()));
}
}  // namespace pointplane
