// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/range.h>
#include <pointplane/core/se3.h>
#include <pointplane/odometry/uncertainty/MotionModel.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** For so long hands push one way [s]. An unknown velocity is what a sudden acceleration makes in
 * this time. */
constexpr double kPush = 0.05;

/** Standard deviation by which smoothed velocities wander [m/s, rad/s]. Hands make it a few times
 * as large; but where they shake, what lies between two increments errs, too. */
constexpr double kWander = 0.01;

/** By so much the velocity changes in a second before that is learnt [m/s, rad/s]: as hands move
 * a Kinect (0.3 to 0.4 m/s, 0.9 to 1.2 rad/s), and somewhat more. */
constexpr double kFirstChange = 0.45, kFirstTurn = 2.25;

/** Times that one step may be as long as the next, where they tell an acceleration. */
constexpr double kUnequal = 8;

/** Of a velocity that decays, all that can become unknown of it in the end [s]. */
constexpr double kLongestCoasting = 1.0;

/** One value for each half of a tangent vector. */
Vector6d perAxis(double translation, double rotation)
{
    Vector6d out;
    out << Eigen::Vector3d::Constant(translation), Eigen::Vector3d::Constant(rotation);
    return out;
}
}  // namespace

void MotionModel::TParams::check() const
{
    checkRange("decay", decay, 0, 1);
    checkRange("velocityRandomWalk", velocityRandomWalk, 1e-4, 100);
    checkRange("angularVelocityRandomWalk", angularVelocityRandomWalk, 1e-4, 100);
    checkRange("timeConstant", timeConstant, 0.01, 1000);
    checkRange("sigmaAcceleration", sigmaAcceleration, 0.01, 1000);
    checkRange("sigmaAngularAcceleration", sigmaAngularAcceleration, 0.01, 1e4);
}

MotionModel::MotionModel(const TParams& params) : params_(params)
{
    params_.check();
    reset();
}

MotionGaussian MotionModel::predict(double dt) const
{
    Matrix12d ofVelocity = Matrix12d::Zero();
    ofVelocity.bottomRightCorner<6, 6>() = velocityCov();
    return predictFrom(ofVelocity, std::min(dt, kLongestStep));
}

MotionGaussian MotionModel::predictFromEstimate(double dt) const
{
    return predictFrom(cov_, std::min(dt, kLongestStep));
}

Matrix12d MotionModel::processNoise(double dt) const
{
    return predictFrom(cov_ - measuredCov_, std::min(dt, kLongestStep)).cov;
}

/** \param cov of [pose; velocity] at the start */
MotionGaussian MotionModel::predictFrom(const Matrix12d& cov, double t) const
{
    Matrix12d transition = Matrix12d::Identity();
    transition.topRightCorner<6, 6>() = t * Matrix6d::Identity();
    const Matrix6d Q = density_.asDiagonal();
    Matrix12d noise;
    noise << t * t * t / 3 * Q, t * t / 2 * Q, t * t / 2 * Q, t * Q;
    return {{se3Exp(velocity_ * t), velocity_}, propagate(transition, cov) + noise};
}

Matrix6d MotionModel::unforeseen(double dt) const
{
    return predictFrom(Matrix12d::Zero(), std::min(dt, kLongestStep)).pose().cov + jerk(dt);
}

Matrix6d MotionModel::jerk(double dt) const
{
    const double t = std::min(dt, kLongestStep);
    return sudden().cwiseAbs2().asDiagonal() * std::pow(t, 4);
}

void MotionModel::follow(const Eigen::Isometry3d& T_prev_cur, double dt)
{
    velocity_ = se3Log(T_prev_cur) / std::min(dt, kLongestStep);
    cov_.setZero();
    cov_.bottomRightCorner<6, 6>() = (dt * density_).cwiseMin(1.0).asDiagonal();
    measuredCov_.setZero();
    coasting_ = 0;
    decayed_.setZero();
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
    Matrix126d covWithStart = cov_.rightCols<6>();
    covWithStart.topRows<6>() += t * cov_.bottomRightCorner<6, 6>();
    const Eigen::Matrix<double, 6, 12> smoother = solver.solve(covWithStart).transpose();
    Smoothed out;
    out.velocity = velocity_ + smoother * innovation;
    out.byNextMotion = smoother.leftCols<6>();
    out.byNextVelocity = smoother.rightCols<6>();
    out.byVelocity -= t * out.byNextMotion + out.byNextVelocity;

    // And with the change of velocity on the way.
    const Matrix6d Q = density_.asDiagonal();
    Matrix126d covWithChange;
    covWithChange << t * t / 2 * Q, t * Q;
    const Matrix126d gain = solver.solve(covWithChange);
    const Vector6d change = gain.transpose() * innovation;
    const Matrix6d cov = t * Q - gain.transpose() * (predicted.cov - measured.cov) * gain;
    adapt((change.cwiseAbs2() + cov.diagonal().cwiseMax(0)) / t, t);

    velocity_ = measured.mean.velocity;
    // What errs in the frame where the motion started errs where it ended.
    Matrix12d toEnd = Matrix12d::Identity();
    toEnd.topLeftCorner<6, 6>() = adjoint(measured.mean.T_prev_cur.inverse());
    cov_ = measuredCov_ = propagate(toEnd, measured.cov);
    coasting_ = 0;
    decayed_.setZero();
    const Increment increment{
        se3Log(measured.mean.T_prev_cur) / t, t, measured.cov.diagonal().head<6>()};
    learnAcceleration(increment);
    betweenIncrements(increment, out);
    atIncrementsEnd_.reset();
    if (increment_ && increment_->dt + t < 4 * kPush)
    {
        atIncrementsEnd_ = increment.velocity +
                           (increment.velocity - increment_->velocity) * t / (increment_->dt + t);
    }
    increment_ = increment;
    return out;
}

void MotionModel::learnAcceleration(const Increment& next)
{
    if (!increment_)
    {
        return;
    }
    // Over a step that is much shorter than another, noise of the pose looks like a jerk.
    if (next.dt > kUnequal * increment_->dt || increment_->dt > kUnequal * next.dt)
    {
        return;
    }
    const Vector6d a = 2 * (next.velocity - increment_->velocity) / (next.dt + increment_->dt);
    ++numAccelerations_;
    const double rate =
        std::max(1.0 / numAccelerations_, 1 - std::exp(-next.dt / params_.timeConstant));
    const Vector6d a2 = perAxis(a.head<3>().squaredNorm() / 3, a.tail<3>().squaredNorm() / 3);
    acceleration2_ += rate * (a2 - acceleration2_);
}

void MotionModel::followIncrements()
{
    if (atIncrementsEnd_)
    {
        velocity_ = 0.5 * (velocity_ + *atIncrementsEnd_);
    }
}

/** Velocity between the latest increment and this one, by constant acceleration. Weighed with the
 * smoothed one by their variances, unless the increments are too long for that or the camera
 * has jerked. */
void MotionModel::betweenIncrements(const Increment& next, Smoothed& smoothed) const
{
    if (!increment_ || increment_->dt + next.dt > 4 * kPush)
    {
        return;
    }
    const Increment& last = *increment_;
    const double dt = last.dt + next.dt;
    const Vector6d between = (next.dt * last.velocity + last.dt * next.velocity) / dt;
    const Vector6d apart = between - smoothed.velocity;
    if (apart.head<3>().norm() > next.dt * params_.sigmaAcceleration ||
        apart.tail<3>().norm() > next.dt * params_.sigmaAngularAcceleration)
    {
        return;
    }
    const double ratio = next.dt / last.dt;
    const Vector6d variances =
        (ratio * ratio * last.variance + next.variance / (ratio * ratio)) / (dt * dt);
    const Vector6d wander = Vector6d::Constant(kWander * kWander);
    const Vector6d noise = perAxis(variances.head<3>().mean(), variances.tail<3>().mean());
    const Vector6d share = wander.cwiseQuotient(wander + noise);
    smoothed.velocity += share.cwiseProduct(apart);
    const Matrix6d kept = (Vector6d::Ones() - share).asDiagonal();
    smoothed.byVelocity = (kept * smoothed.byVelocity).eval();
    smoothed.byNextVelocity = (kept * smoothed.byNextVelocity).eval();
    smoothed.byNextMotion = (kept * smoothed.byNextMotion).eval();
    smoothed.byNextMotion.diagonal() += share / (ratio * dt);
    smoothed.byPreviousMotion = (share * (ratio / dt)).asDiagonal();
}

/** One step of expectation maximisation, averaged over time. */
void MotionModel::adapt(const Vector6d& meanSquare, double dt)
{
    const double rate = 1 - std::exp(-dt / params_.timeConstant);
    const Vector6d target = perAxis(meanSquare.head<3>().mean(), meanSquare.tail<3>().mean());
    density_ = (density_ + rate * (target - density_)).cwiseMax(smallestDensity());
}

Vector6d MotionModel::sudden() const
{
    return perAxis(params_.sigmaAcceleration, params_.sigmaAngularAcceleration);
}

Vector6d MotionModel::smallestDensity() const
{
    return perAxis(params_.velocityRandomWalk, params_.angularVelocityRandomWalk).cwiseAbs2();
}

Vector6d MotionModel::coast(double dt)
{
    increment_.reset();
    atIncrementsEnd_.reset();
    // [P17, section Pose estimation]. What has decayed is uncertain by as much as it has decayed;
    // the rest is white acceleration.
    const Vector6d before = decayed_;
    const Vector6d decaying = (1 - std::pow(params_.decay, dt / kUsualStep)) * velocity_;
    velocity_ -= decaying;
    decayed_ += decaying;
    const double t = std::min(dt, kLongestCoasting - coasting_);
    coasting_ += t;
    const Vector6d gained = t * density_ + decayed_.cwiseAbs2() - before.cwiseAbs2();
    cov_.diagonal().tail<6>() += gained;
    return gained;
}

void MotionModel::startAtReference()
{
    for (Matrix12d* cov : {&cov_, &measuredCov_})
    {
        cov->topRows<6>().setZero();
        cov->leftCols<6>().setZero();
    }
}

void MotionModel::reset()
{
    velocity_.setZero();
    increment_.reset();
    atIncrementsEnd_.reset();
    coasting_ = 0;
    decayed_.setZero();
    const Vector6d velocity = kPush * sudden();
    cov_.setZero();
    cov_.bottomRightCorner<6, 6>() = velocity.cwiseAbs2().asDiagonal();
    density_ = perAxis(kFirstChange, kFirstTurn).cwiseAbs2().cwiseMax(smallestDensity());
    measuredCov_.setZero();
}
}  // namespace pointplane
