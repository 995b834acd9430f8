// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/VisualOdometry.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>
#include <pointplane/mrpt_io/params_ini.h>

#include <cmath>
#include <functional>
#include <limits>

#include "TempDir.h"
#include "linear_algebra.h"
#include "matchers.h"
#include "rawlog_samples.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::sampleScan;

TEST(VisualOdometry, isTheOdometrySeenFromTheRobot)
{
    const auto sensorPose = mrpt::poses::CPose3D::FromXYZYawPitchRoll(0.3, 0.1, 0.8, 0.2, 0.1, 0);
    VisualOdometry vo;
    vo.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    Odometry odometry;
    const ObservationConverter converter;
    RobotTrajectory trajectory;
    for (int i = 0; i < 4; ++i)
    {
        const auto scan = sampleScan(i, 64, 48);
        scan->sensorPose = sensorPose;
        const RobotMotion motion = vo.process(*scan);
        const ConvertedFrame converted = converter.convert(*scan);
        const RobotMotion expected =
            trajectory.add(odometry.process(converted.frame), converted.T_robot_cam);
        EXPECT_EQ(motion.status, expected.status);
        EXPECT_EQ(motion.stamp, converted.frame.stamp);
        EXPECT_EQ(motion.pose.mean, expected.pose.mean);
        EXPECT_EQ(motion.pose.cov, expected.pose.cov);
        EXPECT_EQ(motion.increment.mean, expected.increment.mean);
    }
}

TEST(VisualOdometry, aBadFrameIsLostWithItsReasonAndTheNextGoesOn)
{
    VisualOdometry vo;
    vo.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    EXPECT_EQ(vo.process(*sampleScan(0, 64, 48)).status, TrackingStatus::First);
    const auto bad = sampleScan(1, 64, 48);
    bad->hasRangeImage = bad->hasIntensityImage = false;
    const RobotMotion lost = vo.process(*bad);
    EXPECT_EQ(lost.status, TrackingStatus::Lost);
    EXPECT_EQ(lost.reason, "observation has no range image");
    EXPECT_TRUE(test::hasCholesky(lost.pose.cov.asEigen()));
    EXPECT_NE(vo.process(*sampleScan(2, 64, 48)).status, TrackingStatus::Lost);
}

TEST(VisualOdometry, badFramesBeforeTheFirstGoodOneDoNotMoveTheRobot)
{
    for (const int numBad : {0, 1, 3})
    {
        VisualOdometry vo;
        vo.setMinLoggingLevel(mrpt::system::LVL_ERROR);
        for (int i = 0; i < numBad + 1; ++i)
        {
            const auto scan = sampleScan(i, 64, 48);
            scan->sensorPose = mrpt::poses::CPose3D::FromXYZYawPitchRoll(1, 0, 2, 0.2, 0, 0);
            scan->hasRangeImage = scan->hasIntensityImage = i >= numBad;
            const RobotMotion motion = vo.process(*scan);
            EXPECT_LT(motion.pose.mean.norm(), 1e-9) << "frame " << i << " after " << numBad;
            EXPECT_LT(motion.increment.mean.norm(), 1e-9);
        }
    }
}

/** Frames without a reading can be converted: they tell where the camera is on the robot. */
TEST(VisualOdometry, thePathBeginsWhereTheCameraIsInItsFirstFrame)
{
    VisualOdometry vo;
    vo.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    for (int i = 0; i < 4; ++i)
    {
        const auto scan = sampleScan(i, 64, 48);
        scan->sensorPose = mrpt::poses::CPose3D::FromXYZYawPitchRoll(0.3, 0, 1, 0.3 * i, 0, 0);
        if (i < 3)
        {
            scan->rangeImage.fill(0);
        }
        const RobotMotion motion = vo.process(*scan);
        EXPECT_EQ(motion.status, i < 3 ? TrackingStatus::Lost : TrackingStatus::First);
        EXPECT_LT(motion.pose.mean.norm(), 1e-9) << i;
        EXPECT_NEAR(motion.pose.mean.yaw(), 0, 1e-9) << i;
        EXPECT_LT(motion.increment.mean.norm(), 1e-9) << i;
        EXPECT_NEAR(motion.increment.mean.yaw(), 0, 1e-9) << i;
    }
}

TEST(VisualOdometry, loadsItsConfiguration)
{
    const test::TempDir dir;
    test::writeBytes(dir / "a.ini", "[DepthNoise]\nsigmaPixelPx = 0.75\n");
    VisualOdometry vo;
    vo.loadFromConfigFileName(dir / "a.ini");
    EXPECT_EQ(vo.params().depthNoise.sigmaPixelPx, 0.75);
    test::writeBytes(dir / "b.ini", "[DepthNoise]\nsigma = 0.75\n");
    EXPECT_THROW(vo.loadFromConfigFileName(dir / "b.ini"), InputError);
    EXPECT_EQ(vo.params().depthNoise.sigmaPixelPx, 0.75);
}

TEST(VisualOdometry, resetStartsAnew)
{
    VisualOdometry vo;
    vo.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    (void)vo.process(*sampleScan(0, 64, 48));
    const RobotMotion before = vo.process(*sampleScan(1, 64, 48));
    vo.reset();
    EXPECT_EQ(vo.process(*sampleScan(0, 64, 48)).status, TrackingStatus::First);
    EXPECT_EQ(vo.process(*sampleScan(1, 64, 48)).pose.mean, before.pose.mean);
}

/** Another recording may have another camera with the same label. */
TEST(VisualOdometry, startingAnewForgetsWhatTheRecordingToldOfTheCamera)
{
    const test::TempDir dir;
    test::writeBytes(dir / "a.ini", "[DepthNoise]\nsigmaPixelPx = 0.75\n");
    VisualOdometry vo;
    vo.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    const auto depthOnly = sampleScan(1, 64, 48);
    depthOnly->hasIntensityImage = false;
    depthOnly->cameraParams.cx(30);
    const std::function<void()> ways[] = {
        [&] { vo.reset(); }, [&] { vo.loadFromConfigFileName(dir / "a.ini"); }};
    for (const auto& startAnew : ways)
    {
        mrpt::obs::CObservationComment comment;
        comment.text = "pointplane-camera label=RGBD readoutColour=0.02 unheardOf=1";
        (void)vo.converter().readComment(comment);
        (void)vo.process(*sampleScan(0, 64, 48));
        RgbdFrame frame = vo.converter().convert(*depthOnly).frame;
        EXPECT_EQ(frame.camera.cx, 31.5) << "of the colour camera";
        EXPECT_EQ(frame.shutter.readoutColour, 0.02);
        startAnew();
        frame = vo.converter().convert(*depthOnly).frame;
        EXPECT_EQ(frame.camera.cx, 30);
        EXPECT_TRUE(std::isnan(frame.shutter.readoutColour));
        EXPECT_TRUE(vo.converter().unknownKeys().empty());
    }
}

/** The robot's path must not end where its camera is nowhere. */
TEST(VisualOdometry, aFrameWhoseCameraHasNoPoseOnTheRobotIsLost)
{
    VisualOdometry vo;
    vo.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    (void)vo.process(*sampleScan(0, 64, 48));
    const double none = std::numeric_limits<double>::quiet_NaN();
    for (const double scale : {2.0, 0.0, -1.0, none})
    {
        ConvertedFrame frame = ObservationConverter().convert(*sampleScan(1, 64, 48));
        frame.T_robot_cam.linear() *= scale;
        const RobotMotion lost = vo.process(frame);
        EXPECT_EQ(lost.status, TrackingStatus::Lost) << scale;
        EXPECT_THAT(lost.reason, testing::HasSubstr("T_robot_cam "));
        EXPECT_EQ(lost.stamp, frame.frame.stamp);
        EXPECT_TRUE(test::hasCholesky(lost.pose.cov.asEigen()));
    }
    const RobotMotion next = vo.process(*sampleScan(2, 64, 48));
    EXPECT_EQ(next.status, TrackingStatus::Tracked) << next.reason;
    EXPECT_LT(next.pose.mean.norm(), 0.1);
}

/** As those of a loop over a rawlog of two cameras. */
TEST(VisualOdometry, aFrameOfAnotherCameraIsLostAndChangesNoPose)
{
    VisualOdometry vo;
    vo.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    (void)vo.process(*sampleScan(0, 64, 48));
    const RobotMotion before = vo.process(*sampleScan(1, 64, 48));
    const auto other = sampleScan(40, 64, 48);
    other->sensorLabel = "REAR";
    other->sensorPose = mrpt::poses::CPose3D::FromXYZYawPitchRoll(-0.3, 0, 0, M_PI, 0, 0);
    const RobotMotion lost = vo.process(*other);
    EXPECT_EQ(lost.status, TrackingStatus::Lost);
    EXPECT_EQ(
        lost.reason, "is of camera 'REAR', not of 'RGBD': each camera needs an object of its own");
    EXPECT_NEAR(lost.pose.mean.distanceTo(before.pose.mean), 0, 1e-9);
    // Its stamp is later than that of the next one of the first camera.
    EXPECT_NE(vo.process(*sampleScan(2, 64, 48)).status, TrackingStatus::Lost);
    const RobotMotion converted = vo.process(ObservationConverter().convert(*other));
    EXPECT_EQ(converted.reason, lost.reason);
    vo.reset();
    EXPECT_EQ(vo.process(*other).status, TrackingStatus::First);
}
}  // namespace
}  // namespace pointplane
