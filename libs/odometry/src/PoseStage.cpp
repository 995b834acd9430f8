// SPDX-License-Identifier: BSD-3-Clause
#include "PoseStage.h"

#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "Stopwatch.h"

namespace pointplane
{
namespace
{
/** Fewer matches than this in total cannot fix a pose [P17, section Pose estimation]. */
constexpr int kMinMatches = 3;

/** White noise of points over what their covariances say: tracks of neighbouring frames err alike.
 */
constexpr double kPointNoise = 0.1;

/** Drift of what points say over that of planes, of which many pixels average. */
constexpr double kPointDrift = 54;

/** Residuals larger than propagated noise come from what is wrong with depth and calibration, which
 * changes with the view rather than from frame to frame: drift grows faster than they do. The
 * powers suit Kinects (variance up to 56 times the propagated one), simulated ones (0.5 to 1.6) and
 * exact renderings at once (docs/experiments.md). */
constexpr double kPointPower = 1.9, kCommonPointPower = 2.5, kCommonPlanePower = 0.5;

/** A common error turns the pose by as much as it moves what is seen 4 m away [rad/m]. */
constexpr double kDriftRotation = 0.25;

/** How many directions the measurements know better than the motion model does. */
int observableDirections(const Matrix6d& information, const Matrix6d& priorCovariance)
{
    const Matrix6d L = priorCovariance.llt().matrixL();
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(L.transpose() * information * L);
    return static_cast<int>((es.eigenvalues().array() > 1).count());
}

/** How far a motion within dt changes what is seen: 1 for another view of the scene, more if it is
 * fast, which blurs images and shears depth. */
double numViews(const Eigen::Isometry3d& motion, double dt)
{
    constexpr double kDistance = 0.15;          // [m]
    constexpr double kAngle = 10 * M_PI / 180;  // [rad]
    constexpr double kRate = 3, kPower = 0.25;  // [1/s], by hand
    const double views =
        motion.translation().norm() / kDistance + so3Log(motion.linear()).norm() / kAngle;
    return views * std::pow(views / dt / kRate, kPower);
}

/** What residuals say of errors in common: smaller ones than propagated say nothing against them,
 * and those of features that a frame does not have say nothing at all. */
double excessOf(double variance, const Matrix12d& sensitivity)
{
    return sensitivity.isZero() ? 1 : std::max(1.0, variance);
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
      shutter_(params.shutter)
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
    out.errors = errorsOf(estimate, ofShutter, dt);
    if (fuses())
    {
        out.previousVelocity = motion_.update(estimate.motion, dt);
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

/** Noise of the frame itself and drift of the references, on one scale for all cameras by what the
 * residuals and the references' disagreement say of them. */
JointCovariance::Measurement PoseStage::errorsOf(
    const PoseEstimate& estimate, const Matrix6d& ofShutter, double dt) const
{
    JointCovariance::Measurement out;
    if (covariance_.model == "independent")
    {
        out.prior.topLeftCorner<6, 6>().setIdentity();
        out.noise.topLeftCorner<6, 6>() = estimate.motion.pose().cov + ofShutter;
        return out;
    }
    const Matrix12d& points = estimate.sensitivity.points;
    const Matrix12d& planes = estimate.sensitivity.planes;
    const NoiseFactors residuals = noise_.residuals();
    out.references = estimate.sensitivity.references;
    out.prior = estimate.sensitivity.prior;
    if (!fuses())
    {
        out.prior.rightCols<6>().setZero();  // the velocity is a new one for each frame
    }
    out.vignetting = estimate.sensitivity.vignetting;
    out.noise = covariance_.noise * (kPointNoise * residuals.points * points + planes);
    out.noise.topLeftCorner<6, 6>() += ofShutter;
    out.priorNoise = propagate(estimate.sensitivity.prior, motion_.processNoise(dt));
    const Matrix12d ofFeatures = kPointDrift * std::pow(residuals.points, kPointPower) *
                                     noise_.disagreement().points * points +
                                 planes;
    Vector6d common;  // many features do not average what they all err by
    common << Eigen::Vector3d::Constant(covariance_.driftSigma),
        Eigen::Vector3d::Constant(covariance_.driftSigma * kDriftRotation);
    out.drift = covariance_.drift * covariance_.noise * ofFeatures.topLeftCorner<6, 6>();
    out.drift.diagonal() += std::pow(excessOf(residuals.points, points), kCommonPointPower) *
                            std::pow(excessOf(residuals.planes, planes), kCommonPlanePower) *
                            common.cwiseAbs2();
    out.drift *= numViews(estimate.motion.mean.T_base_cur, dt);
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
