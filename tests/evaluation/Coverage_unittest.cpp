// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/coverage.h>

#include "test_trajectories.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace pointplane;
using testing::HasSubstr;

namespace
{
/** Poses at 10 Hz from 100 s on, `status` of each. */
Trajectory estimateOf(const std::vector<FrameStatus>& status)
{
    std::vector<StampedPose> poses;
    for (std::size_t k = 0; k < status.size(); ++k)
    {
        StampedPose pose;
        pose.stamp = 100 + 0.1 * static_cast<double>(k);
        pose.status = status[k];
        pose.cov = Matrix6d::Identity();
        poses.push_back(pose);
    }
    Trajectory out = makeTrajectory("estimate", poses);
    out.marksFrames = true;
    return out;
}

/** 151 frames of which every fifth is tracked: 31. */
std::vector<FrameStatus> mostlyLost()
{
    std::vector<FrameStatus> out(151, FrameStatus::Lost);
    for (std::size_t k = 0; k < out.size(); k += 5)
    {
        out[k] = FrameStatus::Tracked;
    }
    return out;
}
}  // namespace

TEST(Coverage, lostFramesDoNotCount)
{
    const Trajectory truth = randomTrajectory(151, 1);
    const Coverage all = coverageOf(truth, estimateOf(std::vector<FrameStatus>(151)), 0);
    EXPECT_NEAR(all.share, 1, 1e-9);
    EXPECT_EQ(all.tracked, 151u);

    const Trajectory estimate = estimateOf(mostlyLost());
    for (const Trajectory& t : {estimate, withoutLost(estimate)})
    {
        const Coverage lost = coverageOf(truth, t, 0);
        EXPECT_NEAR(lost.share, 0.2, 1e-9);  // 30 of 150 intervals end at a tracked frame
        EXPECT_EQ(lost.tracked, 31u);
        EXPECT_EQ(lost.lost, 120u);
        EXPECT_THAT(
            describe(lost),
            HasSubstr(
                "coverage 20.0 % of the recording: 31 frames tracked, 0 predicted, 120 lost"));
    }
}

TEST(Coverage, predictedFramesHaveAPoseButWereNotTracked)
{
    std::vector<FrameStatus> status(101);
    std::fill(status.begin() + 11, status.begin() + 61, FrameStatus::Predicted);
    const Trajectory estimate = withoutLost(estimateOf(status));
    EXPECT_EQ(estimate.size(), 101u);
    const Coverage c = coverageOf(randomTrajectory(101, 1), estimate, 0);
    EXPECT_NEAR(c.share, 0.5, 1e-9);
    EXPECT_EQ(c.predicted, 50u);
}

TEST(Coverage, isOfTheRecordingNotOfGroundTruthThatRunsOn)
{
    const Trajectory estimate = estimateOf(std::vector<FrameStatus>(101));
    EXPECT_NEAR(coverageOf(randomTrajectory(1001, 1), estimate, 0).share, 1, 1e-9);
    // Where ground truth ends early, the score speaks for that part only.
    EXPECT_NEAR(coverageOf(randomTrajectory(51, 1), estimate, 0).share, 0.5, 1e-9);
    // A part of a recording looks like a whole one.
    EXPECT_THAT(
        describe(coverageOf(randomTrajectory(1001, 1), estimate, 0)),
        testing::EndsWith("0 lost; 10.0 % of the ground truth's time"));
    EXPECT_THAT(
        describe(coverageOf(randomTrajectory(105, 1), estimate, 0)), testing::EndsWith("0 lost"));
    // Who wrote the file did not tell how long the recording is.
    Trajectory unmarked = estimate;
    unmarked.marksFrames = false;
    const Coverage c = coverageOf(randomTrajectory(1001, 1), unmarked, 0);
    EXPECT_NEAR(c.share, 0.1, 1e-9);
    EXPECT_THAT(describe(c), HasSubstr("of the ground truth's time, frames not marked"));
}

TEST(Coverage, holesOfTheGroundTruthAreNotScored)
{
    Trajectory estimate = estimateOf(std::vector<FrameStatus>(151));
    const Trajectory truth = withHole(randomTrajectory(151, 1), 50, 99);  // 49 poses, 50 steps
    EXPECT_NEAR(coverageOf(truth, estimate, 0).share, 100. / 150, 1e-9);
    Trajectory begins = truth;  // a step that begins outside of the hole and ends in it
    begins.stamps[49] += 0.05;
    EXPECT_NEAR(coverageOf(begins, estimate, 0).share, 100.5 / 150, 1e-9);

    // Where the recording is not known, the ground truth's time has no holes either.
    estimate.marksFrames = false;
    EXPECT_NEAR(coverageOf(truth, estimate, 0).share, 1, 1e-9);
    Trajectory late = randomTrajectory(151, 1);
    late.stamps.back() += 3e9;  // one wrong stamp
    EXPECT_NEAR(coverageOf(late, estimate, 0).share, 1, 1e-9);
}

/** A wrong stamp says nothing about how many frames were tracked. */
TEST(Coverage, oneStampFromTheFutureLeavesTheShareAsItIs)
{
    const Trajectory truth = randomTrajectory(151, 1);
    Trajectory tracked = estimateOf(std::vector<FrameStatus>(151));
    tracked.stamps.back() += 3e9;
    EXPECT_NEAR(coverageOf(truth, tracked, 0).share, 149. / 150, 1e-9);
    Trajectory lost = withoutLost(estimateOf(mostlyLost()));
    lost.lostStamps.back() += 3e9;
    EXPECT_NEAR(coverageOf(truth, lost, 0).share, 0.2, 1e-2);
    lost.lostWithoutTime = 150;  // frames of the recording, too
    EXPECT_NEAR(coverageOf(truth, lost, 0).share, 0.1, 1e-2);
}

TEST(Coverage, poseOfALostFrameGivesWayToOneWithTheSameStamp)
{
    std::vector<StampedPose> poses(3);
    poses[1].stamp = poses[2].stamp = 1;
    poses[1].pose.translation().x() = 7;
    poses[2].status = FrameStatus::Lost;
    const Trajectory t = makeTrajectory("t", poses);
    ASSERT_EQ(t.size(), 2u);
    EXPECT_EQ(t.poses[1].translation().x(), 7);
    EXPECT_EQ(t.lostWithoutTime, 1u);
}

TEST(Coverage, withoutLostKeepsWhatWasMeasured)
{
    const Trajectory measured = withoutLost(estimateOf(mostlyLost()));
    ASSERT_EQ(measured.size(), 31u);
    EXPECT_EQ(measured.covs.size(), 31u);
    EXPECT_NEAR(measured.stamps[1], 100.5, 1e-9);
    EXPECT_EQ(measured.lostStamps.size(), 120u);
}
