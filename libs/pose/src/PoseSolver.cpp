// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/pose/PoseSolver.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

#include "NormalEquations.h"
#include "disagreement.h"

namespace pointplane
{
namespace
{
/** Steps below a hundredth of a millimetre or of a milliradian end the search. */
constexpr double kStepTolerance = 1e-5;

/** Keeps what nothing determines finite. */
constexpr double kDamping = 1e-9;

/** Squared Mahalanobis norm of the pose's deviation from the predicted one. */
double deviation(const MotionPrior& prior, const Vector12d& residual)
{
    return residual.head<6>().dot(prior.pose * residual.head<6>());
}

/** Student's t for the predicted pose, beyond the norm that is expected: a jerk must not be
 * smoothed away. */
struct RobustPrior
{
    const MotionPrior& prior;
    double dof;

    [[nodiscard]] bool isDoubted(double norm2) const { return dof > 0 && norm2 > 6; }

    [[nodiscard]] Matrix12d information(const Motion& motion) const
    {
        const double norm2 = deviation(prior, prior.residual(motion));
        Matrix12d out = prior.velocityGivenPose;
        out.topLeftCorner<6, 6>() +=
            (isDoubted(norm2) ? (dof + 6) / (dof + norm2) : 1.0) * prior.pose;
        return out;
    }

    [[nodiscard]] double cost(const Motion& motion) const
    {
        const Vector12d r = prior.residual(motion);
        const double norm2 = deviation(prior, r);
        const double poseCost =
            isDoubted(norm2) ? 6 + (dof + 6) * std::log((dof + norm2) / (dof + 6)) : norm2;
        return poseCost + r.dot(prior.velocityGivenPose * r);
    }
};
}  // namespace

void PoseSolver::TParams::check() const
{
    POINTPLANE_CHECK(
        weighting == "full" || weighting == "diagonal" || weighting == "none",
        "weighting = " << weighting << " is none of full, diagonal, none");
    POINTPLANE_CHECK(
        planeResidual == "minimal" || planeResidual == "closestPoint",
        "planeResidual = " << planeResidual << " is neither minimal nor closestPoint");
    POINTPLANE_CHECK(alpha >= 0, "alpha = " << alpha << " is negative");
    POINTPLANE_CHECK(tukeySigmas >= 0, "tukeySigmas = " << tukeySigmas << " is negative");
    POINTPLANE_CHECK(
        planeStudentDof >= 0, "planeStudentDof = " << planeStudentDof << " is negative");
    POINTPLANE_CHECK(
        priorStudentDof >= 0, "priorStudentDof = " << priorStudentDof << " is negative");
    POINTPLANE_CHECK(
        maxIterations >= 1 && maxIterations <= 1000,
        "maxIterations = " << maxIterations << " is not in 1..1000");
}

PoseSolver::PoseSolver(const TParams& params) : params_(params) { params_.check(); }

PoseEstimate PoseSolver::solve(
    const std::vector<PointPair>& points,
    const std::vector<PlanePair>& planes,
    const Eigen::Isometry3d& start,
    const std::optional<PoseGaussian>& prior) const
{
    MotionPrior motionPrior = MotionPrior::fixedVelocity({start, Vector6d::Zero()});
    if (prior)
    {
        motionPrior.mean.T_base_cur = prior->mean;
        motionPrior.pose = prior->cov.ldlt().solve(Matrix6d::Identity());
    }
    return solve(points, planes, Motion{start, Vector6d::Zero()}, motionPrior);
}

PoseEstimate PoseSolver::solve(
    const std::vector<PointPair>& points,
    const std::vector<PlanePair>& planes,
    const Motion& start,
    const MotionPrior& motionPrior,
    const NoiseFactors& noise) const
{
    const RobustPrior prior{motionPrior, params_.priorStudentDof};
    NormalEquations equations(params_, points, planes, noise);
    PoseEstimate out;
    Motion x = start;
    double lambda = 1e-6;
    while (out.iterations < params_.maxIterations && !out.converged)
    {
        equations.evaluate(x);
        const double cost = equations.cost() + prior.cost(x);
        const Matrix12d information = prior.information(x);
        const Matrix12d H = equations.points().H + equations.planes().H + information;
        const Vector12d g =
            equations.points().g + equations.planes().g - information * motionPrior.residual(x);
        for (bool accepted = false; !accepted && out.iterations < params_.maxIterations;)
        {
            ++out.iterations;
            Matrix12d damped = H;
            damped.diagonal() += lambda * H.diagonal() + Vector12d::Constant(kDamping);
            const Vector12d step = -damped.ldlt().solve(g);
            const Motion candidate{
                se3Exp(step.head<6>()) * x.T_base_cur, x.velocity + step.tail<6>()};
            accepted = step.allFinite() &&
                       equations.costAt(candidate) + prior.cost(candidate) <= cost * (1 + 1e-12);
            out.converged = step.head<3>().norm() < kStepTolerance &&
                            step.segment<3>(3).norm() < kStepTolerance;
            lambda = accepted ? std::max(1e-9, lambda * 0.1) : lambda * 10;
            if (accepted)
            {
                x = {orthonormalised(candidate.T_base_cur), candidate.velocity};
            }
            else if (out.converged || lambda > 1e8)
            {
                out.converged = true;
                break;
            }
        }
    }
    equations.evaluate(x);
    const FeatureSum& p = equations.points();
    const FeatureSum& m = equations.planes();
    const Matrix12d known = prior.information(x) + kDamping * Matrix12d::Identity();
    const Matrix12d H = p.H + m.H + known;
    const Matrix12d H_inverse = H.ldlt().solve(Matrix12d::Identity());
    out.motion = {x, propagate(H_inverse, p.M + m.M + known)};
    out.infoPoints = p.H.topLeftCorner<6, 6>();
    out.infoPlanes = m.H.topLeftCorner<6, 6>();
    if (params_.alpha > 0)
    {
        out.infoPlanes /= params_.alpha;
    }
    out.pointChi2PerDof = p.weightSum > 0 ? p.weightedChi2 / (3 * p.weightSum) : 0;
    out.planeChi2PerDof = m.weightSum > 0 ? m.weightedChi2 / (3 * m.weightSum) : 0;
    out.pointVariance = equations.pointVariance();
    out.planeVariance = equations.planeVariance();
    const std::map<int, FeatureSum> pointGroups = equations.pointsByReference();
    const std::map<int, FeatureSum> planeGroups = equations.planesByReference();
    if (pointGroups.size() + planeGroups.size() > 1)
    {
        out.pointDisagreement = disagreementOf(pointGroups, H, H_inverse, out.motion.cov);
        out.planeDisagreement = disagreementOf(planeGroups, H, H_inverse, out.motion.cov);
    }
    out.sensitivity.prior = H_inverse * known;
    for (const auto* groups : {&pointGroups, &planeGroups})
    {
        for (const auto& [reference, group] : *groups)
        {
            const auto it = out.sensitivity.references.emplace(reference, Matrix126d::Zero()).first;
            it->second += (H_inverse * group.H).leftCols<6>();
        }
    }
    out.sensitivity.points = propagate(H_inverse, equations.currentPointNoise());
    out.sensitivity.planes = propagate(H_inverse, equations.currentPlaneNoise());
    out.numPointInliers = p.numInliers;
    return out;
}
}  // namespace pointplane
