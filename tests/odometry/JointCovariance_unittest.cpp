// SPDX-License-Identifier: BSD-3-Clause
#include "uncertainty/JointCovariance.h"

#include <pointplane/core/PoseGaussian.h>
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/odometry/uncertainty/CovarianceParams.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <vector>

#include "linear_algebra.h"
#include "matchers.h"
#include "monte_carlo.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using PatchVector = Eigen::Matrix<double, kNumPatches, 1>;

/** A frame later, with a velocity that stays. */
const DecayedVelocities kFrame{{1.0 / 30, 1, 0, 0, 0}, {1.0 / 30, 1, 0, 0, 0}};

const Eigen::Isometry3d kAtRest = Eigen::Isometry3d::Identity();

/** A motion that errs for itself. */
JointCovariance::Prediction independent(double variance)
{
    JointCovariance::Prediction out;
    out.noise.topLeftCorner<6, 6>() = variance * Matrix6d::Identity();
    return out;
}

/** Of the pose alone. */
Matrix12d ofPose(const Matrix6d& cov)
{
    Matrix12d out = Matrix12d::Zero();
    out.topLeftCorner<6, 6>() = cov;
    return out;
}

/** A frame that is measured against one reference only, by features of unit variance. */
JointCovariance::Measurement against(int reference)
{
    JointCovariance::Measurement out;
    out.factors.references[reference] = ofPose(Matrix6d::Identity());
    out.factors.referencePoints = out.factors.references;
    out.noise = ofPose(Matrix6d::Identity());
    return out;
}

JointCovariance started(int history = 30)
{
    JointCovariance out(history);
    out.start(1, Matrix6d::Zero());
    return out;
}

/** Of what was drawn from what was propagated. */
double difference(const std::vector<Vector6d>& errors, const Matrix6d& expected)
{
    return test::whitenedDifference(test::sampleCovariance(errors), expected);
}

auto isTimesIdentity(double factor)
{
    return test::IsMatrixNear(Matrix6d(factor * Matrix6d::Identity()), 1e-9);
}
}  // namespace

/** Each frame has its own error: two frames, however far apart, differ by that of both. */
TEST(JointCovariance, errorsAgainstOneReferenceDoNotAddUp)
{
    JointCovariance joint = started();
    for (int frame = 2; frame <= 20; ++frame)
    {
        joint.measure(kAtRest, kFrame, against(1));
        joint.keep({1});
        EXPECT_THAT(joint.latest(), isTimesIdentity(1));
        EXPECT_THAT(joint.relative(1, kAtRest), isTimesIdentity(1));
        if (frame > 2)
        {
            EXPECT_THAT(joint.relative(frame - 1, kAtRest), isTimesIdentity(2));
            EXPECT_THAT(joint.relative(2, kAtRest), isTimesIdentity(2));
        }
    }
}

/** As a reference, a frame errs as its pose does. */
TEST(JointCovariance, errorsFromFrameToFrameAddUp)
{
    JointCovariance joint = started();
    for (int frame = 2; frame <= 12; ++frame)
    {
        joint.measure(kAtRest, kFrame, against(frame - 1));
        joint.keep({frame});
    }
    for (int n = 1; n <= 10; ++n)
    {
        EXPECT_THAT(joint.relative(12 - n, kAtRest), isTimesIdentity(n)) << n;
    }
}

/** How alike frame 1, the only reference, and the new one see the scene. */
void setAlike(JointCovariance::Measurement& measurement, double correlation)
{
    measurement.views.frames = {1};
    measurement.views.ofPoints.resize(2, 2);
    measurement.views.ofPoints << 1, correlation, correlation, 1;
    measurement.factors.referencePoints = measurement.factors.references;
}

/** Frames that see the scene alike err alike, and those of other views each for itself. */
TEST(JointCovariance, framesErrByTheirViews)
{
    for (const double correlation : {0.0, 0.75, 1.0})
    {
        JointCovariance joint = started();
        JointCovariance::Measurement measurement = against(1);
        measurement.views.pointSigma.setConstant(2);
        setAlike(measurement, correlation);
        joint.measure(kAtRest, kFrame, measurement);
        EXPECT_THAT(joint.latest(), isTimesIdentity(1 + 4 * 2 * (1 - correlation)));
    }
}

/** Points, planes and patches see the same views, each in their own way. */
TEST(JointCovariance, pointsPlanesAndPatchesAreAlikeByThemselves)
{
    const auto alike = [](double correlation)
    { return (Eigen::Matrix2d() << 1, correlation, correlation, 1).finished(); };
    JointCovariance joint = started();
    JointCovariance::Measurement measurement = against(1);
    measurement.views = {{1}, alike(0.75), alike(0.5), alike(0.25)};
    measurement.views.pointSigma.setConstant(2);
    measurement.views.planeRoot = 3 * Matrix6d::Identity();
    measurement.views.patchSigma = 0.5;
    measurement.factors.patches(0, 3) = 2;
    measurement.factors.referencePatches[1] = -measurement.factors.patches;
    joint.measure(kAtRest, kFrame, measurement);
    Vector6d expected = Vector6d::Constant(1 + 2 * 4 * 0.25 + 2 * 9 * 0.5);
    expected[0] += 2 * 4 * 0.25 * 0.75;
    EXPECT_THAT(joint.latest(), test::IsMatrixNear(Matrix6d(expected.asDiagonal()), 1e-9));
}

/** There and back: what the frame on the way erred by is not added up. */
TEST(JointCovariance, backAtAReferencesViewNothingIsLeftOfItsError)
{
    JointCovariance joint = started();
    JointCovariance::Measurement measurement = against(1);
    measurement.views.pointSigma.setConstant(2);
    setAlike(measurement, 0.5);
    joint.measure(kAtRest, kFrame, measurement);
    joint.keep({1});
    EXPECT_THAT(joint.latest(), isTimesIdentity(1 + 4));
    measurement.views.ofPoints.setOnes();
    measurement.factors.referencePoints = measurement.factors.references;
    joint.measure(kAtRest, kFrame, measurement);
    EXPECT_THAT(joint.latest(), isTimesIdentity(1));
    EXPECT_THAT(joint.relative(2, kAtRest), isTimesIdentity(2 + 4));
}

/** Where features were far away, two views were almost the same; now that features are near, they
 * are not. What is said of a third must not make its error larger than any. */
TEST(JointCovariance, errorsByTheViewKeepTheirSizeWhenDistancesChange)
{
    JointCovariance joint = started();
    JointCovariance::Measurement measurement = against(1);
    measurement.noise.setZero();
    measurement.views.pointSigma.setConstant(2);
    setAlike(measurement, 0.99);
    joint.measure(kAtRest, kFrame, measurement);
    joint.keep({1, 2});
    measurement.views.frames = {1, 2};
    measurement.views.ofPoints.resize(3, 3);
    measurement.views.ofPoints << 1, 0.3, 0.9, 0.3, 1, 0.5, 0.9, 0.5, 1;
    joint.measure(kAtRest, kFrame, measurement);
    // Of frame 1's pose 1, and twice 4 if the views of frames 1 and 3 had nothing in common.
    EXPECT_LT(joint.latest()(0, 0), 1 + 2 * 4);
}

/** A camera that stands: its views are almost the same, and so are those of the references. */
TEST(JointCovariance, errorsByTheViewOfACameraThatStandsStaySmall)
{
    for (const double step : {1e-3, 1e-7, 1e-9, 1e-12, 1e-15, 0.0})
    {
        test::GaussianSampler sampler(5);
        JointCovariance joint = started();
        std::vector<double> places{0, 0};  // of frames 0, 1, ..., in ways to another view
        for (int frame = 2; frame <= 300; ++frame)
        {
            places.push_back(step * sampler.normal());
            JointCovariance::Measurement measurement = against(1);
            measurement.noise.setZero();
            measurement.views.pointSigma.setConstant(2);
            measurement.views.frames.assign({1, frame - 1, frame - 2});
            measurement.views.frames.resize(static_cast<size_t>(std::min(frame - 1, 3)));
            if (frame == 3)
            {
                measurement.views.frames = {1, 2};
            }
            std::vector<int> all = measurement.views.frames;
            all.push_back(frame);
            const auto n = static_cast<Eigen::Index>(all.size());
            measurement.views.ofPoints.resize(n, n);
            const double distance = 1 + 0.5 * std::sin(frame);  // of the features
            for (Eigen::Index row = 0; row < n * n; ++row)
            {
                const double apart =
                    places[static_cast<size_t>(all[static_cast<size_t>(row / n)])] -
                    places[static_cast<size_t>(all[static_cast<size_t>(row % n)])];
                measurement.views.ofPoints(row / n, row % n) =
                    std::exp(-std::abs(apart) / distance);
            }
            measurement.factors.referencePoints = measurement.factors.references;
            joint.measure(kAtRest, kFrame, measurement);
            joint.keep({1, frame - 1, frame});
            ASSERT_LT(joint.latest()(0, 0), 0.1) << frame << ", " << step;
        }
    }
}

/** References agree with each other about a frame that errs by its own view: two of them tell no
 * more than one. */
TEST(JointCovariance, aFramesOwnErrorIsNotAveragedByManyReferences)
{
    const auto seenFromElsewhere = [](double betweenReferences)
    {
        JointCovariance joint = started();
        JointCovariance::Measurement measurement = against(1);
        measurement.noise.setZero();
        measurement.views.pointSigma.setConstant(2);
        setAlike(measurement, betweenReferences);
        joint.measure(kAtRest, kFrame, measurement);
        measurement.factors.references[1] = ofPose(0.5 * Matrix6d::Identity());
        measurement.factors.references[2] = measurement.factors.references[1];
        measurement.views.frames = {1, 2};
        measurement.views.ofPoints = Eigen::Matrix3d::Identity();
        measurement.views.ofPoints(0, 1) = measurement.views.ofPoints(1, 0) = betweenReferences;
        measurement.factors.referencePoints = measurement.factors.references;
        joint.measure(kAtRest, kFrame, measurement);
        return joint.latest();
    };
    // 4 of frame 3 and 4 of frame 1; what frame 2 errs by is in its pose, too, and cancels.
    EXPECT_THAT(seenFromElsewhere(0), isTimesIdentity(8));
    EXPECT_THAT(seenFromElsewhere(0.9), isTimesIdentity(8));
}

/** A frame that is measured against one reference, with an error of 2 patches' scale and no other.
 */
JointCovariance::Measurement bentAgainst(int reference)
{
    JointCovariance::Measurement out;
    out.factors.references[reference] = ofPose(Matrix6d::Identity());
    out.views.frames = {reference};
    out.views.ofPoints = out.views.ofPlanes = out.views.ofPatches = Eigen::MatrixXd::Identity(2, 2);
    out.views.patchSigma = 0.5;
    out.factors.patches(0, 3) = 2;
    out.factors.referencePatches[reference] = -out.factors.patches;
    return out;
}

/** What a reference's image errs by is the same in all frames that are compared with it. */
TEST(JointCovariance, smoothErrorsOfAReferenceAreCommon)
{
    JointCovariance joint = started();
    for (int frame = 2; frame <= 6; ++frame)
    {
        joint.measure(kAtRest, kFrame, bentAgainst(1));
        joint.keep({1});
        EXPECT_NEAR(joint.latest()(0, 0), 2 * 4 * 0.25, 1e-12) << "both images";
        EXPECT_NEAR(joint.latest()(1, 1), 0, 1e-12);
    }
    EXPECT_NEAR(joint.relative(3, kAtRest)(0, 0), 2 * 4 * 0.25, 1e-12) << "without the reference";
}

/** By what a frame erred when it was measured, it errs the other way as a reference. */
TEST(JointCovariance, smoothErrorsFromFrameToFrameDoNotAddUp)
{
    JointCovariance joint = started();
    for (int frame = 2; frame <= 12; ++frame)
    {
        joint.measure(kAtRest, kFrame, bentAgainst(frame - 1));
        joint.keep({frame});
        EXPECT_NEAR(joint.latest()(0, 0), 2 * 4 * 0.25, 1e-12);
    }
}

/** Where nothing but the motion model tells the pose, an error of the velocity goes on. */
TEST(JointCovariance, anUnobservedVelocityKeepsItsError)
{
    JointCovariance joint = started(100);
    JointCovariance::Measurement measurement;
    measurement.noise.bottomRightCorner<6, 6>() = 4 * Matrix6d::Identity();
    joint.measure(kAtRest, kFrame, measurement);
    joint.keep({});
    measurement.noise.setZero();
    measurement.factors.prior.setIdentity();
    for (int frame = 3; frame <= 32; ++frame)
    {
        joint.measure(kAtRest, kFrame, measurement);
        joint.keep({});
    }
    EXPECT_THAT(joint.relative(2, kAtRest), isTimesIdentity(4));  // (30 frames)^2 of 4 (m/s)^2
    EXPECT_THAT(joint.relative(17, kAtRest), isTimesIdentity(1));
}

/** A camera does not change: what its errors do to all frames alike cancels between them, and what
 * grows with the way from the reference goes on growing in one direction. */
TEST(JointCovariance, errorsOfTheCameraAreTheSameInAllFrames)
{
    CameraVector sigmas;
    sigmas << 0.5, 2, 2, 3, 0, 0, 0, 0, 0;
    JointCovariance joint(30);
    joint.start(1, Matrix6d::Zero());
    joint.changeCamera(sigmas.cwiseAbs2().asDiagonal());
    const auto seen = [](double metres)
    {
        JointCovariance::Measurement out = against(1);
        out.noise.setZero();
        out.factors.camera.topLeftCorner<4, 4>() = metres * Eigen::Matrix4d::Identity();
        return out;
    };
    for (int frame = 2; frame <= 12; ++frame)
    {
        joint.measure(kAtRest, kFrame, seen(0.01 * (frame - 1)));
        joint.keep({1});
    }
    joint.measure(kAtRest, kFrame, seen(0.11));
    const auto sigma = [&](int from, int axis)
    { return std::sqrt(joint.relative(from, kAtRest)(axis, axis)); };
    EXPECT_NEAR(sigma(1, 0), 0.5 * 0.11, 1e-12);
    EXPECT_NEAR(sigma(2, 0), 0.5 * 0.10, 1e-12);
    EXPECT_NEAR(sigma(2, 1), 2 * 0.10, 1e-12);
    EXPECT_NEAR(sigma(2, 2), 2 * 0.10, 1e-12);
    EXPECT_NEAR(sigma(2, 3), 3 * 0.10, 1e-12);
    EXPECT_NEAR(sigma(12, 0), 0, 1e-9) << "alike";
}

/** What is learnt of the camera between two frames that it displaces alike: they differ by what has
 * been learnt. */
TEST(JointCovariance, errorsOfTheCameraChangeAsTheyAreLearnt)
{
    JointCovariance joint(30);
    joint.start(1, Matrix6d::Zero());
    joint.changeCamera(4 * CameraMatrix::Identity());
    JointCovariance::Measurement seen = against(1);
    seen.noise.setZero();
    seen.factors.camera.topLeftCorner<6, 6>().setIdentity();
    seen.camera.gain *= 0.5;
    seen.camera.noise = 0.25 * CameraMatrix::Identity();
    joint.measure(kAtRest, kFrame, seen);
    joint.keep({1});
    EXPECT_THAT(joint.latest(), isTimesIdentity(4));
    joint.measure(kAtRest, kFrame, seen);
    EXPECT_THAT(joint.latest(), isTimesIdentity(0.25 * 4 + 0.25));
    EXPECT_THAT(joint.relative(2, kAtRest), isTimesIdentity(0.25 * 4 + 0.25));
}

/** What the former camera's errors did to the poses stays; those of the new one are its own. */
TEST(JointCovariance, errorsOfAnotherCameraAreIndependent)
{
    JointCovariance joint(30);
    joint.start(1, Matrix6d::Zero());
    JointCovariance::Measurement seen = against(1);
    seen.noise.setZero();
    seen.factors.camera.topLeftCorner<6, 6>().setIdentity();
    joint.changeCamera(4 * CameraMatrix::Identity());
    joint.measure(kAtRest, kFrame, seen);
    joint.changeCamera(9 * CameraMatrix::Identity());
    joint.measure(kAtRest, kFrame, seen);
    EXPECT_THAT(joint.latest(), isTimesIdentity(9));
    EXPECT_THAT(joint.relative(2, kAtRest), isTimesIdentity(9 + 4)) << "alike, they would cancel";
}

/** A velocity that decays moves later frames by less. */
TEST(JointCovariance, predictedFramesFollowAVelocityThatDecays)
{
    JointCovariance joint = started();
    JointCovariance::Prediction step;
    step.after.translation = step.after.rotation = {0.1, 0.5, 0, 0, 0};
    step.velocity = 4 * Matrix6d::Identity();
    step.noise.topLeftCorner<6, 6>() = 0.01 * Matrix6d::Identity();
    joint.predict(kAtRest, step);
    joint.predict(kAtRest, step);
    EXPECT_THAT(joint.relative(1, kAtRest), isTimesIdentity(0.15 * 0.15 * 4 + 2 * 0.01));
    EXPECT_THAT(joint.relative(2, kAtRest), isTimesIdentity(0.05 * 0.05 * 4 + 0.01));
}

/** An unknown velocity moves frame after frame by the same: the path grows with the time, not with
 * its root. */
TEST(JointCovariance, predictedFramesShareTheErrorOfTheVelocity)
{
    JointCovariance joint = started();
    JointCovariance::Prediction step;
    step.after.translation.reach = step.after.rotation.reach = 0.1;
    step.velocity = 4 * Matrix6d::Identity();
    step.noise.topLeftCorner<6, 6>() = 0.01 * Matrix6d::Identity();
    for (int frame = 2; frame <= 11; ++frame)
    {
        joint.predict(kAtRest, step);
    }
    EXPECT_THAT(joint.relative(1, kAtRest), isTimesIdentity(1 * 4 + 10 * 0.01));
    EXPECT_THAT(joint.relative(10, kAtRest), isTimesIdentity(0.01 * 4 + 0.01));

    // After a measured frame, or after a gap, the velocity is another one.
    JointCovariance measured = joint;
    measured.measure(kAtRest, kFrame, against(1));
    measured.predict(kAtRest, step);
    EXPECT_THAT(measured.relative(12, kAtRest), isTimesIdentity(0.01 * 4 + 0.01));
    joint.endCoasting();
    joint.predict(kAtRest, step);
    EXPECT_THAT(joint.relative(1, kAtRest), isTimesIdentity(4 + 0.04 + 11 * 0.01));

    // What the velocity gains on the way moves later frames only.
    JointCovariance gaining = started();
    step.noise.bottomRightCorner<6, 6>().setIdentity();
    gaining.predict(kAtRest, step);
    gaining.predict(kAtRest, step);
    EXPECT_THAT(gaining.relative(2, kAtRest), isTimesIdentity(0.01 * (4 + 1) + 0.01));
}

/** How often nothing is measured does not change how far the camera may have got. */
TEST(JointCovariance, twoPredictedFramesAreAsUncertainAsOneOfBothTimes)
{
    const auto predicted = [](int frames, double seconds)
    {
        JointCovariance joint = started();
        JointCovariance::Prediction step;
        step.after.translation = step.after.rotation = decayedVelocity(seconds, 0.5);
        step.velocity = 4 * Matrix6d::Identity();
        step.noise.topLeftCorner<6, 6>().diagonal() = step.after.pose();
        step.noise.topRightCorner<6, 6>().diagonal() = step.after.together();
        step.noise.bottomLeftCorner<6, 6>().diagonal() = step.after.together();
        step.noise.bottomRightCorner<6, 6>().diagonal() = step.after.velocity();
        for (int frame = 0; frame < frames; ++frame)
        {
            joint.predict(kAtRest, step);
        }
        return joint.latest();
    };
    EXPECT_TRUE(predicted(2, 0.2).isApprox(predicted(1, 0.4), 1e-9));
    EXPECT_TRUE(predicted(8, 0.05).isApprox(predicted(1, 0.4), 1e-9));
}

/** Against poses that err: a velocity that is better known along one axis of the camera, and
 * noise of a motion and a velocity that depend on each other, of a camera that has turned. */
TEST(JointCovariance, predictedFramesErrAlongTheCamerasAxes)
{
    constexpr double kSmall = 1e-4;  // to first order
    constexpr int kRuns = 20000;
    test::GaussianSampler sampler(93);
    const Eigen::Isometry3d start = se3Exp(sampler.vector<6>()),
                            motion = se3Exp(sampler.vector<6>());
    const Matrix6d startCov = sampler.covariance<6>(0.1, 1);
    JointCovariance::Prediction step;
    step.after = {decayedVelocity(0.5, 1), decayedVelocity(0.5, 0.4)};
    step.velocity = sampler.covariance<6>(0.1, 10);
    step.noise = sampler.covariance<12>(0.1, 1);
    JointCovariance joint(1);
    joint.start(1, startCov);
    joint.predict(start, step);
    joint.predict(start * motion, step);

    const Matrix6d startRoot = test::squareRoot(startCov),
                   velocityRoot = test::squareRoot(step.velocity);
    const Matrix12d noiseRoot = test::squareRoot(step.noise);
    std::vector<Vector6d> latest, since;
    for (int run = 0; run < kRuns; ++run)
    {
        Vector6d velocity = kSmall * velocityRoot * sampler.vector<6>();
        Eigen::Isometry3d pose = se3Exp(kSmall * startRoot * sampler.vector<6>()) * start, first;
        for (int k = 0; k < 2; ++k)
        {
            first = pose;
            const Vector12d noise = kSmall * noiseRoot * sampler.vector<12>();
            pose =
                pose * se3Exp(step.after.reach().cwiseProduct(velocity) + noise.head<6>()) * motion;
            velocity = step.after.kept().cwiseProduct(velocity) + noise.tail<6>();
        }
        latest.push_back(leftError(pose, start * motion * motion) / kSmall);
        since.push_back(leftError(first.inverse() * pose, motion) / kSmall);
    }
    // Chance makes it 0.046 +- 0.007.
    EXPECT_LT(difference(latest, joint.latest()), 0.07);
    EXPECT_LT(difference(since, joint.relative(2, start * motion)), 0.07);
}

TEST(JointCovariance, predictedFramesAndANewWindow)
{
    JointCovariance joint = started();
    joint.measure(kAtRest, kFrame, against(1));
    joint.predict(kAtRest, independent(5));
    EXPECT_THAT(joint.latest(), isTimesIdentity(6));
    EXPECT_THAT(joint.relative(2, kAtRest), isTimesIdentity(5));

    // The next one is measured against the first again, whatever was predicted in between.
    JointCovariance measured = joint;
    measured.keep({1, 2});
    measured.measure(kAtRest, kFrame, against(1));
    EXPECT_THAT(measured.latest(), isTimesIdentity(1));
    EXPECT_THAT(measured.relative(3, kAtRest), isTimesIdentity(1 + 6));

    // Or the window begins anew at the predicted frame.
    joint.restart(3);
    joint.keep({3});
    joint.measure(kAtRest, kFrame, against(3));
    EXPECT_THAT(joint.latest(), isTimesIdentity(7));
    EXPECT_THAT(joint.relative(3, kAtRest), isTimesIdentity(1));
    EXPECT_THROW(joint.measure(kAtRest, kFrame, against(1)), std::exception);
}

/** Frames a moment apart at one place, in any number: nothing is divided by next to nothing. */
TEST(JointCovariance, viewsThatAreAlmostTheSameAreNoTrouble)
{
    JointCovariance joint = started();
    JointCovariance::Measurement measurement;
    measurement.views.pointSigma.setConstant(2);
    for (int frame = 2; frame <= 8; ++frame)
    {
        const int n = std::min(frame - 1, 4);
        measurement.factors.references.clear();
        measurement.views.frames.clear();
        for (int k = 1; k <= n; ++k)
        {
            measurement.factors.references[frame - k] << Matrix6d::Identity() / n, Matrix6d::Zero();
            measurement.views.frames.push_back(frame - k);
        }
        measurement.views.ofPoints = Eigen::MatrixXd::Constant(n + 1, n + 1, 1 - 1e-9);
        measurement.views.ofPoints.diagonal().setOnes();
        measurement.factors.referencePoints = measurement.factors.references;
        joint.measure(kAtRest, kFrame, measurement);
        EXPECT_LT(joint.latest().norm(), 1e-6) << frame;
        EXPECT_GE(joint.latest().trace(), 0) << frame;
        joint.keep(measurement.views.frames);
    }
}

/** A place that is compared with again: its pose was kept. Of the error by its view, the other
 * references' tell what they have in common with it. */
TEST(JointCovariance, aRecalledReferenceErrsAsReferencesOfLikeViewsDo)
{
    const auto variance = [](double withPrevious)
    {
        JointCovariance joint = started();
        JointCovariance::Measurement measurement = against(1);
        measurement.factors.referencePoints = measurement.factors.references;
        joint.measure(kAtRest, kFrame, measurement);
        joint.restart(2, {1});
        measurement.views.pointSigma.setConstant(2);
        measurement.views.frames = {2, 1};
        measurement.views.ofPoints = Eigen::Matrix3d::Identity();
        measurement.views.ofPoints(0, 1) = measurement.views.ofPoints(1, 0) = withPrevious;
        measurement.views.ofPoints(0, 2) = measurement.views.ofPoints(2, 0) = 1;
        measurement.views.ofPoints(1, 2) = measurement.views.ofPoints(2, 1) = withPrevious;
        measurement.factors.referencePoints = measurement.factors.references;
        joint.measure(kAtRest, kFrame, measurement);
        return joint.latest();
    };
    EXPECT_THAT(variance(0), isTimesIdentity(1 + 4 * 2));
    EXPECT_THAT(variance(0.5), isTimesIdentity(1 + 4 * 1));
}

TEST(JointCovariance, keepsWhatIsStillNeeded)
{
    JointCovariance joint = started(2);
    for (int frame = 2; frame <= 6; ++frame)
    {
        joint.measure(kAtRest, kFrame, against(1));
        joint.keep({1}, {3});
    }
    for (const int frame : {6, 5, 4, 3})
    {
        EXPECT_NO_THROW((void)joint.relative(frame, kAtRest)) << frame;
    }
    EXPECT_THROW((void)joint.relative(2, kAtRest), std::invalid_argument);
    joint.predict(kAtRest, independent(1));
    joint.predict(kAtRest, independent(1));
    joint.predict(kAtRest, independent(1));
    joint.keep({1});
    EXPECT_NO_THROW((void)joint.relative(6, kAtRest))
        << "the previous one, though beyond the history";
    EXPECT_THROW((void)joint.relative(5, kAtRest), std::invalid_argument);
}

namespace
{
/** How alike a view is to the one before. */
constexpr double kPointsAlike = 0.7, kPlanesAlike = 0.5, kPatchesAlike = 0.3;

/** Of frames that go on in a line: what is known of the latest views tells all that is known. */
Eigen::MatrixXd correlationOf(const std::vector<int>& frames, double alike)
{
    const auto n = static_cast<Eigen::Index>(frames.size());
    Eigen::MatrixXd out(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
    {
        for (Eigen::Index k = 0; k < n; ++k)
        {
            const int steps = frames[static_cast<size_t>(i)] - frames[static_cast<size_t>(k)];
            out(i, k) = std::pow(alike, std::abs(steps));
        }
    }
    return out;
}

JointCovariance::Views viewsOf(const std::vector<int>& references, int frame)
{
    std::vector<int> all = references;
    all.push_back(frame);
    return {
        references,
        correlationOf(all, kPointsAlike),
        correlationOf(all, kPlanesAlike),
        correlationOf(all, kPatchesAlike)};
}

/** Errors of variance 1 with these correlations. */
template <int kSize>
std::vector<Eigen::Matrix<double, kSize, 1>> sampledViews(
    int n, double alike, test::GaussianSampler& sampler)
{
    std::vector<Eigen::Matrix<double, kSize, 1>> out{sampler.vector<kSize>()};
    for (int k = 1; k < n; ++k)
    {
        out.emplace_back(
            alike * out.back() + std::sqrt(1 - alike * alike) * sampler.vector<kSize>());
    }
    return out;
}
/** Any linear dependence. */
MotionModel::Smoothed smoothing(test::GaussianSampler& sampler)
{
    const auto any = [&sampler]() -> Matrix6d
    {
        return 0.3 * Matrix6d::Identity() +
               0.3 * sampler.vector<6>() * sampler.vector<6>().transpose();
    };
    MotionModel::Smoothed out;
    out.byVelocity = any();
    out.byNextVelocity = any();
    out.byNextMotion = any();
    out.byPreviousMotion = any();
    return out;
}

/** Corrects the error of the last but one velocity. */
void smooth(
    const MotionModel::Smoothed& by,
    const std::vector<Eigen::Isometry3d>& poses,
    const std::vector<Vector6d>& errors,
    std::vector<Vector6d>& velocity)
{
    const size_t k = velocity.size() - 1, previous = k - 1;
    Vector6d& corrected = velocity[previous];
    corrected =
        (by.byVelocity * corrected + by.byNextVelocity * velocity[k] +
         by.byNextMotion * adjoint(poses[previous].inverse()) * (errors[k] - errors[previous]))
            .eval();
    if (k >= 2)
    {
        corrected += by.byPreviousMotion * adjoint(poses[k - 2].inverse()) *
                     (errors[previous] - errors[k - 2]);
    }
}
}  // namespace

/** Errors drawn as the model says, in a moving frame, with all kinds of dependence at once. */
TEST(JointCovariance, monteCarlo)
{
    constexpr int kRuns = 10000;
    constexpr int kFrames = 6;
    test::GaussianSampler setup(91);
    std::vector<Eigen::Isometry3d> poses{se3Exp(setup.vector<6>())};
    std::vector<JointCovariance::Measurement> measurements;
    std::vector<MotionModel::Smoothed> smoothings;
    std::vector<Matrix12d> noiseRoots;
    std::vector<CameraMatrix> cameraRoots;
    const DecayedVelocities decayed{decayedVelocity(0.5, 1), decayedVelocity(0.5, 0.4)};
    const CameraMatrix cameraCov = setup.covariance<kNumCameraErrors>(0.1, 0.5);
    JointCovariance joint(kFrames);
    const Matrix6d startCov = setup.covariance<6>(0.1, 1);
    joint.start(0, startCov);
    joint.changeCamera(cameraCov);
    for (int k = 1; k < kFrames; ++k)
    {
        JointCovariance::Measurement m;
        for (const int reference : {0, k - 1})
        {
            Matrix12d& change =
                m.factors.references.emplace(reference, Matrix12d::Zero()).first->second;
            change += 0.3 * Matrix12d::Identity() +
                      0.1 * setup.vector<12>() * setup.vector<12>().transpose();
            m.factors.referencePoints[reference] = 0.6 * change;
        }
        m.factors.prior = 0.4 * Matrix12d::Identity();
        m.noise = setup.covariance<12>(0.05, 0.3);
        m.noise += setup.covariance<12>(0.05, 0.3);
        smoothings.push_back(smoothing(setup));
        m.views = viewsOf(k == 1 ? std::vector<int>{0} : std::vector<int>{0, k - 1}, k);
        m.views.pointSigma = Vector12d::LinSpaced(0.5, 2);
        m.views.planeRoot = setup.covariance<6>(0.5, 2);
        m.factors.camera = setup.vector<12>() * setup.vector<kNumCameraErrors>().transpose();
        m.factors.camera.bottomRightCorner<6, 3>().setConstant(0.4);
        m.camera.gain = 0.8 * CameraMatrix::Identity();
        m.camera.noise = setup.covariance<kNumCameraErrors>(0.01, 0.1);
        m.views.patchSigma = std::sqrt(2);
        m.factors.patches = 0.2 * setup.vector<12>() * setup.vector<kNumPatches>().transpose();
        for (const int reference : {0, k - 1})
        {
            m.factors.referencePatches[reference] =
                0.2 * setup.vector<12>() * setup.vector<kNumPatches>().transpose();
        }
        joint.measure(poses.back(), decayed, m, smoothings.back());
        joint.keep({0, k - 1, k});
        measurements.push_back(m);
        noiseRoots.emplace_back(test::squareRoot(m.noise));
        cameraRoots.emplace_back(test::squareRoot(m.camera.noise));
        poses.push_back(se3Exp(0.5 * setup.vector<6>()) * poses.back());
    }

    test::GaussianSampler sampler(92);
    std::vector<Vector6d> latest, since, newestVelocity, previousVelocity;
    for (int run = 0; run < kRuns; ++run)
    {
        std::vector<Vector6d> pose{sampler.sample(startCov)};
        const std::vector<Vector12d> view = sampledViews<12>(kFrames, kPointsAlike, sampler);
        const std::vector<Vector6d> planeView = sampledViews<6>(kFrames, kPlanesAlike, sampler);
        const std::vector<PatchVector> bends =
            sampledViews<kNumPatches>(kFrames, kPatchesAlike, sampler);
        std::vector<Vector6d> velocity{Vector6d::Zero()};
        CameraVector camera = sampler.sample(cameraCov);
        for (int k = 1; k < kFrames; ++k)
        {
            const JointCovariance::Measurement& m = measurements[static_cast<size_t>(k - 1)];
            const Matrix6d Ad = adjoint(poses[static_cast<size_t>(k - 1)]);
            const Matrix6d toBase = test::inverse(Ad);
            const Vector6d before = toBase * pose.back();
            Vector12d predicted;
            predicted << before + decayed.reach().cwiseProduct(velocity.back()),
                decayed.kept().cwiseProduct(velocity.back());
            Vector12d shared = m.factors.prior * predicted +
                               noiseRoots[static_cast<size_t>(k - 1)] * sampler.vector<12>();
            shared += m.factors.camera * camera;
            for (const auto& [frame, change] : m.factors.references)
            {
                const auto reference = static_cast<size_t>(frame);
                shared += change.leftCols<6>() *
                          (toBase * pose[reference] +
                           m.views.planeRoot *
                               (planeView[static_cast<size_t>(k)] - planeView[reference]));
                shared += change.rightCols<6>() * velocity[reference];
            }
            for (const auto& [frame, change] : m.factors.referencePoints)
            {
                const auto reference = static_cast<size_t>(frame);
                shared += change * m.views.pointSigma.cwiseProduct(
                                       view[static_cast<size_t>(k)] - view[reference]);
            }
            shared += m.views.patchSigma * m.factors.patches * bends[static_cast<size_t>(k)];
            for (const auto& [frame, change] : m.factors.referencePatches)
            {
                shared += m.views.patchSigma * change * bends[static_cast<size_t>(frame)];
            }
            pose.push_back(Ad * shared.head<6>());
            velocity.emplace_back(shared.tail<6>());
            smooth(smoothings[static_cast<size_t>(k - 1)], poses, pose, velocity);
            camera = m.camera.gain * camera +
                     cameraRoots[static_cast<size_t>(k - 1)] * sampler.vector<kNumCameraErrors>();
        }
        latest.push_back(pose.back());
        since.push_back(adjoint(poses[2].inverse()) * (pose.back() - pose[2]));
        newestVelocity.push_back(velocity.back());
        previousVelocity.push_back(velocity[kFrames - 2]);
    }
    // Chance makes it 0.065 +- 0.01.
    EXPECT_LT(difference(latest, joint.latest()), 0.1);
    EXPECT_LT(difference(since, joint.relative(2, poses[2])), 0.1);
    EXPECT_LT(difference(newestVelocity, joint.velocity(kFrames - 1)), 0.1);
    EXPECT_LT(difference(previousVelocity, joint.velocity(kFrames - 2)), 0.1) << "smoothed";
}

TEST(CovarianceParams, areRefusedNamingTheKey)
{
    const auto refused = [](auto change)
    {
        CovarianceParams params;
        change(params);
        EXPECT_THROW(params.check(), std::invalid_argument);
    };
    refused([](auto& p) { p.model = "none"; });
    refused([](auto& p) { p.noise = 0; });
    refused([](auto& p) { p.viewNoise = -1; });
    refused([](auto& p) { p.vignetting = -0.1; });
    refused([](auto& p) { p.principalPoint = -0.1; });
    refused([](auto& p) { p.focalLength = -0.1; });
    refused([](auto& p) { p.depthScale = -0.1; });
    refused([](auto& p) { p.history = 0; });
}
}  // namespace pointplane
