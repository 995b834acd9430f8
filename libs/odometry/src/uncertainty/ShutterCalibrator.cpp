// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/range.h>
#include <pointplane/odometry/uncertainty/ShutterCalibrator.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
constexpr double kMaxTime = 0.05;  //!< no camera is slower [s]

/** Who knows the readouts knows when images are exposed. Otherwise the delay comes from time
 * stamps, which tell when they arrived. */
bool tellsExposure(const ShutterModel& source)
{
    return std::isfinite(source.readoutColour) && std::isfinite(source.readoutDepth) &&
           std::isfinite(source.depthDelay);
}
}  // namespace

void ShutterCalibrator::TParams::check() const
{
    checkRange("readoutColour", readoutColour, -kMaxTime, kMaxTime);
    checkRange("readoutDepth", readoutDepth, -kMaxTime, kMaxTime);
    checkRange("depthDelay", depthDelay, -kMaxTime, kMaxTime);
    checkRange("sigmaPrior", sigmaPrior, 1e-5, 1);
    checkRange("varianceFactor", varianceFactor, 0.01, 1000);
}

ShutterCalibrator::ShutterCalibrator(const TParams& params)
    : params_(params), estimate_(params.readoutColour, params.readoutDepth, params.depthDelay)
{
    params_.check();
    information_ = Eigen::Matrix3d::Identity() / (params_.sigmaPrior * params_.sigmaPrior);
    informationVector_ = information_ * estimate_;
}

double ShutterCalibrator::sigmaPrior() const { return std::min(params_.sigmaPrior, kMaxTime); }

ShutterModel ShutterCalibrator::complete(const ShutterModel& source) const
{
    if (!params_.correct)
    {
        return {0, 0, 0};  // [P17] says nothing of it
    }
    const auto known = [](double a, double b) { return std::isfinite(a) ? a : b; };
    return {
        known(source.readoutColour, estimate_[0]),
        known(source.readoutDepth, estimate_[1]),
        known(source.depthDelay, 0) + (tellsExposure(source) ? 0 : estimate_[2])};
}

Eigen::Vector3d ShutterCalibrator::estimated(const ShutterModel& source) const
{
    return {
        std::isfinite(source.readoutColour) ? 0.0 : 1.0,
        std::isfinite(source.readoutDepth) ? 0.0 : 1.0,
        tellsExposure(source) ? 0.0 : 1.0};
}

ShutterCalibrator::Change ShutterCalibrator::update(
    const CameraInformation& camera, double variance)
{
    Change out;
    if (!params_.correct || !params_.selfCalibrate)
    {
        return out;
    }
    // Frames repeat each other's residuals: each counts as a fraction of one.
    const double factor = params_.varianceFactor * variance;
    const Eigen::Matrix3d information = camera.information.bottomRightCorner<3, 3>() / factor;
    const Eigen::Vector3d gradient = camera.gradient.tail<3>() / factor;
    const Eigen::Matrix3d before = information_;
    information_ += information;
    informationVector_ += information * estimate_ - gradient;
    const Eigen::Matrix3d cov = information_.inverse();
    estimate_ = (cov * informationVector_).cwiseMax(-kMaxTime).cwiseMin(kMaxTime);
    out.gain = cov * before;
    out.noise = cov * information * cov.transpose();
    return out;
}
}  // namespace pointplane
