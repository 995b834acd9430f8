// SPDX-License-Identifier: BSD-3-Clause
#include "MotionModel.h"

#include <pointplane/core/covariance.h>
#include <pointplane/core/range.h>
#include <pointplane/core/se3.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** Standard deviation by which the smoother's velocities wander [m/s, rad/s]. In hands it is a few
 * times as large. But where hands shake, the velocity by two increments errs, too. */
constexpr double kWander = 0.01;

/** Change of the velocity before that is learnt, over the least one. Hands with a Kinect have 3 to
 * 4 and, of rotations, about 2; an unknown camera may have more. */
constexpr double kFirstRise = 4.5;

/** From the errors of pose and velocity before to those after: F in docs/theory.md. */
Matrix12d transition(const DecayedVelocities& after)
{
    Matrix12d out = Matrix12d::Identity();
    out.topRightCorner<6, 6>() = after.reach().asDiagonal();
    out.bottomRightCorner<6, 6>() = after.kept().asDiagonal();
    return out;
}
}  // namespace

void MotionParams::check() const
{
    checkRange("velocityRandomWalk", velocityRandomWalk, 1e-4, 20);
    checkRange("angularVelocityRandomWalk", angularVelocityRandomWalk, 1e-4, 100);
    checkRange("timeConstant", timeConstant, 0.01, 1000);
    checkRange("sigmaAcceleration", sigmaAcceleration, 0.01, 1000);
    checkRange("sigmaAngularAcceleration", sigmaAngularAcceleration, 0.01, 1e4);
    checkRange("accelerationTime", accelerationTime, 1e-3, 10);
}

MotionModel::MotionModel(const MotionParams& params)
    : params_(params), increments_(4 * params.accelerationTime, params.timeConstant)
{
    params_.check();
    reset();
}

DecayedVelocities MotionModel::after(double dt) const
{
    const double t = std::min(dt, kLongestStep);
    // The ratio of two learnt numbers can be anything; a velocity lasts at least as long as an
    // acceleration.
    const auto half = [&](int axis)
    {
        const double timeConstant = 2 * speed2_[axis] / learntDensity_[axis];
        return decayedVelocity(t, std::max(params_.accelerationTime, timeConstant));
    };
    return {half(0), half(3)};
}

// The decaying velocity of [P17, section Pose estimation].
Vector6d MotionModel::velocity() const { return after(elapsed_).kept().cwiseProduct(velocity_); }

Matrix6d MotionModel::velocityCov() const
{
    const Matrix6d kept = after(elapsed_).kept().asDiagonal();
    Matrix6d out = propagate(kept, Matrix6d(cov_.bottomRightCorner<6, 6>()));
    out.diagonal() += velocityGain(elapsed_);
    return out;
}

MotionGaussian MotionModel::predict(double dt) const
{
    Matrix12d ofVelocity = Matrix12d::Zero();
    ofVelocity.bottomRightCorner<6, 6>() = velocityCov();
    return predictFrom(velocity(), ofVelocity, dt);
}

MotionGaussian MotionModel::predictFromEstimate(double dt) const
{
    return predictFrom(velocity_, cov_, dt);
}

Matrix12d MotionModel::processNoise(double dt, const Matrix6d& open) const
{
    Matrix12d notMeasured = Matrix12d::Zero();
    notMeasured.bottomRightCorner<6, 6>() = cov_.bottomRightCorner<6, 6>() - measuredVelocityCov_;
    Matrix12d out = predictFrom(velocity_, notMeasured, dt).cov;
    // The pose tells a part of the velocity. White acceleration leaves the rest; one that lasts for
    // the time t_a leaves 4 dt / (15 t_a) of it in short steps.
    const Matrix6d together = out.topRightCorner<6, 6>();
    const Matrix6d told = together.transpose() * out.topLeftCorner<6, 6>().ldlt().solve(together);
    const double share = dt / (dt + 15.0 / 4 * params_.accelerationTime);
    const Matrix6d rest = out.bottomRightCorner<6, 6>() - told;
    out.bottomRightCorner<6, 6>() = told + share * rest + (1 - share) * propagate(open, rest);
    out.topLeftCorner<6, 6>() += propagate(open, bySuddenAcceleration(dt));
    return out;
}

Vector6d MotionModel::velocityGain(double dt) const
{
    return after(dt).velocity().cwiseProduct(density());
}

/** \param cov of [pose; velocity] at the start */
MotionGaussian MotionModel::predictFrom(
    const Vector6d& velocity, const Matrix12d& cov, double dt) const
{
    const DecayedVelocities end = after(dt);
    const Vector6d q = density();
    Matrix12d noise = Matrix12d::Zero();
    noise.topLeftCorner<6, 6>().diagonal() = end.pose().cwiseProduct(q);
    noise.topRightCorner<6, 6>().diagonal() = end.together().cwiseProduct(q);
    noise.bottomLeftCorner<6, 6>() = noise.topRightCorner<6, 6>();
    noise.bottomRightCorner<6, 6>().diagonal() = end.velocity().cwiseProduct(q);
    return {
        {se3Exp(end.reach().cwiseProduct(velocity)), end.kept().cwiseProduct(velocity)},
        propagate(transition(end), cov) + noise};
}

Matrix12d MotionModel::unforeseen(double dt) const
{
    Matrix12d out = predictFrom(Vector6d::Zero(), Matrix12d::Zero(), dt).cov;
    out.topLeftCorner<6, 6>() += bySuddenAcceleration(dt);
    return out;
}

Matrix6d MotionModel::bySuddenAcceleration(double dt) const
{
    const double t = std::min(dt, kLongestStep);
    return sudden().cwiseAbs2().asDiagonal() *
           std::pow(t * std::min(t, params_.accelerationTime), 2);
}

void MotionModel::follow(const Eigen::Isometry3d& T_prev_cur, double dt)
{
    velocity_ = se3Log(T_prev_cur) / std::min(dt, kLongestStep);
    cov_.setZero();
    cov_.bottomRightCorner<6, 6>() = velocityGain(dt).asDiagonal();
    measuredVelocityCov_.setZero();
    elapsed_ = 0;
}

MotionModel::Smoothed MotionModel::update(const MotionGaussian& measured, double dt)
{
    const double t = std::min(dt, kLongestStep);
    const MotionGaussian predicted = predictFromEstimate(t);
    Vector12d innovation;
    innovation << leftError(measured.mean.T_prev_cur, predicted.mean.T_prev_cur),
        measured.mean.velocity - predicted.mean.velocity;
    const auto solver = predicted.cov.ldlt();

    // Rauch-Tung-Striebel: covariance of the predicted motion with the velocity before it.
    const DecayedVelocities end = after(t);
    const Matrix12d F = transition(end);
    const Matrix126d covWithStart = F * cov_.rightCols<6>();
    const Eigen::Matrix<double, 6, 12> smoother = solver.solve(covWithStart).transpose();
    Smoothed out;
    out.velocity = velocity_ + smoother * innovation;
    out.byNextMotion = smoother.leftCols<6>();
    out.byNextVelocity = smoother.rightCols<6>();
    out.byVelocity -= smoother * F.rightCols<6>();

    // The same of the change of velocity on the way: covariance with the predicted motion.
    const Matrix6d gained = velocityGain(t).asDiagonal();
    Matrix126d covWithChange;
    covWithChange << Matrix6d(end.together().cwiseProduct(density()).asDiagonal()), gained;
    const Matrix126d gain = solver.solve(covWithChange);
    const Vector6d change = gain.transpose() * innovation;
    const Matrix6d cov = gained - gain.transpose() * (predicted.cov - measured.cov) * gain;
    const Vector6d change2 = change.cwiseAbs2() + cov.diagonal().cwiseMax(0);
    learn(change2.cwiseQuotient(end.velocity()), t, learntDensity_);
    learn(measured.mean.velocity.cwiseAbs2() + measured.cov.diagonal().tail<6>(), t, speed2_);

    velocity_ = measured.mean.velocity;
    // What errs in the frame where the motion started errs where it ended.
    Matrix12d toEnd = Matrix12d::Identity();
    toEnd.topLeftCorner<6, 6>() = adjoint(measured.mean.T_prev_cur.inverse());
    cov_ = propagate(toEnd, measured.cov);
    measuredVelocityCov_ = cov_.bottomRightCorner<6, 6>();
    elapsed_ = 0;
    const auto between = increments_.add(
        {se3Log(measured.mean.T_prev_cur) / t, measured.cov.diagonal().head<6>(), t});
    if (between)
    {
        weigh(*between, t, out);
    }
    return out;
}

void MotionModel::followIncrements()
{
    if (increments_.atEnd())
    {
        velocity_ = 0.5 * (velocity_ + *increments_.atEnd());
    }
}

/** By their variances, unless the camera has jerked in the dt [s] of the next increment. */
void MotionModel::weigh(
    const IncrementVelocities::Between& between, double dt, Smoothed& smoothed) const
{
    const Vector6d apart = between.velocity - smoothed.velocity;
    if (apart.head<3>().norm() > dt * params_.sigmaAcceleration ||
        apart.tail<3>().norm() > dt * params_.sigmaAngularAcceleration)
    {
        return;
    }
    const Vector6d wander = Vector6d::Constant(kWander * kWander);
    const Vector6d share = wander.cwiseQuotient(wander + between.variance);
    smoothed.velocity += share.cwiseProduct(apart);
    const Matrix6d kept = (Vector6d::Ones() - share).asDiagonal();
    smoothed.byVelocity = (kept * smoothed.byVelocity).eval();
    smoothed.byNextVelocity = (kept * smoothed.byNextVelocity).eval();
    smoothed.byNextMotion = (kept * smoothed.byNextMotion).eval();
    smoothed.byNextMotion.diagonal() += share / (between.ratio * between.dt);
    smoothed.byPreviousMotion = (share * (between.ratio / between.dt)).asDiagonal();
}

/** Average over time, the same for the three axes. */
void MotionModel::learn(const Vector6d& square, double dt, Vector6d& meanSquare) const
{
    const double rate = 1 - std::exp(-dt / params_.timeConstant);
    meanSquare += rate * (perAxis(square.head<3>().mean(), square.tail<3>().mean()) - meanSquare);
}

Vector6d MotionModel::density() const { return learntDensity_.cwiseMax(smallestDensity()); }

Vector6d MotionModel::sudden() const
{
    return perAxis(params_.sigmaAcceleration, params_.sigmaAngularAcceleration);
}

Vector6d MotionModel::smallestDensity() const
{
    return perAxis(params_.velocityRandomWalk, params_.angularVelocityRandomWalk).cwiseAbs2();
}

void MotionModel::coast(double dt)
{
    increments_.interrupt();
    elapsed_ = std::min(elapsed_ + dt, kLongestStep);
}

void MotionModel::startAtReference()
{
    const Matrix6d kept = after(elapsed_).kept().asDiagonal();
    const Matrix6d measured = propagate(kept, measuredVelocityCov_);
    const Matrix6d now = velocityCov();
    velocity_ = velocity();
    elapsed_ = 0;
    cov_.setZero();
    cov_.bottomRightCorner<6, 6>() = now;
    measuredVelocityCov_ = measured;
}

void MotionModel::reset()
{
    velocity_.setZero();
    increments_.interrupt();
    elapsed_ = 0;
    learntDensity_ = learntDensity_.cwiseMax(kFirstRise * kFirstRise * smallestDensity());
    speed2_ = speed2_.cwiseMax((params_.accelerationTime * sudden()).cwiseAbs2());
    cov_.setZero();
    cov_.bottomRightCorner<6, 6>() = speed2_.asDiagonal();
    measuredVelocityCov_.setZero();
}
}  // namespace pointplane
