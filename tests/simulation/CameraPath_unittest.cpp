// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/simulation/CameraPath.h>

#include <cmath>

#include "matchers.h"
#include <gtest/gtest.h>

namespace pointplane
{
TEST(CameraPath, withoutHandLooksAtTheTargetWithTheImageUpright)
{
    CameraMotion motion;
    motion.eye = {1, 2, 1.5};
    motion.target = {3, 2, 1.5};
    const Eigen::Isometry3d T_world_cam = CameraPath(motion, 0, 1).pose(3);
    Eigen::Matrix3d R;  // columns: right, down, forward
    R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    EXPECT_THAT(T_world_cam.linear(), test::IsMatrixNear(R, 1e-12));
    EXPECT_THAT(T_world_cam.translation(), test::IsMatrixNear(motion.eye, 1e-12));
}

TEST(CameraPath, handMovesAtTheSpeedAskedFor)
{
    CameraMotion motion;
    motion.tremorSpeed = motion.tremorTurnRate = 0;
    const double dt = 1e-3;
    double v2 = 0, w2 = 0;
    int n = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed)
    {
        const CameraPath path(motion, 1, seed);
        for (double t = 0; t < 60; t += 0.5)
        {
            const Vector6d xi = se3Log(path.pose(t).inverse() * path.pose(t + dt)) / dt;
            v2 += xi.head<3>().squaredNorm();
            w2 += xi.tail<3>().squaredNorm();
            ++n;
        }
    }
    EXPECT_NEAR(std::sqrt(v2 / n), motion.handSpeed, 0.05 * motion.handSpeed);
    EXPECT_NEAR(std::sqrt(w2 / n), motion.handTurnRate, 0.05 * motion.handTurnRate);
}

TEST(CameraPath, isSmooth)
{
    const CameraPath path(CameraMotion{}, 1, 3);
    const double dt = 1e-3;
    for (double t = 0; t < 18; t += 0.1)
    {
        const Vector6d before = se3Log(path.pose(t - dt).inverse() * path.pose(t)) / dt;
        const Vector6d after = se3Log(path.pose(t).inverse() * path.pose(t + dt)) / dt;
        EXPECT_LT((after - before).norm(), 5 * dt) << "acceleration beyond 5 m/s^2 at " << t;
    }
}

TEST(CameraPath, seedDecides)
{
    const CameraMotion motion;
    EXPECT_TRUE(CameraPath(motion, 1, 3).pose(2).isApprox(CameraPath(motion, 1, 3).pose(2), 0));
    EXPECT_FALSE(CameraPath(motion, 1, 3).pose(2).isApprox(CameraPath(motion, 1, 4).pose(2), 1e-3));
}

TEST(CameraPath, baseMotionsDrift_orbit_andTurn)
{
    CameraMotion motion;
    motion.velocity = {0.5, 0, 0};
    EXPECT_NEAR(CameraPath(motion, 0, 1).pose(4).translation().x(), 2, 1e-12);

    CameraMotion orbit;
    orbit.orbitAmplitude = 1;
    orbit.orbitPeriod = 8;
    const Eigen::Isometry3d T = CameraPath(orbit, 0, 1).pose(2);
    EXPECT_NEAR((T.translation() - orbit.target).norm(), 1, 1e-12);
    EXPECT_THAT(T * Eigen::Vector3d(0, 0, 1), test::IsMatrixNear(orbit.target, 1e-12));
    EXPECT_NEAR(T.translation().y(), -std::sin(1.0), 1e-12);

    CameraMotion turn;
    turn.turnPeriod = 10;
    turn.turnRadius = 0.5;
    const CameraPath path(turn, 0, 1);
    EXPECT_THAT(path.pose(0), test::IsNearPose(path.pose(10), 1e-9, 1e-9));
    EXPECT_NEAR((path.pose(0).translation() - path.pose(5).translation()).norm(), 1, 1e-12);
}
}  // namespace pointplane
