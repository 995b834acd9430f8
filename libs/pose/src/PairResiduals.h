// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseSolver.h>
#include <pointplane/pose/residuals.h>

#include <vector>

namespace pointplane
{
/** A residual, the weight matrix that it is given, and its squared norm by that. Of a pair that is
 * not usable: zero, and infinity. */
struct WeightedResidual
{
    Residual residual;
    Eigen::Matrix3d W{Eigen::Matrix3d::Zero()};
    double squaredNorm{0};
};

/** The pairs of a problem by one index, those of points before those of planes, and the residuals
 * that motions leave them. */
class PairResiduals
{
 public:
    /** \param solver, problem must live as long as this */
    PairResiduals(const PoseSolver::Settings& solver, const PoseProblem& problem);

    [[nodiscard]] size_t numPoints() const { return points_.size(); }
    [[nodiscard]] size_t size() const { return points_.size() + planes_.size(); }
    [[nodiscard]] bool isPoint(size_t i) const { return i < points_.size(); }
    [[nodiscard]] const PointPair& point(size_t i) const { return points_[i]; }

    /** Whether all of it is finite. */
    [[nodiscard]] bool isUsable(size_t i) const { return isUsable_[i]; }

    /** Degrees of freedom of its residual. */
    [[nodiscard]] int dof(size_t i) const;

    /** Index into PoseProblem::surfaces; beyond its end for a pair on none of them. */
    [[nodiscard]] size_t surfaceOf(size_t i) const;

    [[nodiscard]] WeightedResidual at(size_t i, const Motion& motion) const;
    [[nodiscard]] Residual residual(size_t i, const Motion& motion) const;

 private:
    [[nodiscard]] Eigen::Matrix3d weightMatrix(const Residual& residual) const;

    const PoseSolver::Settings& solver_;
    const std::vector<PointPair>& points_;
    const std::vector<PlanePair>& planes_;
    std::vector<bool> isUsable_;
};
}  // namespace pointplane
