// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/MovingRegions.h>

#include "hell_frames.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** What has moved in frame `current` since the frame `earlier`, by true poses. */
MovingRegions movedSince(test::CachedSequence& sequence, int earlier, int current)
{
    const RgbdFrame before = sequence.frame(earlier), now = sequence.frame(current);
    return findMovingRegions(
        now, {{&before, sequence.sequence().trueMotion(earlier, current), 0.01}}, DepthNoise());
}

/** A wall at 2 m, and the camera in front of it. */
RgbdFrame wall(float z = 2)
{
    RgbdFrame out;
    out.depth = cv::Mat(240, 320, CV_32FC1, cv::Scalar(z));
    out.camera = {262, 262, 159.5, 119.5, 320, 240};
    return out;
}

const cv::Rect kBox(120, 80, 64, 64);
}  // namespace

TEST(MovingRegions, aStillSceneHasNone)
{
    for (const int current : {5, 20, 50})
    {
        const MovingRegions moving = movedSince(test::CachedSequence::desk(), 0, current);
        EXPECT_GT(moving.numCompared, 400);
        EXPECT_LT(moving.share(), 0.003) << current;
    }
}

TEST(MovingRegions, whatHasComeIsMarkedWhereItIs)
{
    const RgbdFrame before = wall();
    RgbdFrame now = wall();
    now.depth(kBox) = 1;
    const EarlierView view{&before, Eigen::Isometry3d::Identity(), 0};
    const MovingRegions moving = findMovingRegions(now, {view}, DepthNoise());
    int area = 0;
    for (const cv::Rect& cell : moving.cells)
    {
        EXPECT_GT((cell & kBox).area(), 0);
        area += (cell & kBox).area();
    }
    EXPECT_GT(area, 0.85 * kBox.area());
}

TEST(MovingRegions, whatIsUncoveredIsNot)
{
    RgbdFrame before = wall();
    before.depth(kBox) = 1;
    const RgbdFrame now = wall();
    const EarlierView view{&before, Eigen::Isometry3d::Identity(), 0};
    EXPECT_TRUE(findMovingRegions(now, {view}, DepthNoise()).cells.empty());
}

/** The nearest frame still saw the thing there; an older one did not. */
TEST(MovingRegions, anyOfTheEarlierFramesTells)
{
    const RgbdFrame older = wall();
    RgbdFrame now = wall();
    now.depth(kBox) = 1;
    const RgbdFrame newer = now;
    const EarlierView fromOlder{&older, Eigen::Isometry3d::Identity(), 0},
        fromNewer{&newer, Eigen::Isometry3d::Identity(), 0};
    EXPECT_TRUE(findMovingRegions(now, {fromNewer}, DepthNoise()).cells.empty());
    EXPECT_GT(findMovingRegions(now, {fromNewer, fromOlder}, DepthNoise()).share(), 0.05);
}

TEST(MovingRegions, aLoneReadingIsNoise)
{
    const RgbdFrame before = wall();
    RgbdFrame now = wall();
    now.depth(cv::Rect(150, 110, 4, 4)) = 1;
    const EarlierView view{&before, Eigen::Isometry3d::Identity(), 0};
    EXPECT_TRUE(findMovingRegions(now, {view}, DepthNoise()).cells.empty());
}

TEST(MovingRegions, nothingToCompareWithTellsNothing)
{
    const RgbdFrame now = wall();
    EXPECT_EQ(findMovingRegions(now, {}, DepthNoise()).numCompared, 0);
    EXPECT_EQ(findMovingRegions(now, {}, DepthNoise()).share(), 0);
    RgbdFrame blind = wall(std::numeric_limits<float>::quiet_NaN());
    const EarlierView view{&blind, Eigen::Isometry3d::Identity(), 0};
    EXPECT_EQ(findMovingRegions(now, {view}, DepthNoise()).numCompared, 0);
    EXPECT_EQ(
        findMovingRegions(blind, {{&now, view.T_earlier_cur, 0}}, DepthNoise()).numCompared, 0);
}

TEST(MovingRegions, tinyAndOddImages)
{
    for (const cv::Size size : {cv::Size(1, 1), cv::Size(2, 3), cv::Size(3, 3), cv::Size(7, 401)})
    {
        RgbdFrame frame = wall();
        frame.depth = cv::Mat(size, CV_32FC1, cv::Scalar(1));
        const EarlierView view{&frame, Eigen::Isometry3d::Identity(), 0};
        EXPECT_TRUE(findMovingRegions(frame, {view}, DepthNoise()).cells.empty());
    }
}

/** By the odometry's own poses, against the scene's exact masks. */
TEST(MovingRegions, aPersonWhoWalksIsCalledMoving)
{
    test::CachedSequence person("person");
    Odometry odometry{OdometryParams()};
    int cells = 0, right = 0, frames = 0;
    for (int i = 0; i < 30; i += 3)
    {
        const OdometryResult result = odometry.process(person.frame(i));
        const cv::Mat labels = person.sequence().trueMovers(i).labels;
        for (const cv::Rect& cell : odometry.features().moving.cells)
        {
            ++cells;
            right += cv::countNonZero(labels(cell)) > 0;
        }
        frames += result.diagnostics.movingShare > 0.03;
    }
    EXPECT_GE(frames, 5);
    EXPECT_GT(cells, 100);
    EXPECT_GT(right, 0.95 * cells);
}
}  // namespace pointplane
