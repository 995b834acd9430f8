// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/association.h>

#include <cmath>

#include "test_trajectories.h"
#include <gtest/gtest.h>

using namespace pointplane;

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

TEST(NearestIndex, findsTheNearest)
{
    const std::vector<double> v{0, 1, 2.5, 10};
    EXPECT_EQ(nearestIndex(v, -5), 0u);
    EXPECT_EQ(nearestIndex(v, 0.4), 0u);
    EXPECT_EQ(nearestIndex(v, 0.6), 1u);
    EXPECT_EQ(nearestIndex(v, 2.5), 2u);
    EXPECT_EQ(nearestIndex(v, 99), 3u);
}

TEST(NearestIndex, tiesGoToTheOneTheBisectionSeesFirst)
{
    // Traced by hand through the script's loop: begin 0, end 4 -> middle 2 first.
    EXPECT_EQ(nearestIndex({0, 1, 2, 3}, 1.5), 2u);
    EXPECT_EQ(nearestIndex({0, 1, 2}, 0.5), 0u);  // index 0 is the start value, "<" is strict
}

TEST(Associate, greedyNearestFirstOneToOne)
{
    // 1.0 is nearest to 1.01, so 1.02 has to take 1.03 although 1.01 is as near.
    EXPECT_EQ(associate({1.0, 1.02}, {1.01, 1.03}, 0, 0.02), (Pairs{{0, 0}, {1, 1}}));
    EXPECT_EQ(associate({0, 0.018}, {0.017}, 0, 0.02), (Pairs{{1, 0}}));
}

TEST(Associate, boundIsStrictAndOffsetIsAddedToTheSecond)
{
    EXPECT_TRUE(associate({0.0}, {0.5}, 0, 0.5).empty());
    EXPECT_EQ(associate({0.0}, {0.5}, 0, 0.5000001), (Pairs{{0, 0}}));
    EXPECT_EQ(associate({10.0}, {0.0}, 10, 0.02), (Pairs{{0, 0}}));
    EXPECT_TRUE(associate({}, {1.0}, 0, 0.02).empty());
}

TEST(SampleTruth, nearestIsLimitedToTwiceTheMedianInterval)
{
    const Trajectory truth = randomTrajectory(11, 1);  // 100.0 .. 101.0
    const SampledTruth s = sampleTruth(truth, {100.04, 101.15, 101.25, 99.7}, 0);
    EXPECT_NEAR(s.maxTimeDifference, 0.2, 1e-9);
    EXPECT_EQ(s.valid, (std::vector<char>{1, 1, 0, 0}));
    EXPECT_EQ(s.stamps[0], 100.0);
    EXPECT_TRUE(s.poses[1].isApprox(truth.poses[10], 0));
}

TEST(SampleTruth, interpolatesOnTheScrewsStraightParts)
{
    std::vector<StampedPose> poses(2);
    poses[1].stamp = 1;
    poses[1].pose.translation() << 2, 0, 0;
    poses[1].pose.linear() = so3Exp({0, 0, 1});
    const Trajectory truth = makeTrajectory("t", poses);
    const SampledTruth s = sampleTruth(truth, {0.25, 1.0, 1.1, -0.1}, 0, TruthAt::Interpolated);
    EXPECT_EQ(s.valid, (std::vector<char>{1, 1, 0, 0}));  // no extrapolation
    EXPECT_NEAR(s.poses[0].translation().x(), 0.5, 1e-12);
    EXPECT_TRUE(s.poses[0].linear().isApprox(so3Exp({0, 0, 0.25}), 1e-12));
    EXPECT_TRUE(s.poses[1].isApprox(truth.poses[1], 0));
}

/** What the camera did there is not known: a straight line over the hole would be its fault. */
TEST(SampleTruth, interpolatesOverNoHole)
{
    const Trajectory truth = withHole(randomTrajectory(41, 1), 10, 20);  // 100.9 .. 102.0
    const SampledTruth s = sampleTruth(
        truth,
        {100.85, 100.9 + 1e-7, 100.95, 101.95, 102 - 1e-7, 102.05},
        0,
        TruthAt::Interpolated);
    EXPECT_EQ(s.valid, (std::vector<char>{1, 1, 0, 0, 1, 1}));
    EXPECT_TRUE(s.poses[1].isApprox(truth.poses[9], 0));  // a rounded stamp is no hole
    EXPECT_TRUE(s.poses[4].isApprox(truth.poses[10], 0));
}
