// SPDX-License-Identifier: BSD-3-Clause
#include "frame_errors.h"

#include <cmath>

namespace pointplane
{
namespace
{
/** Drift of what points say over what it were if each drifted for itself, relative to that of
 * planes: neighbouring points drift together, and there are many. */
constexpr double kPointDrift = 33;

/** Errors in common grow otherwise than those that features have for themselves: faster with those
 * of points, slower with those of planes. */
constexpr double kCommonPowerOfPoints = 1.25, kCommonPowerOfPlanes = 0.85;

/** A common error turns the pose by this part of what would move the scene as far as its
 * translation does. */
constexpr double kCommonRotation = 0.5;

/** How far away [m] the features are, as the pose feels it: where a rotation moves them as far as a
 * translation of that distance times the angle. */
double distanceOf(const Matrix6d& information)
{
    const double ofTranslation = information.topLeftCorner<3, 3>().trace();
    const double ofRotation = information.bottomRightCorner<3, 3>().trace();
    return ofTranslation > 0 ? std::sqrt(ofRotation / (2 * ofTranslation)) : 1;
}

/** Level of a kind of features in what all have in common; a frame without them is told nothing by
 * them. */
double commonOf(double drift, double power, const Matrix12d& sensitivity)
{
    return sensitivity.isZero(0) ? 1 : std::pow(drift, power);
}
}  // namespace

JointCovariance::Measurement frameErrors(
    const PoseEstimate& estimate,
    const Sensitivity& of,
    const ResidualVariogram::Levels& levels,
    double views,
    const JointCovariance::TParams& params)
{
    const auto& [white, drift] = levels;
    JointCovariance::Measurement out;
    out.references = of.references;
    out.prior = of.prior;
    out.camera = of.camera;
    out.noise = params.noise * (white.points * of.points + white.planes * of.planes);

    const Matrix12d ofFeatures = kPointDrift * drift.points * of.points + drift.planes * of.planes;
    const double distance = distanceOf(estimate.infoPoints + estimate.infoPlanes);
    // Depth errs with the square of the distance, pixels with the distance.
    const double sigma = params.driftSigma * std::pow(distance, 1.5);
    Vector6d common;  // many features do not average what they all err by
    common << Eigen::Vector3d::Constant(sigma),
        Eigen::Vector3d::Constant(kCommonRotation * params.driftSigma * distance);
    out.drift = params.drift * ofFeatures.topLeftCorner<6, 6>();
    out.drift.diagonal() += commonOf(drift.points, kCommonPowerOfPoints, of.points) *
                            commonOf(drift.planes, kCommonPowerOfPlanes, of.planes) *
                            common.cwiseAbs2();
    out.drift *= views;
    return out;
}
}  // namespace pointplane
