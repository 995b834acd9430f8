// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/MotionModel.h"

#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>

#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "matchers.h"
#include "monte_carlo.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr double kFrame = 1.0 / 30;

Vector6d velocity()
{
    Vector6d v;
    v << 0.3, -0.1, 0.2, 0.5, -0.4, 0.1;
    return v;
}

/** A motion that went on as before, measured well. */
MotionGaussian measuredMotion()
{
    MotionGaussian out;
    out.mean = {se3Exp(velocity() * kFrame), velocity()};
    out.cov.diagonal() << Vector6d::Constant(1e-8), Vector6d::Constant(1e-4);
    return out;
}

MotionModel moving()
{
    MotionModel model({});
    model.update(measuredMotion(), kFrame);
    return model;
}
/** What becomes of a velocity's covariance. */
Matrix12d carried(const MotionModel& model, const Matrix6d& velocityCov, double dt)
{
    const DecayedVelocities after = model.after(dt);
    Matrix126d F;
    F << Matrix6d(after.reach().asDiagonal()), Matrix6d(after.kept().asDiagonal());
    return F * velocityCov * F.transpose();
}

/** For so long the camera keeps its velocity [s], as learnt. */
double timeConstant(const MotionModel& model, int axis)
{
    return -kFrame / std::log(model.after(kFrame).kept()[axis]);
}
}  // namespace

TEST(MotionModel, knowsNothingAtTheStart)
{
    const MotionModel model({});
    const MotionGaussian p = model.predict(kFrame);
    EXPECT_TRUE(p.mean.T_prev_cur.isApprox(Eigen::Isometry3d::Identity()));
    EXPECT_TRUE(isPositiveDefinite(p.cov));
    // The speed that 5 m/s^2 and 15 rad/s^2 make in 0.05 s, and 4.5 times the least random walk.
    const auto sigma = [](double speed, double walk)
    {
        const double density = std::pow(4.5 * walk, 2);
        const DecayedVelocity after = decayedVelocity(kFrame, 2 * speed * speed / density);
        return std::sqrt(std::pow(after.reach * speed, 2) + after.pose * density);
    };
    EXPECT_NEAR(std::sqrt(p.cov(0, 0)), sigma(0.25, 0.1), 1e-12);
    EXPECT_NEAR(std::sqrt(p.cov(3, 3)), sigma(0.75, 0.5), 1e-12);
}

/** The rest comes from that of the velocity as it was measured. */
TEST(MotionModel, processNoiseIsWhatTimeAdds)
{
    MotionModel model = moving();
    const Matrix6d P = measuredMotion().cov.bottomRightCorner<6, 6>();
    const auto expectIsAdded = [&](double dt)
    {
        const Matrix12d N = model.predictFromEstimate(dt).cov - carried(model, P, dt);
        const Matrix12d noise = model.processNoise(dt, Matrix6d::Zero());
        EXPECT_THAT(
            Matrix126d(noise.leftCols<6>()), test::IsMatrixNear(Matrix126d(N.leftCols<6>()), 1e-9));
    };
    model.startAtReference();
    expectIsAdded(kFrame);
    model.reset();  // nothing is left of what was measured
    EXPECT_EQ(model.processNoise(kFrame, Matrix6d::Zero())(0, 0), model.predict(kFrame).cov(0, 0));
}

/** An acceleration that lasts for t_a, by numerical integration: how uncertain the velocity is once
 * the pose is known. The model says so of white acceleration with the same change of velocity, and
 * reduces it, exactly so for short steps only. */
TEST(MotionModel, processNoiseOfTheVelocityIsThatOfAnAccelerationThatLasts)
{
    constexpr int kParts = 200;
    MotionModel model = moving();
    model.startAtReference();
    for (const double dt : {kFrame / 4, kFrame, 2 * kFrame})
    {
        Eigen::Matrix2d ofMotion = Eigen::Matrix2d::Zero();  // and of the velocity
        for (int i = 0; i < kParts * kParts; ++i)
        {
            const double s = (i / kParts + 0.5) * dt / kParts, t = (i % kParts + 0.5) * dt / kParts;
            const double alike = std::exp(-std::abs(s - t) / MotionParams().accelerationTime);
            ofMotion += alike * Eigen::Vector2d(dt - s, 1) * Eigen::Vector2d(dt - t, 1).transpose();
        }
        const double white = ofMotion(1, 1) / 4;
        const double left = ofMotion(1, 1) - std::pow(ofMotion(0, 1), 2) / ofMotion(0, 0);

        const Matrix12d noise = model.processNoise(dt, Matrix6d::Zero());
        const double told = noise(0, 6) * noise(0, 6) / noise(0, 0);
        const DecayedVelocity after = model.after(dt).translation;
        const double rest =
            model.density()[0] * (after.velocity - std::pow(after.together, 2) / after.pose);
        EXPECT_NEAR((noise(6, 6) - told) / rest, left / white, 0.15 * left / white) << dt;
    }
}

/** What no feature shows is predicted, as in a frame that is predicted as a whole. */
TEST(MotionModel, processNoiseOfAnUnmeasuredDirectionIsThatOfAPredictedFrame)
{
    MotionModel model = moving();
    model.startAtReference();
    Vector6d alongX = Vector6d::Zero();
    alongX[0] = 1;
    const Matrix12d none = model.processNoise(kFrame, Matrix6d::Zero());
    const Matrix12d x = model.processNoise(kFrame, alongX.asDiagonal());
    const Matrix12d all = model.processNoise(kFrame, Matrix6d::Identity());
    EXPECT_THAT(all, test::IsMatrixNear(model.unforeseen(kFrame), 1e-12));
    EXPECT_DOUBLE_EQ(x(0, 0), all(0, 0));
    EXPECT_DOUBLE_EQ(x(6, 6), all(6, 6));
    EXPECT_GT(x(0, 0), none(0, 0));
    EXPECT_GT(x(6, 6), none(6, 6));
    EXPECT_DOUBLE_EQ(x(1, 1), none(1, 1));
    EXPECT_DOUBLE_EQ(x(7, 7), none(7, 7));
}

TEST(MotionModel, theVelocityDecays)
{
    const MotionModel model = moving();
    for (const double dt : {kFrame, 0.1, 1.0})
    {
        const MotionGaussian p = model.predict(dt);
        const DecayedVelocities after = model.after(dt);
        const Vector6d way = after.reach().cwiseProduct(velocity());
        EXPECT_THAT(p.mean.T_prev_cur, test::IsNearPose(se3Exp(way), 1e-12, 1e-12));
        EXPECT_THAT(
            p.mean.velocity,
            test::IsMatrixNear(Vector6d(after.kept().cwiseProduct(velocity())), 1e-12));
    }
    EXPECT_GT(model.after(kFrame).kept().minCoeff(), 0.8);
    EXPECT_LT(model.after(1).kept().maxCoeff(), 0.3);
}

/** Against many walks: the velocity's own uncertainty, and white acceleration on the way, after the
 * frame and after a time without measurements. */
TEST(MotionModel, uncertaintyIsThatOfAWhiteAcceleration)
{
    for (const double coasted : {0.0, 0.1})
    {
        MotionModel model = moving();
        model.coast(coasted);
        const double dt = 0.05, step = dt / 100;
        const double q = model.density()[0], tau = timeConstant(model, 0);
        test::GaussianSampler sampler(5);
        Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
        constexpr int kWalks = 4000;
        for (int i = 0; i < kWalks; ++i)
        {
            double v = 0.01 * sampler.normal(), x = 0;
            for (double t = -coasted; t < dt - step / 2; t += step)
            {
                x += t > -step / 2 ? v * step : 0;
                v += -v / tau * step + std::sqrt(q * step) * sampler.normal();
            }
            const Eigen::Vector2d e(x, v);
            sum += e * e.transpose() / kWalks;
        }
        const MotionGaussian p = model.predict(dt);
        // Of 4000 squares, three standard deviations are 7 %.
        EXPECT_NEAR(p.cov(0, 0), sum(0, 0), 0.08 * sum(0, 0)) << coasted;
        EXPECT_NEAR(p.cov(0, 6), sum(0, 1), 0.08 * sum(0, 1)) << coasted;
        EXPECT_NEAR(p.cov(6, 6), sum(1, 1), 0.08 * sum(1, 1)) << coasted;
        EXPECT_TRUE(isPositiveDefinite(p.cov));
    }
}

/** Against many walks: an estimate that errs in pose and velocity, and the way on from there. */
TEST(MotionModel, errorsOfTheEstimateStayInTheNextMotion)
{
    MotionGaussian estimate = measuredMotion();
    estimate.mean.T_prev_cur.linear() =
        Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    Matrix12d L = Matrix12d::Zero();
    L.diagonal() << Vector6d::Constant(0.001), Vector6d::Constant(0.02);
    L(1, 0) = 0.0005;
    L(6, 0) = 0.03;  // an error of the pose, and of the velocity that follows from it
    estimate.cov = L * L.transpose();
    MotionModel model({});
    model.update(estimate, kFrame);
    const DecayedVelocities after = model.after(kFrame);
    const Motion predicted = model.predictFromEstimate(kFrame).mean;
    Matrix12d sum = Matrix12d::Zero();
    test::GaussianSampler sampler(6);
    constexpr int kWalks = 20000;
    for (int i = 0; i < kWalks; ++i)
    {
        const Vector12d e = L * sampler.vector<12>();
        const Vector6d trueVelocity = estimate.mean.velocity + e.tail<6>();
        const Eigen::Isometry3d trueNext = se3Exp(e.head<6>()) * estimate.mean.T_prev_cur *
                                           se3Exp(after.reach().cwiseProduct(trueVelocity));
        Vector12d next;
        next << leftError(estimate.mean.T_prev_cur.inverse() * trueNext, predicted.T_prev_cur),
            after.kept().cwiseProduct(trueVelocity) - predicted.velocity;
        sum += next * next.transpose() / kWalks;
    }
    const Matrix6d P = estimate.cov.bottomRightCorner<6, 6>();
    const Matrix12d noise = model.predict(kFrame).cov - carried(model, P, kFrame);
    const Matrix12d added = model.predictFromEstimate(kFrame).cov - noise;
    EXPECT_THAT(added, test::IsMatrixNear(sum, 0.03 * sum.cwiseAbs().maxCoeff()));
    EXPECT_NEAR(added(1, 1), sum(1, 1), 0.05 * sum(1, 1));
    EXPECT_NEAR(added(1, 6), sum(1, 6), 0.05 * std::abs(sum(1, 6)));

    // Seen from the true pose, there is only the error of the velocity.
    model.startAtReference();
    EXPECT_EQ(model.predictFromEstimate(kFrame).cov, model.predict(kFrame).cov);
}

/** Where poses are known well, the velocity between two increments is theirs: of constant
 * acceleration, whatever rows of the shutter say. */
TEST(MotionModel, theVelocityBeforeLiesBetweenTheIncrements)
{
    MotionModel model = moving();
    MotionGaussian measured = measuredMotion();
    measured.mean.T_prev_cur = se3Exp(1.2 * velocity() * kFrame / 2);  // half the time, faster
    measured.mean.velocity += 0.1 * velocity();
    measured.cov.topLeftCorner<6, 6>() = 1e-14 * Matrix6d::Identity();
    MotionModel surprised = model;
    // (dt1 v2 + dt2 v1) / (dt1 + dt2) of v1 over dt1 = 1 and v2 = 1.2 v1 over dt2 = 1/2.
    const Vector6d between = model.update(measured, kFrame / 2).velocity;
    EXPECT_TRUE(between.isApprox(1.7 / 1.5 * velocity(), 0.01)) << between.transpose();
    // Where they are not, it is the smoother's.
    measured.cov.topLeftCorner<6, 6>() = Matrix6d::Identity();
    const Vector6d smoothed = surprised.update(measured, kFrame / 2).velocity;
    EXPECT_FALSE(smoothed.isApprox(between, 0.02)) << smoothed.transpose();
}

/** Half of the extrapolation, after two increments; nothing after one. */
TEST(MotionModel, followsIncrementsHalfway)
{
    MotionModel model = moving();
    model.followIncrements();
    EXPECT_EQ(model.velocity(), velocity());
    MotionGaussian measured = measuredMotion();
    measured.mean.T_prev_cur = se3Exp(1.2 * velocity() * kFrame);
    measured.mean.velocity.setZero();
    model.update(measured, kFrame);
    model.followIncrements();
    EXPECT_TRUE(model.velocity().isApprox(0.5 * 1.3 * velocity(), 1e-9));
    model.coast(kFrame);
    const Vector6d coasting = model.velocity();
    model.followIncrements();
    EXPECT_EQ(model.velocity(), coasting);
}

/** Rauch-Tung-Striebel against the joint Gaussian of the velocity before and the motion. */
TEST(MotionModel, theVelocityBeforeIsSmoothed)
{
    MotionParams params;
    params.timeConstant = 1000;  // so uncertain a motion must not tell how the camera moves
    MotionModel model(params);
    MotionGaussian uncertain = measuredMotion();  // its increment tells nothing of the velocity
    uncertain.cov.topLeftCorner<6, 6>() = Matrix6d::Identity();
    model.update(uncertain, kFrame);
    constexpr double kStep = 0.2;  // too long for a velocity between two increments
    const MotionGaussian predicted = model.predictFromEstimate(kStep);
    MotionGaussian measured = predicted;
    measured.mean.velocity[0] += 0.03;
    measured.cov *= 0.1;
    // cov(v_before, v_after) = kept P; cov(v_before, pose) = reach P, with P = 1e-4.
    const DecayedVelocity after = model.after(kStep).translation;
    Eigen::Matrix2d S;
    S << predicted.cov(0, 0), predicted.cov(0, 6), predicted.cov(6, 0), predicted.cov(6, 6);
    const Eigen::Vector2d gain =
        S.inverse() * Eigen::Vector2d(after.reach * 1e-4, after.kept * 1e-4);
    const Vector6d smoothed = model.update(measured, kStep).velocity;
    EXPECT_NEAR(smoothed[0] - velocity()[0], gain[1] * 0.03, 1e-9);
    EXPECT_NEAR(smoothed[1], velocity()[1], 1e-9);
}

/** Against finite differences in all that the velocity before was made from. */
TEST(MotionModel, howTheVelocityBeforeErrs)
{
    MotionParams params;
    params.timeConstant = 1000;  // what is learnt on the way must not change with the differences
    const auto measured = [](double scale)
    {
        MotionGaussian out = measuredMotion();
        out.mean.T_prev_cur = se3Exp(scale * velocity() * kFrame);
        out.cov.topLeftCorner<6, 6>() = 1e-7 * Matrix6d::Identity();
        return out;
    };
    const double next_s = 0.6 * kFrame;
    struct Changes
    {
        Vector6d velocity{Vector6d::Zero()}, nextVelocity{Vector6d::Zero()};
        Vector6d motion{Vector6d::Zero()}, nextMotion{Vector6d::Zero()};
    };
    const auto smoothed = [&](const Changes& by)
    {
        MotionGaussian previous = measured(1), next = measured(0.65);
        previous.mean.velocity += by.velocity;
        next.mean.velocity += by.nextVelocity;
        previous.mean.T_prev_cur = se3Exp(by.motion) * previous.mean.T_prev_cur;
        next.mean.T_prev_cur = se3Exp(by.nextMotion) * next.mean.T_prev_cur;
        MotionModel model(params);
        model.update(previous, kFrame);
        return model.update(next, next_s);
    };
    const MotionModel::Smoothed out = smoothed({});
    const auto expectSlope = [&](Vector6d Changes::*part, const Matrix6d& slope, double step)
    {
        for (int axis = 0; axis < 6; ++axis)
        {
            Changes by;
            by.*part = step * Vector6d::Unit(axis);
            const Vector6d difference = (smoothed(by).velocity - out.velocity) / step;
            EXPECT_THAT(
                difference, test::IsMatrixNear(Vector6d(slope.col(axis)), 0.02 * slope.norm()))
                << axis;
        }
        EXPECT_GT(slope.norm(), 0.01);
    };
    expectSlope(&Changes::velocity, out.byVelocity, 1e-4);
    expectSlope(&Changes::nextVelocity, out.byNextVelocity, 1e-4);
    expectSlope(&Changes::motion, out.byPreviousMotion, 1e-6);
    expectSlope(&Changes::nextMotion, out.byNextMotion, 1e-6);
}

/** Cameras whose velocity decays over a second and is pushed by 0.8 m/s/sqrt(s) and
 * 2 rad/s/sqrt(s), well measured. */
TEST(MotionModel, followsHowTheCameraMoves)
{
    constexpr unsigned kCameras = 20;
    const DecayedVelocity after = decayedVelocity(kFrame, 1);
    Vector6d walk, density = Vector6d::Zero();
    walk << Eigen::Vector3d::Constant(0.8), Eigen::Vector3d::Constant(2);
    for (unsigned seed = 0; seed < kCameras; ++seed)
    {
        test::GaussianSampler sampler(seed);
        MotionModel model({});
        Vector6d v = Vector6d::Zero();
        for (int i = 0; i < 300; ++i)
        {
            const Vector6d next =
                after.kept * v + std::sqrt(after.velocity) * walk.cwiseProduct(sampler.vector<6>());
            MotionGaussian measured;
            measured.mean = {se3Exp(kFrame * 0.5 * (v + next)), next};
            measured.cov.diagonal() << Vector6d::Constant(1e-10), Vector6d::Constant(1e-6);
            model.update(measured, kFrame);
            v = next;
        }
        density += model.density() / kCameras;
    }
    // Each is a mean over 60 frames and three axes: three standard deviations of all are 7 %. The
    // decay is learnt from as little, which adds some.
    EXPECT_NEAR(density[0], 0.8 * 0.8, 0.1 * 0.8 * 0.8);
    EXPECT_NEAR(density[3], 2 * 2, 0.1 * 2 * 2);
}

/** What frames show of the velocity is twice as uncertain as what it gains from frame to frame. */
TEST(MotionModel, noiseIsNotTakenForMotion)
{
    MotionParams params;
    params.timeConstant = 20;
    MotionModel model(params);
    constexpr double kDensity = 0.15;
    const DecayedVelocity after = decayedVelocity(kFrame, 0.3);
    const double gained = std::sqrt(kDensity * after.velocity);
    Vector12d sigma;
    sigma << Vector6d::Constant(0.5 * gained * kFrame), Vector6d::Constant(2 * gained);
    const Matrix12d R = sigma.cwiseAbs2().asDiagonal();
    test::GaussianSampler sampler(8);
    Vector6d v = Vector6d::Zero();
    double density = 0;
    constexpr int kFrames = 4500, kFirst = 1500;
    for (int i = 0; i < kFrames; ++i)
    {
        const Vector6d next = after.kept * v + gained * sampler.vector<6>();
        Vector12d seen;
        seen << 0.5 * kFrame * (v + next), next;
        seen += sigma.cwiseProduct(sampler.vector<12>());
        v = next;

        // An estimate is made from the prediction and what is seen.
        const MotionGaussian predicted = model.predictFromEstimate(kFrame);
        Vector12d innovation;
        innovation << seen.head<6>() - se3Log(predicted.mean.T_prev_cur),
            seen.tail<6>() - predicted.mean.velocity;
        const Matrix12d gain = predicted.cov * (predicted.cov + R).inverse();
        const Vector12d correction = gain * innovation;
        MotionGaussian estimate = predicted;
        estimate.mean.T_prev_cur = se3Exp(correction.head<6>()) * predicted.mean.T_prev_cur;
        estimate.mean.velocity += correction.tail<6>();
        estimate.cov -= gain * predicted.cov;
        model.update(estimate, kFrame);
        model.startAtReference();
        density += i >= kFirst ? model.density()[0] / (kFrames - kFirst) : 0;
    }
    // 9000 squares, of which the frames show half: three standard deviations are 10 %. A few per
    // cent of the first guess are left.
    EXPECT_NEAR(density, kDensity, 0.15 * kDensity);
}

/** The square of the estimated velocity, and its variance. */
TEST(MotionModel, howFastTheCameraMayBeIsLearnt)
{
    MotionParams params;
    params.timeConstant = 0.01;  // the latest frames count
    MotionModel model(params);
    MotionGaussian measured;
    measured.mean.velocity[0] = 0.9;
    measured.cov.diagonal() << Vector6d::Constant(1e-10), Vector6d::Constant(0.5 * 0.5);
    for (int i = 0; i < 30; ++i)
    {
        model.update(measured, kFrame);
    }
    model.reset();
    EXPECT_NEAR(model.predict(1e-9).cov(6, 6), 0.9 * 0.9 / 3 + 0.5 * 0.5, 1e-6) << "of an axis";
}

TEST(MotionModel, accelerationIsLearnt)
{
    // A camera that swings: x = A sin(w t), of mean square acceleration (A w^2)^2 / 2, on one axis.
    const double A = 0.05, w = 6;
    MotionModel model({});
    EXPECT_TRUE(model.acceleration2().isZero(0));
    for (int i = 0; i < 300; ++i)
    {
        MotionGaussian measured;
        measured.mean.T_prev_cur.translation().x() =
            A * (std::sin(w * (i + 1) * kFrame) - std::sin(w * i * kFrame));
        measured.mean.velocity[0] = A * w * std::cos(w * (i + 1) * kFrame);
        measured.cov.diagonal().setConstant(1e-10);
        model.update(measured, kFrame);
    }
    const double expected = std::pow(A * w * w, 2) / 2 / 3;
    EXPECT_NEAR(model.acceleration2()[0], expected, 0.35 * expected);
    EXPECT_NEAR(model.acceleration2()[4], 0, 1e-9);
}

/** A hand keeps its velocity for half a second, a robot for longer; a robot that turns to and fro
 * keeps that of its translation only. */
TEST(MotionModel, forHowLongTheVelocityIsKeptIsLearnt)
{
    const auto learnt = [](double translation, double rotation)
    {
        test::GaussianSampler sampler(7);
        MotionModel model({});
        Vector6d tau, v;
        tau << Eigen::Vector3d::Constant(translation), Eigen::Vector3d::Constant(rotation);
        v << Eigen::Vector3d::Constant(0.4), Eigen::Vector3d::Constant(0.7);
        const Vector6d usual2 = v.cwiseAbs2();
        Eigen::Vector2d sum = Eigen::Vector2d::Zero();
        constexpr int kFrames = 600;
        for (int i = 0; i < kFrames; ++i)
        {
            const Eigen::Array<double, 6, 1> kept = (-kFrame / tau.array()).exp();
            const Eigen::Array<double, 6, 1> noise = (usual2.array() * (1 - kept * kept)).sqrt();
            const Vector6d next = kept * v.array() + noise * sampler.vector<6>().array();
            MotionGaussian measured;
            measured.mean = {se3Exp(0.5 * kFrame * (v + next)), next};
            measured.cov.diagonal() << Vector6d::Constant(1e-10), Vector6d::Constant(1e-6);
            model.update(measured, kFrame);
            v = next;
            sum += Eigen::Vector2d(timeConstant(model, 0), timeConstant(model, 3)) / kFrames;
        }
        return sum;
    };
    const Eigen::Vector2d hand = learnt(0.5, 0.3), robot = learnt(5, 0.3);
    EXPECT_NEAR(hand[0], 0.5, 0.2);
    EXPECT_NEAR(hand[1], 0.3, 0.12);
    EXPECT_GT(robot[0], 2.5);
    EXPECT_NEAR(robot[1], 0.3, 0.12);
}

/** Poses that jump to and fro while the rows of the shutter tell no velocity, for a minute. */
TEST(MotionModel, noVelocityIsLostFasterThanItIsGained)
{
    MotionModel model({});
    for (int i = 0; i < 1800; ++i)
    {
        MotionGaussian measured;
        measured.mean.T_prev_cur.translation().x() = i % 2 == 0 ? 1e3 : -1e3;
        measured.cov.diagonal().setConstant(1e-12);
        model.update(measured, kFrame);
        ASSERT_TRUE(model.density().allFinite()) << i;
        ASSERT_TRUE(model.predict(1).cov.allFinite()) << i;
    }
    EXPECT_GE(timeConstant(model, 0), 0.999 * MotionParams().accelerationTime);
    EXPECT_GE(timeConstant(model, 3), 0.999 * MotionParams().accelerationTime);
}

TEST(MotionModel, leastRandomWalkIsKept)
{
    MotionModel model({});
    for (int i = 0; i < 300; ++i)
    {
        model.update(measuredMotion(), kFrame);
    }
    const MotionParams params;
    EXPECT_NEAR(std::sqrt(model.density()[0]), params.velocityRandomWalk, 1e-9);
    EXPECT_NEAR(std::sqrt(model.density()[3]), params.angularVelocityRandomWalk, 1e-9);
}

/** It lasts for 0.05 s; what it has made of the velocity stays. */
TEST(MotionModel, suddenAccelerationByHand)
{
    MotionParams params;
    params.sigmaAcceleration = 2;
    params.sigmaAngularAcceleration = 6;
    const Matrix6d cov = MotionModel(params).bySuddenAcceleration(0.01);
    EXPECT_NEAR(std::sqrt(cov(1, 1)), 2 * 0.01 * 0.01, 1e-12);
    EXPECT_NEAR(std::sqrt(cov(4, 4)), 6 * 0.01 * 0.01, 1e-12);
    EXPECT_TRUE(cov.isDiagonal());
    EXPECT_NEAR(
        std::sqrt(MotionModel(params).bySuddenAcceleration(0.5)(4, 4)), 6 * 0.05 * 0.5, 1e-12);
}

TEST(MotionModel, followsAnIncrementAlone)
{
    MotionModel model({});
    model.follow(se3Exp(velocity() * kFrame), kFrame);
    EXPECT_THAT(model.velocity(), test::IsMatrixNear(velocity(), 1e-12));
    EXPECT_TRUE(isPositiveDefinite(model.predict(kFrame).cov));
}

TEST(MotionModel, velocityDecaysAndUncertaintyGrowsWhileCoasting)
{
    MotionModel model = moving();
    double previousSigma = 0;
    const Vector6d kept = model.after(kFrame).kept();
    for (int i = 1; i <= 10; ++i)
    {
        model.coast(kFrame);
        EXPECT_THAT(
            model.velocity(),
            test::IsMatrixNear(Vector6d(kept.array().pow(i) * velocity().array()), 1e-12));
        const double sigma = std::sqrt(model.predict(kFrame).cov(0, 0));
        EXPECT_GT(sigma, previousSigma);
        previousSigma = sigma;
    }
    model.update(measuredMotion(), kFrame);
    EXPECT_LT(std::sqrt(model.predict(kFrame).cov(0, 0)), previousSigma / 3);
}

TEST(MotionModel, decayDoesNotDependOnTheFrameRate)
{
    MotionModel slow = moving(), fast = moving();
    slow.coast(2 * kFrame);
    fast.coast(kFrame);
    fast.coast(kFrame);
    EXPECT_THAT(slow.velocity(), test::IsMatrixNear(fast.velocity(), 1e-12));
}

TEST(MotionModel, coastingForHoursStaysFinite)
{
    MotionModel model = moving();
    for (int i = 0; i < 200000; ++i)
    {
        model.coast(kFrame);
    }
    model.coast(1e5);
    EXPECT_LT(model.velocity().norm(), 1e-6);
    EXPECT_TRUE(isPositiveDefinite(model.predict(kFrame).cov));
    EXPECT_LT(std::sqrt(model.predict(kFrame).cov(0, 0)), 1);
}

/** Stamps of a damaged file are any numbers. */
TEST(MotionModel, anyGapIsFinite)
{
    for (const double dt : {1e-9, 1e6, 1e15, 1e300})
    {
        MotionModel model = moving();
        EXPECT_TRUE(model.predict(dt).cov.allFinite()) << dt;
        EXPECT_TRUE(model.predict(dt).mean.T_prev_cur.matrix().allFinite()) << dt;
        EXPECT_TRUE(model.bySuddenAcceleration(dt).allFinite()) << dt;
        model.coast(dt);
        EXPECT_TRUE(model.predict(kFrame).cov.allFinite()) << dt;
    }
}

TEST(MotionModel, resetForgetsTheVelocity)
{
    MotionModel model = moving();
    model.coast(0.1);
    model.reset();
    EXPECT_TRUE(model.predict(kFrame).mean.velocity.isZero(0));
    MotionModel none({});
    none.reset();
    EXPECT_EQ(none.predict(kFrame).cov, MotionModel({}).predict(kFrame).cov);
}

/** After a long gap: a camera that was at 1 m/s may still be. */
TEST(MotionModel, unknownVelocitiesAreNotMoreCertainThanKnownOnes)
{
    MotionModel model({});
    const double speed = 1;
    MotionGaussian motion;
    motion.mean.T_prev_cur = Eigen::Translation3d(speed * kFrame, 0, 0);
    motion.mean.velocity[0] = speed;
    motion.cov = 1e-8 * Matrix12d::Identity();
    for (int k = 0; k < 90; ++k)
    {
        (void)model.update(motion, kFrame);
    }
    model.reset();
    for (const double gap : {0.1, 1.0, 3.0})
    {
        const MotionGaussian predicted = model.predict(gap);
        const double sigma = std::sqrt(predicted.cov(0, 0));
        EXPECT_LT(speed * gap, 2.5 * sigma) << gap;
    }
}

TEST(MotionModel, refusesParametersOutOfRange)
{
    const auto refused = [](auto change)
    {
        MotionParams params;
        change(params);
        EXPECT_THROW(MotionModel{params}, std::invalid_argument);
    };
    refused([](auto& p) { p.accelerationTime = 0; });
    refused([](auto& p) { p.velocityRandomWalk = 0; });
    refused([](auto& p) { p.angularVelocityRandomWalk = -1; });
    refused([](auto& p) { p.timeConstant = 0; });
    refused([](auto& p) { p.sigmaAcceleration = 0; });
    refused([](auto& p) { p.sigmaAngularAcceleration = -1; });
}
}  // namespace pointplane
