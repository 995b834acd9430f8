// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/se3.h>
#include <pointplane/odometry/MotionModel.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
constexpr double kFramePeriod = 1.0 / 30;

/** Until a velocity has been measured: as fast as hands move. */
constexpr double kUnknownVelocity = 0.5;         // [m/s]
constexpr double kUnknownAngularVelocity = 1.0;  // [rad/s]

/** After a longer time nothing more can become unknown; stamps may be any number. */
constexpr double kLongestStep = 24 * 3600.0;
}  // namespace

void MotionModel::TParams::check() const
{
    POINTPLANE_CHECK(decay >= 0 && decay <= 1, "decay = " << decay << " is not in [0, 1]");
    POINTPLANE_CHECK(
        sigmaAcceleration > 0, "sigmaAcceleration = " << sigmaAcceleration << " is not positive");
    POINTPLANE_CHECK(
        sigmaAngularAcceleration > 0,
        "sigmaAngularAcceleration = " << sigmaAngularAcceleration << " is not positive");
}

PoseGaussian MotionModel::predict(double dt) const
{
    const double step = std::min(dt, kLongestStep);
    // The velocity is known for the middle of the latest increment.
    const double span = step + coasting_ + 0.5 * kFramePeriod;
    double sigmaV = params_.sigmaAcceleration * span;
    double sigmaW = params_.sigmaAngularAcceleration * span;
    if (measured_ == 0)
    {
        sigmaV = kUnknownVelocity;
        sigmaW = kUnknownAngularVelocity;
    }
    PoseGaussian out;
    out.mean = se3Exp(velocity_ * step);
    out.cov.diagonal() << Eigen::Vector3d::Constant(sigmaV * sigmaV * step * step),
        Eigen::Vector3d::Constant(sigmaW * sigmaW * step * step);
    return out;
}

void MotionModel::update(const Eigen::Isometry3d& T_prev_cur, double dt)
{
    velocity_ = se3Log(T_prev_cur) / dt;
    ++measured_;
    coasting_ = 0;
}

void MotionModel::coast(double dt)
{
    velocity_ *= std::pow(params_.decay, dt / kFramePeriod);
    coasting_ = std::min(coasting_ + dt, 1.0);
}

void MotionModel::reset()
{
    velocity_.setZero();
    measured_ = 0;
    coasting_ = 0;
}
}  // namespace pointplane
