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
}  // namespace

void MotionModel::TParams::check() const
{
    POINTPLANE_CHECK(decay >= 0 && decay <= 1, "decay = " << decay << " is not in [0, 1]");
    POINTPLANE_CHECK(
        velocityRandomWalk > 0,
        "velocityRandomWalk = " << velocityRandomWalk << " is not positive");
    POINTPLANE_CHECK(
        angularVelocityRandomWalk > 0,
        "angularVelocityRandomWalk = " << angularVelocityRandomWalk << " is not positive");
}

MotionModel::MotionModel(const TParams& params) : params_(params) { reset(); }

Vector6d MotionModel::density() const
{
    Vector6d out;
    out << Eigen::Vector3d::Constant(params_.velocityRandomWalk),
        Eigen::Vector3d::Constant(params_.angularVelocityRandomWalk);
    return out.cwiseAbs2();
}

MotionGaussian MotionModel::predict(double dt) const
{
    MotionGaussian out;
    out.mean = {se3Exp(velocity_ * dt), velocity_};
    const Matrix6d Q = density().asDiagonal();
    out.cov << dt * dt * cov_ + dt * dt * dt / 3 * Q, dt * cov_ + dt * dt / 2 * Q,
        dt * cov_ + dt * dt / 2 * Q, cov_ + dt * Q;
    return out;
}

Vector6d MotionModel::update(const MotionGaussian& measured, double dt)
{
    const MotionGaussian predicted = predict(dt);
    Eigen::Matrix<double, 12, 6> covWithVelocity;  // of the predicted motion with velocity_
    covWithVelocity << dt * cov_, cov_;
    Vector12d innovation;
    innovation << leftError(measured.mean.T_base_cur, predicted.mean.T_base_cur),
        measured.mean.velocity - predicted.mean.velocity;
    const Vector6d smoothed =
        velocity_ + covWithVelocity.transpose() * predicted.cov.ldlt().solve(innovation);
    velocity_ = measured.mean.velocity;
    cov_ = measured.cov.bottomRightCorner<6, 6>();
    return smoothed;
}

void MotionModel::coast(double dt)
{
    velocity_ *= std::pow(params_.decay, dt / kFramePeriod);
    cov_.diagonal() += std::min(dt, 1.0) * density();
    cov_ = cov_.cwiseMin(1e6);
}

void MotionModel::reset()
{
    velocity_.setZero();
    cov_.setZero();
    cov_.diagonal() << Eigen::Vector3d::Constant(kUnknownVelocity * kUnknownVelocity),
        Eigen::Vector3d::Constant(kUnknownAngularVelocity * kUnknownAngularVelocity);
}
}  // namespace pointplane
