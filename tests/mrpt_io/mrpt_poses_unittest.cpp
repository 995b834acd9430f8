// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/mrpt_io/RobotTrajectory.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <mrpt/system/datetime.h>

#include <algorithm>
#include <limits>

#include "linear_algebra.h"
#include "matchers.h"
#include "monte_carlo.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::GaussianSampler;
using test::IsMatrixNear;
using test::IsNearPose;

[[nodiscard]] Vector6d yprVector(const Eigen::Isometry3d& T)
{
    const auto pose = toMrpt(T);
    Vector6d out;
    out << pose.x(), pose.y(), pose.z(), pose.yaw(), pose.pitch(), pose.roll();
    return out;
}

[[nodiscard]] Eigen::Isometry3d poseAt(
    double x, double y, double z, double yaw, double pitch, double roll)
{
    return fromMrpt(mrpt::poses::CPose3D::FromXYZYawPitchRoll(x, y, z, yaw, pitch, roll));
}

TEST(MrptPoses, opticalAxesByHand)
{
    // A point 2 m ahead, 1 m to the right and 0.5 m down.
    const Eigen::Vector3d p_body = opticalInBody() * Eigen::Vector3d(1, 0.5, 2);
    EXPECT_THAT(p_body, IsMatrixNear(Eigen::Vector3d(2, -1, -0.5), 0.0));
    const auto mrptPose =
        mrpt::poses::CPose3D::FromXYZYawPitchRoll(0, 0, 0, -M_PI / 2, 0, -M_PI / 2);
    EXPECT_THAT(fromMrpt(mrptPose), IsNearPose(opticalInBody(), 1e-12, 0.0));
}

TEST(MrptPoses, meanRoundTrip)
{
    GaussianSampler sampler(1);
    for (int i = 0; i < 100; ++i)
    {
        const Eigen::Isometry3d T = se3Exp(sampler.vector<6>());
        EXPECT_THAT(fromMrpt(toMrpt(T)), IsNearPose(T, 1e-7, 1e-12));
    }
}

TEST(MrptPoses, jacobianMatchesFiniteDifferences)
{
    GaussianSampler sampler(2);
    for (int i = 0; i < 100; ++i)
    {
        const Eigen::Isometry3d T = poseAt(
            sampler.normal(),
            sampler.normal(),
            sampler.normal(),
            sampler.uniform(-3, 3),
            sampler.uniform(-1.4, 1.4),
            sampler.uniform(-3, 3));
        Matrix6d expected;
        const double h = 1e-6;
        for (int k = 0; k < 6; ++k)
        {
            const Vector6d step = h * Vector6d::Unit(k);
            expected.col(k) =
                (yprVector(se3Exp(step) * T) - yprVector(se3Exp(-step) * T)) / (2 * h);
        }
        EXPECT_THAT(
            jacobianYprOfTangent(T), IsMatrixNear(expected, 1e-6 * expected.cwiseAbs().maxCoeff()));
    }
}

TEST(MrptPoses, covarianceMatchesMonteCarlo)
{
    GaussianSampler sampler(3);
    PoseGaussian pose;
    pose.mean = poseAt(1.0, -2.0, 0.5, 0.7, -0.6, 1.1);
    pose.cov = 1e-4 * sampler.covariance<6>(0.2, 2.0);
    const Vector6d mean = yprVector(pose.mean);
    std::vector<Vector6d> errors;
    for (int i = 0; i < 100000; ++i)
    {
        errors.push_back(yprVector(se3Exp(sampler.sample(pose.cov)) * pose.mean) - mean);
    }
    const Matrix6d expected = test::sampleCovariance<6>(errors);
    const Matrix6d actual = toMrpt(pose).cov.asEigen();
    EXPECT_LT((actual - expected).norm(), 0.02 * expected.norm());
    // What copying the matrix across would be.
    EXPECT_GT((pose.cov - expected).norm(), 0.3 * expected.norm());
}

TEST(MrptPoses, covarianceRoundTrip)
{
    GaussianSampler sampler(4);
    for (int i = 0; i < 50; ++i)
    {
        PoseGaussian pose;
        pose.mean =
            poseAt(sampler.normal(), 0, 1, sampler.uniform(-3, 3), sampler.uniform(-1.3, 1.3), 0.2);
        pose.cov = sampler.covariance<6>(1e-6, 1e-2);
        const PoseGaussian back = fromMrpt(toMrpt(pose));
        EXPECT_THAT(back.cov, IsMatrixNear(pose.cov, 1e-9));
    }
}

TEST(MrptPoses, compositionAgreesWithMrpts)
{
    GaussianSampler sampler(5);
    for (int i = 0; i < 50; ++i)
    {
        PoseGaussian a, b;
        a.mean = poseAt(sampler.normal(), 1, 2, 0.3, sampler.uniform(-1, 1), 0.5);
        b.mean = poseAt(0.1, sampler.normal(), -1, -0.2, 0.4, sampler.uniform(-1, 1));
        a.cov = 1e-3 * sampler.covariance<6>(0.1, 1);
        b.cov = 1e-3 * sampler.covariance<6>(0.1, 1);
        const auto expected = toMrpt(a) + toMrpt(b);
        const auto actual = toMrpt(compose(a, b));
        const Matrix6d expectedCov = expected.cov.asEigen();
        EXPECT_THAT(
            Matrix6d(actual.cov.asEigen()), IsMatrixNear(expectedCov, 1e-9 * expectedCov.norm()));
    }
}

TEST(MrptPoses, writtenCovarianceIsPositiveDefiniteWhateverComes)
{
    PoseGaussian pose;
    EXPECT_TRUE(isPositiveDefinite(Matrix6d(toMrpt(pose).cov.asEigen())));  // zero
    pose.cov = 1e-12 * Matrix6d::Identity();
    EXPECT_TRUE(isPositiveDefinite(Matrix6d(toMrpt(pose).cov.asEigen())));
    // Camera looking straight up: yaw and roll cannot be told apart.
    pose.mean = poseAt(1, 2, 3, 0.5, M_PI / 2, 0);
    pose.cov = 1e-4 * Matrix6d::Identity();
    EXPECT_TRUE(isPositiveDefinite(Matrix6d(toMrpt(pose).cov.asEigen())));
    // Singular: no uncertainty along x.
    pose.mean = Eigen::Isometry3d::Identity();
    pose.cov(0, 0) = 0;
    EXPECT_TRUE(isPositiveDefinite(Matrix6d(toMrpt(pose).cov.asEigen())));
}

/** Found by fuzzing: rank 3, which one order of factorisation takes for positive definite. */
TEST(MrptPoses, writtenCovarianceIsPositiveDefiniteInAnyOrder)
{
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal(0, 20);
    for (int i = 0; i < 200; ++i)
    {
        const Eigen::Matrix<double, 6, 3> root =
            Eigen::Matrix<double, 6, 3>::NullaryExpr([&] { return normal(random); });
        PoseGaussian pose;
        pose.mean = poseAt(0.01, -0.003, -0.001, -0.006, 0.004, 0.002);
        pose.cov = root * root.transpose();
        const Matrix6d cov = toMrpt(pose).cov.asEigen();
        EXPECT_TRUE(isPositiveDefinite(cov)) << i;
        EXPECT_TRUE(isPositiveDefinite(cov.reverse().eval())) << i;
        EXPECT_GT(test::symmetricEigen(cov).values[0], 0.9e-12 * cov.trace()) << i;
        EXPECT_LT(
            (cov - propagate(jacobianYprOfTangent(pose.mean), pose.cov)).norm(),
            1e-11 * cov.norm());
    }
}

TEST(MrptPoses, stampsOutsideOfTheClockStayInside)
{
    const auto earliest = mrpt::Clock::time_point::min(), latest = mrpt::Clock::time_point::max();
    EXPECT_NEAR(toSeconds(earliest), -9.2e11, 1e10);
    EXPECT_NEAR(toSeconds(latest), 9.1e11, 1e10);
    EXPECT_EQ(stampText(earliest).front(), '-');
    EXPECT_NEAR(toSeconds(fromSeconds(1e300)), 9e11, 1);
    EXPECT_NEAR(toSeconds(fromSeconds(-1e300)), -9e11, 1);
    EXPECT_TRUE(fromSeconds(toSeconds(INVALID_TIMESTAMP)) == INVALID_TIMESTAMP);
}

TEST(MrptPoses, stampsAreExact)
{
    EXPECT_EQ(stampText(stampFromText("1305031102.175304")), "1305031102.175304000");
    EXPECT_EQ(stampText(stampFromText("0.0333333")), "0.033333300");
    EXPECT_EQ(stampText(stampFromText("12")), "12.000000000");
    EXPECT_EQ(stampText(stampFromText("1.99999996")), "2.000000000");
    EXPECT_DOUBLE_EQ(toSeconds(stampFromText("1305031102.175304")), 1305031102.175304);
    EXPECT_EQ(stampText(fromSeconds(1000.25)), "1000.250000000");
    for (const char* bad : {"", "x", "1.2.3", "-1", "1e9", " 1", "999999999999.0"})
    {
        EXPECT_THROW((void)stampFromText(bad), InputError) << bad;
    }
}

TEST(RobotTrajectory, cameraAheadOfTheRobotTurnsWithIt)
{
    // The camera is 1 m ahead of the robot's centre; the robot turns on the spot by 0.1 rad.
    const Eigen::Isometry3d T_robot_cam = poseAt(1, 0, 0, 0, 0, 0) * opticalInBody();
    const Eigen::Isometry3d T_robot = poseAt(0, 0, 0, 0.1, 0, 0);
    RobotTrajectory trajectory;
    OdometryResult first;
    first.status = TrackingStatus::First;
    first.increment.cov = first.pose.cov = 1e-10 * Matrix6d::Identity();
    (void)trajectory.add(first, T_robot_cam);
    OdometryResult second;
    second.status = TrackingStatus::Tracked;
    second.increment.mean = T_robot_cam.inverse() * T_robot * T_robot_cam;
    second.increment.cov = 1e-4 * Matrix6d::Identity();
    second.pose = second.increment;
    const RobotMotion motion = trajectory.add(second, T_robot_cam);
    EXPECT_THAT(fromMrpt(motion.increment.mean), IsNearPose(T_robot, 1e-9, 1e-9));
    EXPECT_THAT(fromMrpt(motion.pose.mean), IsNearPose(T_robot, 1e-9, 1e-9));
    const PoseGaussian expected = changeFrame(T_robot_cam, second.increment);
    EXPECT_THAT(fromMrpt(motion.increment).cov, IsMatrixNear(expected.cov, 1e-10));
    // Rotation noise of the camera moves the robot, 1 m behind it, sideways.
    EXPECT_NEAR(motion.increment.cov(1, 1), 2e-4, 1e-5);
}

TEST(RobotTrajectory, followsAPanningCamera)
{
    // The robot stands still while the camera's head turns.
    RobotTrajectory trajectory;
    const auto head = [](double pan) { return poseAt(0.2, 0, 1, pan, 0, 0) * opticalInBody(); };
    OdometryResult result;
    result.status = TrackingStatus::First;
    result.increment.cov = result.pose.cov = 1e-6 * Matrix6d::Identity();
    (void)trajectory.add(result, head(0));
    result.status = TrackingStatus::Tracked;
    for (const double pan : {0.1, 0.3})
    {
        const double before = pan == 0.1 ? 0.0 : 0.1;
        result.increment.mean = head(before).inverse() * head(pan);
        result.pose.mean = head(0).inverse() * head(pan);
        const RobotMotion motion = trajectory.add(result, head(pan));
        EXPECT_THAT(
            fromMrpt(motion.increment.mean), IsNearPose(Eigen::Isometry3d::Identity(), 1e-9, 1e-9));
        EXPECT_THAT(
            fromMrpt(motion.pose.mean), IsNearPose(Eigen::Isometry3d::Identity(), 1e-9, 1e-9));
    }
}

/** The camera's motion is predicted then: nobody knows whether the head's is in it. */
TEST(RobotTrajectory, aHeadThatTurnsWhileNothingIsMeasuredIsUncertain)
{
    const auto head = [](double pan) { return poseAt(0, 0, 1, pan, 0, 0) * opticalInBody(); };
    const PoseGaussian still{Eigen::Isometry3d::Identity(), 1e-6 * Matrix6d::Identity()};
    const auto result = [&](TrackingStatus status, std::size_t numSince)
    {
        OdometryResult out;
        out.status = status;
        out.increment = out.pose = still;
        out.since.assign(numSince, still);
        return out;
    };
    const auto sdYaw = [](const mrpt::poses::CPose3DPDFGaussian& p)
    { return std::sqrt(p.cov(3, 3)); };
    RobotTrajectory trajectory;
    (void)trajectory.add(result(TrackingStatus::First, 0), head(0.1));
    const RobotMotion stands = trajectory.add(result(TrackingStatus::Predicted, 1), head(0.1));
    EXPECT_NEAR(sdYaw(stands.pose), 1e-3, 1e-9);
    const RobotMotion one = trajectory.add(result(TrackingStatus::Predicted, 2), head(0.3));
    const RobotMotion two = trajectory.add(result(TrackingStatus::Lost, 3), head(0.6));
    EXPECT_NEAR(sdYaw(one.increment), 0.2, 1e-4);
    EXPECT_NEAR(sdYaw(two.increment), 0.3, 1e-4);
    EXPECT_NEAR(sdYaw(two.since[1]), 0.5, 1e-4) << "they err together";
    EXPECT_NEAR(sdYaw(two.pose), 0.5, 1e-4);
    OdometryResult again = result(TrackingStatus::Tracked, 4);
    again.pose.mean = again.increment.mean = head(0.1).inverse() * head(0.6);
    const RobotMotion measured = trajectory.add(again, head(0.6));
    EXPECT_NEAR(sdYaw(measured.pose), 1e-3, 1e-9);
    EXPECT_THAT(
        fromMrpt(measured.pose.mean), IsNearPose(Eigen::Isometry3d::Identity(), 1e-9, 1e-9));
    EXPECT_NEAR(sdYaw(measured.increment), 0.5, 1e-4) << "it takes the wrong turn back";
    EXPECT_NEAR(sdYaw(measured.since[3]), 1e-3, 1e-9);
}

TEST(RobotTrajectory, motionsSinceEarlierFrames)
{
    // The head pans: each motion begins with the camera where it was on the robot then.
    RobotTrajectory trajectory;
    const auto head = [](int k) { return poseAt(0.2, 0, 1, 0.1 * k, 0, 0) * opticalInBody(); };
    const auto robot = [](int k) { return poseAt(0.3 * k, 0, 0, 0, 0, 0); };
    for (int k = 0; k < 4; ++k)
    {
        OdometryResult result;
        result.status = k == 0 ? TrackingStatus::First : TrackingStatus::Tracked;
        result.increment.cov = result.pose.cov = 1e-6 * Matrix6d::Identity();
        for (int n = 1; n <= std::min(k, 2); ++n)
        {
            result.since.push_back(
                {(robot(k - n) * head(k - n)).inverse() * robot(k) * head(k),
                 1e-6 * n * Matrix6d::Identity()});
        }
        const RobotMotion motion = trajectory.add(result, head(k));
        ASSERT_EQ(motion.since.size(), result.since.size());
        for (int n = 1; n <= std::min(k, 2); ++n)
        {
            const PoseGaussian since = fromMrpt(motion.since[static_cast<std::size_t>(n - 1)]);
            EXPECT_THAT(since.mean, IsNearPose(robot(n), 1e-9, 1e-9)) << k << " " << n;
            EXPECT_NEAR(since.cov(3, 3), 1e-6 * n, 1e-12);
        }
    }
}

/** Its information would be NaN, or of another matrix, and spoil the whole graph. */
TEST(MrptPoses, aCovarianceThatIsNoneHasNoInformation)
{
    mrpt::poses::CPose3DPDFGaussian edge;
    edge.cov.setZero();
    EXPECT_THROW((void)optimizerInformation(edge), std::invalid_argument);
    edge.cov.setIdentity();
    for (const double variance : {-1.0, std::numeric_limits<double>::quiet_NaN()})
    {
        edge.cov(0, 0) = variance;
        EXPECT_THROW((void)optimizerInformation(edge), std::invalid_argument) << variance;
    }
}
}  // namespace
}  // namespace pointplane
