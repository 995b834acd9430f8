// SPDX-License-Identifier: BSD-3-Clause
#include "PairResiduals.h"

#include <Eigen/LU>

#include <limits>

namespace pointplane
{
namespace
{
/** Sigma of unweighted residuals; sets only the balance with the prior. */
constexpr double kUnweightedSigma = 0.01;

/** Of a point or a plane in both views. */
bool isFinite(
    const Eigen::Vector3d& ref,
    const Eigen::Matrix3d& refCov,
    const Eigen::Vector3d& cur,
    const Eigen::Matrix3d& curCov)
{
    return ref.allFinite() && cur.allFinite() && refCov.allFinite() && curCov.allFinite();
}
}  // namespace

PairResiduals::PairResiduals(const PoseSolver::Settings& solver, const PoseProblem& problem)
    : solver_(solver), points_(problem.points), planes_(problem.planes)
{
    for (const PointPair& pair : points_)
    {
        isUsable_.push_back(isFinite(pair.ref.mean, pair.ref.cov, pair.cur.mean, pair.cur.cov));
    }
    for (const PlanePair& pair : planes_)
    {
        isUsable_.push_back(
            isFinite(pair.ref.theta_m, pair.ref.cov_m, pair.cur.theta_m, pair.cur.cov_m));
    }
}

int PairResiduals::dof(size_t i) const { return isPoint(i) ? points_[i].dof() : PlanePair::dof(); }

size_t PairResiduals::surfaceOf(size_t i) const
{
    return static_cast<size_t>(
        isPoint(i) ? points_[i].surface : planes_[i - points_.size()].feature);
}

WeightedResidual PairResiduals::at(size_t i, const Motion& motion) const
{
    WeightedResidual out;
    if (!isUsable_[i])
    {
        out.squaredNorm = std::numeric_limits<double>::infinity();
        return out;
    }
    out.residual = residual(i, motion);
    out.W = weightMatrix(out.residual);
    out.squaredNorm = out.residual.r.dot(out.W * out.residual.r);
    return out;
}

Residual PairResiduals::residual(size_t i, const Motion& motion) const
{
    if (isPoint(i))
    {
        return pointResidual(points_[i], motion);
    }
    const PlanePair& pair = planes_[i - points_.size()];
    return solver_.planeResidual == PoseSolver::PlaneResidual::Minimal
               ? planeResidualMinimal(pair, motion)
               : planeResidualClosestPoint(pair, motion);
}

Eigen::Matrix3d PairResiduals::weightMatrix(const Residual& residual) const
{
    if (solver_.weighting == PoseSolver::Weighting::Full)
    {
        return residual.cov.inverse();
    }
    if (solver_.weighting == PoseSolver::Weighting::Diagonal)
    {
        return residual.cov.diagonal().cwiseInverse().asDiagonal();  // [P17, after Eq. 10]
    }
    return Eigen::Matrix3d::Identity() / (kUnweightedSigma * kUnweightedSigma);  // [P17, Table 1]
}
}  // namespace pointplane
