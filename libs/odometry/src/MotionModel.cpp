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

MotionGaussian MotionModel::predict(double dt) const
{
    MotionGaussian out;
    out.mean = {se3Exp(velocity_ * dt), velocity_};
    const Matrix6d Q = density_.asDiagonal();
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
    adapt(predicted, measured, innovation, dt);
    if (getenv("QDBG")) fprintf(stderr,"q %.3f %.3f\n",std::sqrt(density_[0]),std::sqrt(density_[3]));
    velocity_ = measured.mean.velocity;
    cov_ = measured.cov.bottomRightCorner<6, 6>();
    return smoothed;
}

/** One step of expectation-maximisation, averaged over time: the mean square of the velocity's
 * change given the measurement. */
void MotionModel::adapt(const MotionGaussian& predicted, const MotionGaussian& measured, const Vector12d& innovation, double dt)
{
    const Matrix6d Q = density_.asDiagonal();
    Eigen::Matrix<double, 12, 6> covWithChange;
    covWithChange << dt * dt / 2 * Q, dt * Q;
    const Eigen::Matrix<double, 12, 6> gain = predicted.cov.ldlt().solve(covWithChange);
    const Vector6d change = gain.transpose() * innovation;
    const Vector6d var = (dt * Q - gain.transpose() * (predicted.cov - measured.cov) * gain).diagonal();
    const Vector6d meanSquare = (change.cwiseAbs2() + var.cwiseMax(0)) / dt;
    const double rate = 1 - std::exp(-dt / params_.timeConstant);
    const double floors[] = {params_.velocityRandomWalk, params_.angularVelocityRandomWalk};
    for (int k = 0; k < 2; ++k)
    {
        auto block = density_.segment<3>(3 * k);
        const double value = block[0] + rate * (meanSquare.segment<3>(3 * k).mean() - block[0]);
        block.setConstant(std::max(value, floors[k] * floors[k]));
    }
}

void MotionModel::coast(double dt)
{
    velocity_ *= std::pow(params_.decay, dt / kFramePeriod);
    cov_.diagonal() += std::min(dt, 1.0) * density_;
    cov_ = cov_.cwiseMin(1e6);
}

void MotionModel::reset()
{
    velocity_.setZero();
    density_ << Eigen::Vector3d::Constant(params_.velocityRandomWalk),
        Eigen::Vector3d::Constant(params_.angularVelocityRandomWalk);
    density_ = density_.cwiseAbs2();
    cov_.setZero();
    cov_.diagonal() << Eigen::Vector3d::Constant(kUnknownVelocity * kUnknownVelocity),
        Eigen::Vector3d::Constant(kUnknownAngularVelocity * kUnknownAngularVelocity);
}
}  // namespace pointplane
