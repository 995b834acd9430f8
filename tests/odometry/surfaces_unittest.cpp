// SPDX-License-Identifier: BSD-3-Clause
#include "surfaces.h"

#include <pointplane/odometry/Odometry.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "hell_frames.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Two planes, left and right of column 10. */
Features twoPlanes(double stamp)
{
    Features out;
    out.frame.stamp = stamp;
    out.planes.planes.resize(2);
    out.planes.labels = cv::Mat(20, 20, CV_8UC1, cv::Scalar(1));
    out.planes.labels.colRange(10, 20) = 2;
    return out;
}

Reference knowing(double stamp, const std::vector<InlierRatio>& surfaces)
{
    Reference out;
    out.stamp = stamp;
    out.surfaces = surfaces;
    return out;
}

PointTrack trackAt(double u)
{
    PointTrack out;
    out.cur.uv_px = {u, 5};
    return out;
}
}  // namespace

TEST(Surfaces, ofPixelsByHand)
{
    PlaneSet planes = twoPlanes(0).planes;
    planes.labels.at<std::uint8_t>(3, 3) = 0;
    EXPECT_EQ(planeAt({9.4, 5}, planes), 0);
    EXPECT_EQ(planeAt({9.6, 5}, planes), 1);
    EXPECT_EQ(planeAt({3, 3}, planes), -1) << "no plane";
    EXPECT_EQ(planeAt({-0.6, 5}, planes), -1);
    EXPECT_EQ(planeAt({5, 19.6}, planes), -1);
    EXPECT_EQ(planeAt({5, 5}, {}), -1) << "no planes were looked for";
}

TEST(Surfaces, areForgottenOverTwoSeconds)
{
    const Reference reference = knowing(7, {{8, 4}, {30, 3}});
    Association association;
    association.reference = &reference;
    association.planes = {{1, 0}};
    const auto known = rememberedInliers({association}, twoPlanes(9), 2);
    ASSERT_EQ(known.size(), 2U);
    EXPECT_NEAR(known[0].points, 30 * std::exp(-1), 1e-12);
    EXPECT_NEAR(known[0].inliers, 3 * std::exp(-1), 1e-12);
    EXPECT_EQ(known[1].points, 0) << "seen first";
}

TEST(Surfaces, areKnownFromTheFirstReferenceThatKnowsThem)
{
    const Reference first = knowing(9, {}), second = knowing(9, {{5, 1}}),
                    third = knowing(9, {{70, 70}});
    std::vector<Association> associations(3);
    associations[0].reference = &first;
    associations[1].reference = &second;
    associations[2].reference = &third;
    associations[0].planes = {{0, 0}};
    associations[1].movingPlanes = {{0, 0}};
    associations[2].planes = {{0, 0}};
    EXPECT_EQ(rememberedInliers(associations, twoPlanes(9), 2)[0].points, 5);
}

TEST(Surfaces, whatMovesIsCountedAgainstThem)
{
    Association association;
    association.points = {trackAt(2)};
    association.movingPoints = {trackAt(4), trackAt(15), trackAt(16), trackAt(99)};
    std::vector<InlierRatio> surfaces{{1, 1}, {0, 0}};
    countMoving({association, association}, twoPlanes(9), surfaces);
    EXPECT_EQ(surfaces[0].points, 1 + 2);
    EXPECT_EQ(surfaces[0].inliers, 1);
    EXPECT_EQ(surfaces[1].points, 4);
    std::vector<InlierRatio> none;  // as in the paper
    countMoving({association}, twoPlanes(9), none);
    EXPECT_TRUE(none.empty());
}

/** Of 20 x 20 pixels with depth. */
Features twoPlanesWithDepth()
{
    Features out = twoPlanes(0);
    out.frame.depth = cv::Mat(20, 20, CV_32FC1, cv::Scalar(2));
    return out;
}

int numReadings(const cv::Mat& depth) { return cv::countNonZero(depth == depth); }

MovingRegions movingCell(const cv::Rect& cell, int numCompared)
{
    MovingRegions out;
    out.cells = {cell};
    out.numCompared = numCompared;
    return out;
}

TEST(Surfaces, theStillPartIsWithoutMovingRegions)
{
    const Features features = twoPlanesWithDepth();
    const RgbdFrame still = stillPart(features, movingCell({2, 3, 4, 5}, 9), {});
    EXPECT_EQ(numReadings(still.depth), 400 - 4 * 5);
    EXPECT_TRUE(std::isnan(still.depth.at<float>(3, 2)));
    EXPECT_EQ(still.depth.at<float>(2, 2), 2);
    EXPECT_EQ(numReadings(features.frame.depth), 400) << "the frame itself stays";
}

TEST(Surfaces, theStillPartIsWithoutPlanesThatReachIntoThemAndContradict)
{
    const Features features = twoPlanesWithDepth();
    const MovingRegions moving = movingCell({12, 3, 4, 5}, 9);
    // (2 + inliers) / (2 + points): 0.5 is not less than half.
    EXPECT_EQ(numReadings(stillPart(features, moving, {{11, 4}, {10, 4}}).depth), 400 - 4 * 5);
    const RgbdFrame still = stillPart(features, moving, {{11, 4}, {11, 4}});
    EXPECT_EQ(numReadings(still.depth), 200) << "the left plane does not reach into the region";
    EXPECT_EQ(still.depth.at<float>(5, 5), 2);
    EXPECT_TRUE(std::isnan(still.depth.at<float>(5, 15)));
}

TEST(Surfaces, theStillPartIsAllIfNothingSurelyMoves)
{
    const Features features = twoPlanesWithDepth();
    EXPECT_EQ(numReadings(stillPart(features, {}, {{11, 4}, {11, 4}}).depth), 400);
    const MovingRegions few = movingCell({2, 3, 4, 5}, 10);  // a tenth, and not more
    EXPECT_EQ(numReadings(stillPart(features, few, {{11, 4}, {11, 4}}).depth), 400);
}

TEST(Surfaces, depthOfWhatHasMovedIsNotCompared)
{
    const Features features = twoPlanesWithDepth();
    const RgbdFrame frame = withoutMoved(features, {{11, 4}, {10, 4}});
    EXPECT_EQ(numReadings(frame.depth), 200) << "0.5 is not less than half";
    EXPECT_TRUE(std::isnan(frame.depth.at<float>(5, 5)));
    EXPECT_EQ(frame.depth.at<float>(5, 15), 2);
    EXPECT_EQ(numReadings(features.frame.depth), 400) << "the frame itself stays";
    EXPECT_EQ(withoutMoved(features, {}).depth.data, features.frame.depth.data) << "not copied";
}

/** Plane 1 of the frame has moved; in the reference, it was plane 0. */
TEST(Surfaces, samplesOfWhatHasMovedSinceAreLeftOut)
{
    Reference reference;
    reference.planes = twoPlanes(0).planes;
    reference.images = std::make_shared<KeyframeImages>();
    RgbdFrame& frame = reference.images->frame;
    frame = twoPlanesWithDepth().frame;
    frame.camera.width = frame.camera.height = 20;
    frame.camera.fx = frame.camera.fy = 20;
    frame.camera.cx = frame.camera.cy = 9.5;
    reference.images->surface = SurfaceSamples(frame, DepthNoise());
    Association association;
    association.reference = &reference;
    const size_t all = reference.images->surface.points_cam.size();
    ASSERT_GT(all, 300U);
    const std::vector<InlierRatio> moved{{0, 0}, {11, 4}};
    EXPECT_EQ(stillSamples(association, moved).get(), &reference.images->surface)
        << "no plane is matched; not copied";
    association.movingPlanes = {{0, 1}};
    const SurfaceSamples still = *stillSamples(association, moved);
    EXPECT_NEAR(static_cast<double>(still.points_cam.size()), static_cast<double>(all) / 2, 20);
    for (const Eigen::Vector3f& point : still.points_cam)
    {
        EXPECT_GT(point.x(), 0) << "plane 0 is on the left";
    }
    reference.images.reset();
    EXPECT_EQ(stillSamples(association, moved), nullptr);
}

/** A screen that fills half of the view and moves: with points of it in new key frames, the motion
 * follows it by 17 mm a frame from frame 73 on. */
TEST(Surfaces, newKeyFramesTakeNoPointsFromWhatMoves)
{
    const SimulatedSequence half("half", SimulationParams(), 2);
    Odometry odometry{OdometryParams()};
    Eigen::Isometry3d T_world_cam;
    for (int i = 0; i < 91; ++i)
    {
        T_world_cam = odometry.process(half.frame(i)).pose.mean;
    }
    const Eigen::Vector3d error = T_world_cam.translation() - half.trueMotion(0, 90).translation();
    EXPECT_LT(error.norm(), 0.02);
}

/** From 15 images a second, the motion followed a screen that begins to move: 144 mm over a second,
 * because what it had shown while it stood outweighed what it showed now. It still does for two
 * frames; the one that turns to the room knows that those before may be wrong. */
TEST(Surfaces, whatHasStoodIsNotFollowedWhenItBeginsToMove)
{
    SimulationParams params;
    params.width = 320;
    params.height = 240;
    params.fps = 15;
    const SimulatedSequence half("half", params, 2);
    Odometry odometry{OdometryParams()};
    std::vector<Eigen::Isometry3d> T_world_cam;
    double worst = 0;
    for (int i = 0; i < 60; ++i)
    {
        const OdometryResult result = odometry.process(half.frame(i));
        T_world_cam.push_back(result.pose.mean);
        if (i > 0)
        {
            const Eigen::Isometry3d step =
                half.trueMotion(i - 1, i).inverse() * result.increment.mean;
            const double most = 5 * result.diagnostics.maxSigmaTranslation;
            EXPECT_LT(step.translation().norm(), std::max(0.01, most)) << "frame " << i;
        }
        if (i >= 15)
        {
            const auto before = static_cast<size_t>(i - 15);
            const Eigen::Isometry3d motion = T_world_cam[before].inverse() * T_world_cam.back();
            const Eigen::Isometry3d error = half.trueMotion(i - 15, i).inverse() * motion;
            worst = std::max(worst, error.translation().norm());
        }
    }
    EXPECT_LT(worst, 0.02);
}

/** Two people who move in front of a camera that is held still: 10 mm over a second if the surfaces
 * on them count fully, 8 mm if points within five times the limit count at the start. */
TEST(Surfaces, peopleWhoTalkDoNotMoveTheCamera)
{
    test::CachedSequence seated("seated", 640, 480);
    Odometry odometry{OdometryParams()};
    const int second = 30, numFrames = 75;
    std::vector<Eigen::Isometry3d> T_world_cam;
    double squares = 0;
    for (int i = 0; i < numFrames; ++i)
    {
        T_world_cam.push_back(odometry.process(seated.frame(i)).pose.mean);
        if (i >= second)
        {
            const Eigen::Isometry3d motion =
                T_world_cam[static_cast<size_t>(i - second)].inverse() * T_world_cam.back();
            const Eigen::Isometry3d truth = seated.sequence().trueMotion(i - second, i);
            squares += (motion.translation() - truth.translation()).squaredNorm();
        }
    }
    EXPECT_LT(std::sqrt(squares / (numFrames - second)), 0.003);
}
}  // namespace pointplane
