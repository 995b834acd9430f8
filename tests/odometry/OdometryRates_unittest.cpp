// SPDX-License-Identifier: BSD-3-Clause
/** Other resolutions and rates than a Kinect's. */
#include <pointplane/odometry/Odometry.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <iostream>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Runs over a second and a half of a desk. */
void expectTracked(const SimulationParams& params)
{
    const SimulatedSequence sequence("desk", params, 1);
    Odometry odometry{OdometryParams()};
    OdometryResult last;
    for (int i = 0; i < sequence.numFrames(); ++i)
    {
        last = odometry.process(sequence.frame(i));
        EXPECT_NE(last.status, TrackingStatus::Predicted) << i << ": " << last.reason;
        EXPECT_NE(last.status, TrackingStatus::Lost) << i << ": " << last.reason;
    }
    const Eigen::Isometry3d truth = sequence.trueMotion(0, sequence.numFrames() - 1);
    const double error = (last.pose.mean.translation() - truth.translation()).norm();
    std::cout << params.width << "x" << params.height << ", " << params.fps
              << " Hz: " << 1e3 * error << " mm of " << 1e3 * truth.translation().norm() << "\n";
    EXPECT_LT(error, 0.005);
    EXPECT_GT(truth.translation().norm(), 0.02);
}
}  // namespace

TEST(OdometryRates, sizesOfImages)
{
    for (const auto& [width, height] : {std::pair{640, 360}, {1280, 720}})
    {
        SimulationParams params;
        params.width = width;
        params.height = height;
        params.duration = 1.5;
        params.fps = 15;
        expectTracked(params);
    }
}

TEST(OdometryRates, framesASecond)
{
    for (const double fps : {15.0, 60.0, 90.0})
    {
        SimulationParams params;
        params.width = 320;
        params.height = 240;
        params.duration = 1.5;
        params.fps = fps;
        params.readoutColour = params.readoutDepth = std::min(0.8 / fps, 0.8 / 30);
        params.exposure = std::min(0.01, 0.5 / fps);
        expectTracked(params);
    }
}

/** In the dark, a colour camera halves its rate: each image comes twice. That a frame without a new
 * one shows no points again is no reason for a key frame, which would have none: only its distance
 * is. */
TEST(OdometryRates, colourAtHalfTheRateOfDepth)
{
    SimulationParams params;
    params.duration = 2;
    const SimulatedSequence sequence("desk", params, 1);
    Odometry odometry{OdometryParams()};
    RgbdFrame before;
    int keyframesWithoutPoints = 0;
    OdometryResult last;
    for (int i = 0; i < sequence.numFrames(); ++i)
    {
        RgbdFrame frame = sequence.frame(i);
        const bool isRepeated = i % 2 == 1;
        if (isRepeated)
        {
            frame.gray = before.gray;
        }
        before = frame;
        last = odometry.process(frame);
        EXPECT_TRUE(i == 0 || last.status == TrackingStatus::Tracked) << i << ": " << last.reason;
        keyframesWithoutPoints += isRepeated && odometry.features().isKeyframe;
    }
    const int end = sequence.numFrames() - 1;
    const Eigen::Vector3d truth = sequence.trueMotion(0, end).translation();
    const double error = (last.pose.mean.translation() - truth).norm();
    std::cout << 1e3 * error << " mm of " << 1e3 * truth.norm()
              << ", key frames without points: " << keyframesWithoutPoints << "\n";
    EXPECT_LT(error, 0.001);
    EXPECT_LE(keyframesWithoutPoints, 3);  // as far apart as key frames are
}

/** The camera turns back suddenly: of where points are searched for, most are at the edge or
 * beyond. What is found around there (142 points) is not all. */
TEST(OdometryRates, pointsBeyondTheSearchRadiusAreFound)
{
    SimulationParams params;
    params.duration = 1;
    const SimulatedSequence sequence("desk", params, 1);
    Odometry odometry{OdometryParams()};
    OdometryResult last;
    double stamp = 0;
    for (const int i : {10, 12, 14, 13})
    {
        RgbdFrame frame = sequence.frame(i);
        frame.stamp = stamp += 1 / params.fps;
        last = odometry.process(frame);
    }
    EXPECT_EQ(last.status, TrackingStatus::Tracked) << last.reason;
    EXPECT_GT(last.diagnostics.numPointPairs, 250);
}
}  // namespace pointplane
