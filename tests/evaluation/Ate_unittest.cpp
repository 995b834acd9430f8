// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/ate.h>

#include "test_trajectories.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

using namespace pointplane;

namespace
{
Eigen::Isometry3d someMotion()
{
    Vector6d xi;
    xi << 3, -2, 1, 0.5, -0.7, 1.1;
    return se3Exp(xi);
}
}  // namespace

TEST(AlignPoints, recoversAMotionAndNeverReflects)
{
    const Eigen::Isometry3d T = someMotion();
    const Eigen::Matrix3Xd b = Eigen::Matrix3Xd::Random(3, 20);
    EXPECT_TRUE(alignPoints(T * b, b).isApprox(T, 1e-12));
    Eigen::Matrix3Xd mirrored = b;
    mirrored.row(2) *= -1;
    EXPECT_NEAR(alignPoints(mirrored, b).linear().determinant(), 1, 1e-12);
}

TEST(Ate, alignmentRemovesTheWorldFrame)
{
    const Trajectory truth = randomTrajectory(60, 4);
    Trajectory moved = truth;
    for (Eigen::Isometry3d& T : moved.poses)
    {
        T = someMotion() * T;
    }
    AteOptions options;
    const AteResult r = absoluteTrajectoryError(truth, moved, options);
    EXPECT_LT(r.translation.max, 1e-12);
    EXPECT_EQ(r.errors.size(), 60u);
    EXPECT_TRUE(r.T_truth_estimate.isApprox(someMotion().inverse(), 1e-9));
    options.alignment = Alignment::FirstPose;
    EXPECT_LT(absoluteTrajectoryError(truth, moved, options).translation.max, 1e-12);
    options.alignment = Alignment::None;
    EXPECT_GT(absoluteTrajectoryError(truth, moved, options).translation.min, 1);
}

TEST(Ate, handValueWithoutAlignment)
{
    Trajectory truth = randomTrajectory(4, 1);
    Trajectory estimate = truth;
    estimate.poses[1].translation().x() += 0.3;
    estimate.poses[2].translation().z() -= 0.4;
    AteOptions options;
    options.alignment = Alignment::None;
    const AteResult r = absoluteTrajectoryError(truth, estimate, options);
    EXPECT_NEAR(r.translation.rmse, 0.25, 1e-12);
    EXPECT_NEAR(r.translation.mean, 0.175, 1e-12);
    EXPECT_THAT(describe(options, r, 4), testing::HasSubstr("not aligned, association 0.02 s, 4"));
}

TEST(Ate, alignedErrorIsTheSmallest)
{
    const Trajectory truth = randomTrajectory(60, 4);
    const Trajectory estimate = perturbed(truth, 0.05, 5);
    const AteResult best = absoluteTrajectoryError(truth, estimate, {});
    for (int axis = 0; axis < 6; ++axis)
    {
        double squares = 0;
        for (std::size_t k = 0; k < 60; ++k)
        {
            squares += (se3Exp(1e-3 * Vector6d::Unit(axis)) * best.T_truth_estimate *
                            estimate.poses[k].translation() -
                        truth.poses[k].translation())
                           .squaredNorm();
        }
        EXPECT_GT(std::sqrt(squares / 60), best.translation.rmse);
    }
}

TEST(Ate, needsTwoAssociatedPoses)
{
    const Trajectory truth = randomTrajectory(10, 4);
    Trajectory between = truth;
    for (double& stamp : between.stamps)
    {
        stamp += 0.05;
    }
    EXPECT_THROW((void)absoluteTrajectoryError(truth, between, {}), std::runtime_error);
    AteOptions options;
    options.offset = -0.05;
    EXPECT_LT(absoluteTrajectoryError(truth, between, options).translation.max, 1e-12);
}
