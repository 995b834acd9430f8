// SPDX-License-Identifier: BSD-3-Clause
#include "frame_errors.h"

#include <pointplane/core/se3.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
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

/** How far a motion within dt changes what is seen: 1 for another view of the scene, more if it is
 * fast, which blurs images and shears depth. */
double numViews(const Eigen::Isometry3d& motion, double dt)
{
    constexpr double kDistance = 0.15;          // [m]
    constexpr double kAngle = 10 * M_PI / 180;  // [rad]
    constexpr double kRate = 3, kPower = 0.25;  // [1/s], by hand
    constexpr double kShortest = 1e-3;          // [s], stamps may be odd
    const double views =
        motion.translation().norm() / kDistance + so3Log(motion.linear()).norm() / kAngle;
    return views * std::pow(views / std::max(dt, kShortest) / kRate, kPower);
}

/** What residuals say of errors in common: smaller ones than propagated say nothing against them,
 * and those of features that a frame does not have say nothing at all. */
double excessOf(double variance, const Matrix12d& sensitivity)
{
    return sensitivity.isZero() ? 1 : std::max(1.0, variance);
}
}  // namespace

JointCovariance::Measurement frameErrors(
    const Sensitivity& sensitivity,
    const NoiseFactors& residuals,
    const NoiseFactors& disagreement,
    const Eigen::Isometry3d& motion,
    double dt,
    const JointCovariance::TParams& params)
{
    const Matrix12d &points = sensitivity.points, &planes = sensitivity.planes;
    JointCovariance::Measurement out;
    out.references = sensitivity.references;
    out.prior = sensitivity.prior;
    out.vignetting = sensitivity.vignetting;
    out.noise = params.noise * (kPointNoise * residuals.points * points + planes);

    const Matrix12d ofFeatures =
        kPointDrift * std::pow(residuals.points, kPointPower) * disagreement.points * points +
        planes;
    Vector6d common;  // many features do not average what they all err by
    common << Eigen::Vector3d::Constant(params.driftSigma),
        Eigen::Vector3d::Constant(params.driftSigma * kDriftRotation);
    out.drift = params.drift * params.noise * ofFeatures.topLeftCorner<6, 6>();
    out.drift.diagonal() += std::pow(excessOf(residuals.points, points), kCommonPointPower) *
                            std::pow(excessOf(residuals.planes, planes), kCommonPlanePower) *
                            common.cwiseAbs2();
    out.drift *= numViews(motion, dt);
    return out;
}
}  // namespace pointplane
