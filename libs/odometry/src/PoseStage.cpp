// SPDX-License-Identifier: BSD-3-Clause
#include "PoseStage.h"

#include <pointplane/core/covariance.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "Stopwatch.h"
#include "frame_errors.h"
#include "views.h"

namespace pointplane
{
namespace
{
/** Fewer matches than this in total cannot fix a pose [P17, section Pose estimation]. */
constexpr int kMinMatches = 3;

/** How many directions the measurements know better than the motion model does. */
int observableDirections(const Matrix6d& information, const Matrix6d& priorCovariance)
{
    const Matrix6d L = priorCovariance.llt().matrixL();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(L.transpose() * information * L);
    return static_cast<int>((es.eigenvalues().array() > 1).count());
}

/** So few points cannot contradict each other when they are wrong; a plane is worth three. */
constexpr int kFewPoints = 6;

/** Standard deviations from the predicted pose that they are not believed then. */
constexpr double kMostSurprise = 5;

/** Root mean square deviation from the predicted pose, in its standard deviations. */
double surprise(const PoseEstimate& estimate, const PoseGaussian& predicted)
{
    const Vector6d e = leftError(estimate.motion.mean.T_base_cur, predicted.mean);
    return std::sqrt(e.dot(predicted.cov.ldlt().solve(e)) / 6);
}

double maxSigma(const Matrix6d& cov)
{
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(cov);
    return std::sqrt(std::max(0.0, es.eigenvalues().maxCoeff()));
}
}  // namespace

PoseStage::PoseStage(const OdometryParams& params)
    : pipeline_(params.pipeline),
      covariance_(params.covariance),
      solver_(params.poseSolver),
      motion_(params.motionModel),
      noise_(params.noiseScale),
      shutter_(params.shutter),
      isFrameToFrame_(params.reference.reference == "previous")
{
}

/** The paper counts points and planes; with a prediction to fuse with, any of them helps. */
int PoseStage::minMatches() const { return fuses() ? 1 : kMinMatches; }

/** The velocity follows the pose as motions do, but the pose is hardly pulled to the predicted one:
 * a jerk must not be smoothed away. The paper's gate wants to know what the frame alone says. */
MotionPrior PoseStage::priorFrom(const MotionGaussian& motion, const PoseGaussian& pose) const
{
    if (!fuses())
    {
        return MotionPrior::fixedVelocity(motion.mean);
    }
    MotionPrior prior = MotionPrior::from(motion);
    prior.pose = pose.cov.ldlt().solve(Matrix6d::Identity());
    return prior;
}

PoseStage::Prediction PoseStage::predict(double dt)
{
    if (dt > pipeline_.maxGap)
    {
        motion_.reset();
    }
    Prediction out;
    out.motion = motion_.predict(dt);
    out.pose = out.motion.pose();
    out.pose.cov += motion_.jerk(dt);
    out.prior = priorFrom(out.motion, out.pose);
    return out;
}

PoseEstimate PoseStage::estimate(
    const PairBuilder& pairs,
    const std::vector<Association>& associations,
    const Prediction& predicted,
    FrameDiagnostics& diagnostics) const
{
    const Stopwatch watch;
    std::vector<PointPair> points;
    std::vector<PlanePair> planes;
    pairs.build(associations, shutter_, points, planes);
    PoseEstimate out;
    out.motion = predicted.motion;
    if (static_cast<int>(points.size() + planes.size()) >= minMatches())
    {
        out =
            solver_.solve(points, planes, predicted.motion.mean, predicted.prior, noise_.factors());
    }
    diagnostics.iterations += out.iterations;
    diagnostics.numPointPairs = static_cast<int>(points.size());
    diagnostics.numPlanePairs = static_cast<int>(planes.size());
    diagnostics.numPointInliers = out.numPointInliers;
    diagnostics.pointChi2PerDof = out.pointChi2PerDof;
    diagnostics.planeChi2PerDof = out.planeChi2PerDof;
    diagnostics.numReferences = static_cast<int>(associations.size());
    diagnostics.msPose = watch.ms();
    return out;
}

void PoseStage::judge(
    const PoseEstimate& estimate, const Prediction& predicted, OdometryResult& result) const
{
    FrameDiagnostics& d = result.diagnostics;
    d.observableDirections =
        observableDirections(estimate.infoPoints + estimate.infoPlanes, predicted.pose.cov);
    const int matches = d.numPointPairs + d.numPlanePairs;
    const double sigma = maxSigma(estimate.motion.pose().cov);
    std::ostringstream reason;
    if (matches < minMatches())
    {
        reason << matches << " point and plane matches";
    }
    else if (!fuses() && sigma > pipeline_.gateSigma)
    {
        reason << "largest standard deviation " << sigma << " is above the gate";
    }
    else if (solver_.isWeighted() && d.pointChi2PerDof > pipeline_.maxPointChi2)
    {
        reason << "the points contradict their covariances (chi-square per degree of freedom "
               << d.pointChi2PerDof << ")";
    }
    else if (
        fuses() && d.numPointPairs + 3 * d.numPlanePairs < kFewPoints &&
        surprise(estimate, predicted.pose) > kMostSurprise)
    {
        reason << "only " << matches << " point and plane matches, far from the predicted motion";
    }
    else if (d.observableDirections == 0)
    {
        reason << "no direction is measured better than it is predicted";
    }
    else
    {
        result.status = TrackingStatus::Tracked;
        if (d.observableDirections < 6)
        {
            reason << d.observableDirections << " of 6 directions measured, the others predicted";
        }
    }
    result.reason = reason.str();
}

PoseStage::Measured PoseStage::accept(
    const PoseEstimate& estimate,
    const Prediction& predicted,
    const PairBuilder& pairs,
    const std::vector<Association>& associations,
    double dt)
{
    Measured out;
    out.T_prev_cur = estimate.motion.mean.T_base_cur;
    const Matrix6d ofShutter = shutter_.update(
        pairs, associations, estimate.motion.mean, predicted.prior, noise_.factors());
    out.errors = errorsOf(estimate, pairs, ofShutter, dt);
    if (fuses())
    {
        out.previousVelocity = motion_.update(estimate.motion, dt);
        if (isFrameToFrame_)
        {
            motion_.followIncrements();
        }
    }
    else
    {
        motion_.follow(estimate.motion.mean.T_base_cur, dt);
        out.previousVelocity = motion_.velocity();
    }
    out.velocity = motion_.velocity();
    noise_.update(estimate, dt);
    return out;
}

JointCovariance::Measurement PoseStage::errorsOf(
    const PoseEstimate& estimate, const PairBuilder& pairs, const Matrix6d& ofShutter, double dt)
{
    if (covariance_.model == "independent")
    {
        JointCovariance::Measurement out;
        out.prior.topLeftCorner<6, 6>().setIdentity();
        out.noise.topLeftCorner<6, 6>() = estimate.motion.pose().cov + ofShutter;
        return out;
    }
    const double views = numViews(estimate.motion.mean.T_base_cur);
    variogram_.update(estimate, pairs.R_world_base(), views, dt, noise_.residuals());
    JointCovariance::Measurement out =
        frameErrors(estimate, variogram_.levels(), views, covariance_);
    if (!fuses())
    {
        out.prior.rightCols<6>().setZero();  // the velocity is a new one for each frame
    }
    out.noise.topLeftCorner<6, 6>() += ofShutter;
    out.priorNoise =
        covariance_.motion * propagate(estimate.sensitivity.prior, motion_.processNoise(dt));
    return out;
}

PoseGaussian PoseStage::coast(double dt)
{
    PoseGaussian out = predict(dt).pose;
    out.cov = strictlyPositive(out.cov);
    motion_.coast(dt);
    return out;
}
}  // namespace pointplane
