// SPDX-License-Identifier: BSD-3-Clause
#include "Track.h"

#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>

#include <limits>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr double kFrame = 1.0 / 30;
constexpr double kSigma = 1e-3;

PinholeCamera camera()
{
    PinholeCamera out;
    out.fx = out.fy = 500;
    out.cx = 320;
    out.cy = 240;
    out.width = 640;
    out.height = 480;
    return out;
}

Reference frameAt(double stamp)
{
    Reference out;
    out.stamp = stamp;
    return out;
}

/** Frames without features, whose motions are given. */
class TrackTest : public testing::Test
{
 protected:
    TrackTest() : track_(OdometryParams{})
    {
        track_.changeCamera(camera(), CameraMatrix::Zero());
        (void)track_.restart(frameAt(0));
    }

    /** A measured motion by `x` [m] along the first axis. */
    void measure(double stamp, double x, bool isKeyframe = false, bool isJump = false)
    {
        const double dt = stamp - track_.previous().stamp;
        Track::Measured measured;
        measured.frame = frameAt(stamp);
        measured.isKeyframe = isKeyframe;
        measured.isJump = isJump;
        measured.dt = dt;
        measured.motion.mean.T_prev_cur.translation().x() = x;
        measured.motion.mean.velocity[0] = x / dt;
        measured.motion.cov = kSigma * kSigma * Matrix12d::Identity();
        measured.errors.noise = measured.motion.cov;
        // Compared with the previous frame: its error goes on.
        Matrix12d ofPose = Matrix12d::Zero();
        ofPose.topLeftCorner<6, 6>().setIdentity();
        measured.errors.factors.references[track_.previous().id] = ofPose;
        track_.measure(std::move(measured), {});
    }

    [[nodiscard]] double x() const { return track_.pose().mean.translation().x(); }
    [[nodiscard]] double sigma() const { return std::sqrt(track_.pose().cov(0, 0)); }

    Track track_;
};

TEST_F(TrackTest, theWorldIsTheFirstFrame)
{
    EXPECT_FALSE(track_.isEmpty());
    EXPECT_TRUE(track_.pose().mean.isApprox(Eigen::Isometry3d::Identity()));
    EXPECT_LE(sigma(), 1e-6);
    EXPECT_EQ(track_.references().size(), 1);
    EXPECT_TRUE(Track(OdometryParams{}).isEmpty());
}

/** Three steps of 1 cm, each with an error of 1 mm of its own. */
TEST_F(TrackTest, motionsAndTheirErrorsAddUp)
{
    for (int i = 1; i <= 3; ++i)
    {
        measure(i * kFrame, 0.01);
    }
    EXPECT_NEAR(x(), 0.03, 1e-12);
    EXPECT_NEAR(sigma(), std::sqrt(3) * kSigma, 1e-9);
    EXPECT_NEAR(track_.since().front().mean.translation().x(), 0.01, 1e-12);
    EXPECT_NEAR(std::sqrt(track_.since().front().cov(0, 0)), kSigma, 1e-9);
}

/** At 0.3 m/s, which hardly changes within a frame. */
TEST_F(TrackTest, theNextMotionIsPredicted)
{
    for (int i = 1; i <= 10; ++i)
    {
        measure(i * kFrame, 0.01);
    }
    const Prediction next = track_.prediction(11 * kFrame);
    EXPECT_NEAR(next.dt, kFrame, 1e-9);
    EXPECT_TRUE(next.followsMeasured);
    EXPECT_NEAR(next.pose.mean.translation().x(), 0.01, 1e-3);
    EXPECT_TRUE(isPositiveDefinite(next.pose.cov));
    // A longer step is less certain, and beyond maxGap the velocity is unknown.
    EXPECT_GT(track_.prediction(13 * kFrame).pose.cov(0, 0), next.pose.cov(0, 0));
    track_.noteGap(10 * kFrame + 1.1);
    EXPECT_EQ(track_.prediction(10 * kFrame + 1.1).pose.mean.translation().x(), 0);
}

/** The previous frame stays the measured one; the pose moves on and gets uncertain. */
TEST_F(TrackTest, predictedFramesGoOn)
{
    for (int i = 1; i <= 10; ++i)
    {
        measure(i * kFrame, 0.01);
    }
    const int previous = track_.previous().id;
    const double before = sigma();
    (void)track_.predict(11 * kFrame);
    EXPECT_NEAR(x(), 0.11, 2e-3);
    EXPECT_GT(sigma(), 2 * before);
    EXPECT_EQ(track_.previous().id, previous);
    EXPECT_FALSE(track_.prediction(12 * kFrame).followsMeasured);
    // The next measurement spans both steps, and takes the uncertainty back.
    measure(12 * kFrame, 0.02);
    EXPECT_NEAR(x(), 0.12, 1e-9);
    EXPECT_LT(sigma(), 1.1 * before + kSigma);
}

/** However short the steps are. */
TEST_F(TrackTest, beyondMaxGapTheVelocityIsUnknown)
{
    for (int i = 1; i <= 10; ++i)
    {
        measure(i * kFrame, 0.01);
    }
    const auto isMoving = [&](double stamp)
    {
        const double before = x();
        (void)track_.predict(stamp);
        return x() != before;
    };
    for (int i = 11; i <= 40; ++i)
    {
        EXPECT_TRUE(isMoving(i * kFrame - 1e-6)) << "less than a second";
    }
    EXPECT_FALSE(isMoving(41 * kFrame));
}

TEST_F(TrackTest, aJumpTellsNoVelocity)
{
    for (int i = 1; i <= 10; ++i)
    {
        measure(i * kFrame, 0.01);
    }
    measure(11 * kFrame, 2, false, true);
    EXPECT_NEAR(x(), 2.1, 1e-9);
    EXPECT_EQ(track_.prediction(12 * kFrame).pose.mean.translation().x(), 0);
}

TEST_F(TrackTest, keyFramesAreReferences)
{
    measure(kFrame, 0.2, true);
    measure(2 * kFrame, 0.01);
    const auto references = track_.references();
    ASSERT_EQ(references.size(), 3) << "the previous frame, and two key frames";
    EXPECT_NEAR(references[0]->T_world_cam.translation().x(), 0.21, 1e-12);
    EXPECT_NEAR(references[1]->T_world_cam.translation().x(), 0.2, 1e-12);
    EXPECT_TRUE(track_.fromWorld(Eigen::Isometry3d::Identity())
                    .isApprox(references[0]->T_world_cam.inverse()));
}

/** What did not match becomes the only reference; older key frames are places then. */
TEST_F(TrackTest, itGoesOnFromAFrameThatMatchedNothing)
{
    EXPECT_FALSE(track_.restartAtUnmatched());
    measure(kFrame, 0.01, true);
    (void)track_.predict(2 * kFrame, frameAt(2 * kFrame));
    const Eigen::Isometry3d predicted = track_.pose().mean;
    ASSERT_TRUE(track_.restartAtUnmatched());
    ASSERT_EQ(track_.references().size(), 1);
    EXPECT_TRUE(track_.previous().T_world_cam.isApprox(predicted));
    EXPECT_FALSE(track_.places().empty());
    EXPECT_FALSE(track_.restartAtUnmatched());
    // It can come back to a place.
    const int place = track_.places().front().id;
    track_.recall(place);
    EXPECT_EQ(track_.references().back()->id, place);
}

/** One frame may be late. If a second one follows it in order, the clock has been set. */
TEST_F(TrackTest, oneFrameMayBeLate)
{
    measure(1, 0.01);
    EXPECT_FALSE(track_.noteLate(1.1));
    EXPECT_TRUE(track_.noteLate(0.9));
    EXPECT_FALSE(track_.noteLate(1.2)) << "in order again";
    EXPECT_TRUE(track_.noteLate(0.5));
    EXPECT_FALSE(track_.noteLate(0.6)) << "the clock was set";
}

/** It does not move the camera, but it may have been anywhere near. */
TEST_F(TrackTest, aLateFrameStays)
{
    for (int i = 1; i <= 10; ++i)
    {
        measure(i * kFrame, 0.01);
    }
    const double before = sigma();
    const PoseGaussian increment = track_.predict(9.5 * kFrame);
    EXPECT_TRUE(increment.mean.isApprox(Eigen::Isometry3d::Identity()));
    EXPECT_NEAR(x(), 0.1, 1e-9);
    EXPECT_GT(sigma(), before);
}

TEST_F(TrackTest, anotherCameraIsTold)
{
    measure(1, 0.01);
    PinholeCamera other = camera();
    other.fx = 510;
    EXPECT_FALSE(track_.isOf(other));
}

/** Any time may have passed since the frames before: a long gap, whatever the new clock shows. */
TEST_F(TrackTest, whenTheClockIsSetTheTimeThatPassedIsUnknown)
{
    measure(1, 0.01);
    EXPECT_FALSE(track_.followClock(1.1));
    EXPECT_TRUE(track_.noteLate(0.5));
    EXPECT_FALSE(track_.noteLate(0.6));
    EXPECT_TRUE(track_.followClock(0.6));
    EXPECT_EQ(track_.references().size(), 2) << "they can still be compared with";
    EXPECT_DOUBLE_EQ(track_.prediction(0.6).dt, MotionModel::kLongestStep);
    EXPECT_FALSE(track_.noteLate(0.7));
}

/** A stamp that is no number is taken for a usual step. */
TEST_F(TrackTest, stampsMayBeAnything)
{
    const double stamps[] = {
        std::numeric_limits<double>::quiet_NaN(),
        std::numeric_limits<double>::infinity(),
        -1e300,
        1e300};
    for (const double stamp : stamps)
    {
        const PoseGaussian increment = track_.predict(stamp);
        EXPECT_TRUE(increment.mean.matrix().allFinite()) << stamp;
        EXPECT_TRUE(isPositiveDefinite(increment.cov)) << stamp;
        EXPECT_TRUE(isPositiveDefinite(track_.pose().cov)) << stamp;
    }
}
}  // namespace
}  // namespace pointplane
