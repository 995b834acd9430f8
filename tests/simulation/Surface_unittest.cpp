// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/simulation/Random.h>
#include <pointplane/simulation/Surface.h>

#include <cmath>

#include "matchers.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
Surface make(Surface::Kind kind)
{
    Surface s;
    s.kind = kind;
    s.width = 2;
    s.height = 1;
    s.radius = 0.5;
    return s;
}
}  // namespace

TEST(Surface, rectangleIsHitFromItsFrontWithinItsEdges)
{
    const Surface s = make(Surface::Kind::Rectangle);
    const Eigen::Vector3d down(0, 0, -1);
    EXPECT_DOUBLE_EQ(s.inverseDepth({1, 0.5, 4}, down), 0.25);
    EXPECT_DOUBLE_EQ(s.inverseDepth({1.999, 0.001, 4}, down), 0.25);
    EXPECT_EQ(s.inverseDepth({2.001, 0.5, 4}, down), 0);
    EXPECT_EQ(s.inverseDepth({1, -0.001, 4}, down), 0);
    EXPECT_EQ(s.inverseDepth({1, 0.5, 4}, -down), 0);
    EXPECT_EQ(s.inverseDepth({1, 0.5, -4}, -down), 0) << "seen from behind";
}

TEST(Surface, discIsRound)
{
    const Surface s = make(Surface::Kind::Disc);
    EXPECT_DOUBLE_EQ(s.inverseDepth({0.35, 0.35, 2}, {0, 0, -1}), 0.5);
    EXPECT_EQ(s.inverseDepth({0.36, 0.36, 2}, {0, 0, -1}), 0);
}

TEST(Surface, cylinderIsHitOnItsNearSide)
{
    const Surface s = make(Surface::Kind::Cylinder);
    EXPECT_DOUBLE_EQ(s.inverseDepth({2.5, 0, 0.5}, {-1, 0, 0}), 0.5);
    EXPECT_EQ(s.inverseDepth({2.5, 0, 1.1}, {-1, 0, 0}), 0) << "above it";
    EXPECT_EQ(s.inverseDepth({2.5, 0.51, 0.5}, {-1, 0, 0}), 0) << "beside it";
    EXPECT_EQ(s.inverseDepth({2.5, 0, 0.5}, {1, 0, 0}), 0) << "behind the eye";
}

TEST(Surface, pictureCoordinatesRoundTripAndPointsAreSeenWhereTheyAre)
{
    Random random({5});
    for (const auto kind : {Surface::Kind::Rectangle, Surface::Kind::Disc, Surface::Kind::Cylinder})
    {
        Surface s = make(kind);
        const Eigen::Matrix3d R =
            so3Exp(Eigen::Vector3d(random.uniform(-2, 2), random.uniform(-2, 2), 0.3));
        s.e1 = R.col(0);
        s.e2 = R.col(1);
        s.e3 = R.col(2);
        s.origin = {0.3, -1, 2};
        for (int i = 0; i < 50; ++i)
        {
            const Eigen::Vector2d at(
                random.uniform(0.2, 0.8) * s.pictureSize().x(),
                random.uniform(0.2, 0.8) * s.pictureSize().y());
            Eigen::Vector3d point, normal;
            s.pictureToWorld(at.x(), at.y(), point, normal);
            EXPECT_THAT(s.worldToPicture(point), test::IsMatrixNear(at, 1e-9));
            EXPECT_NEAR(normal.norm(), 1, 1e-12);
            const Eigen::Vector3d eye = point + 2 * normal + 0.1 * s.e3.unitOrthogonal();
            EXPECT_NEAR(s.inverseDepth(eye, (point - eye) / 2.5), 1 / 2.5, 1e-9);
        }
    }
}
}  // namespace pointplane
