// SPDX-License-Identifier: BSD-3-Clause
// Which points that stand in the image the motion of the camera tells to be marks.
#include <pointplane/core/se3.h>

#include <opencv2/core.hpp>

#include <cmath>
#include <cstdint>

#include "standing_points.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** A point that stands in the centre of the image, after marks on the circle are known. */
struct StandingPoint
{
    StandingPoint()
    {
        EXPECT_FALSE(standing::teachMarks(marks));
        EXPECT_TRUE(standing::teachMarks(marks));
        seen.add(
            standing::pointAt({160, 120}, standing::kDepth),
            standing::pointAt({160, 120}, standing::kDepth));
        marks.split(seen.association, standing::camera());
        EXPECT_EQ(seen.association.doubtedPoints.size(), 1);
    }

    /** Whether it is a mark after a motion of the camera. */
    bool isMarkAfter(const Eigen::Isometry3d& T_cur_world, const Matrix6d& cov = Matrix6d::Zero())
    {
        marks.learn({seen.association}, standing::camera(), PoseGaussian{T_cur_world, cov});
        return marks.mask().at<std::uint8_t>(120, 160) > 0;
    }

    ImageMarks marks{standing::kWindowPx};
    standing::Seen seen;
};

Eigen::Isometry3d aside(double x_m)
{
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.translation().x() = x_m;
    return out;
}
}  // namespace

TEST(ImageMarksMotion, aPointThatShouldHaveMovedIsAMark)
{
    EXPECT_FALSE(StandingPoint().isMarkAfter(aside(0.006)));  // 0.8 px
    EXPECT_TRUE(StandingPoint().isMarkAfter(aside(0.009)));   // 1.2 px
}

TEST(ImageMarksMotion, itIsNoMarkWithinThreeSigmasOfTheMotion)
{
    // The motion moves it by 6.5 px, which is 5.5 px too much.
    const double perMetre_px = std::sqrt(3.0) * standing::camera().fx / standing::kDepth;
    const auto cov = [&](double threeSigmas_px) -> Matrix6d
    {
        Matrix6d out = Matrix6d::Zero();
        out.topLeftCorner<3, 3>().diagonal().setConstant(
            std::pow(threeSigmas_px / 3 / perMetre_px, 2));
        return out;
    };
    EXPECT_TRUE(StandingPoint().isMarkAfter(aside(0.05), cov(5.4)));
    EXPECT_FALSE(StandingPoint().isMarkAfter(aside(0.05), cov(5.6)));
}

TEST(ImageMarksMotion, anUncertainTurnMovesThePointUnlessItIsAboutIt)
{
    Matrix6d cov = Matrix6d::Zero();
    cov.bottomRightCorner<3, 3>().diagonal().setConstant(1e-4);
    EXPECT_FALSE(StandingPoint().isMarkAfter(aside(0.05), cov));
    Eigen::Matrix<double, 6, 3> turn;
    turn << hat(aside(0.05) * Eigen::Vector3d(0, 0, standing::kDepth)), Eigen::Matrix3d::Identity();
    cov = 1e-4 * turn * turn.transpose() + 1e-9 * Matrix6d::Identity();
    EXPECT_TRUE(StandingPoint().isMarkAfter(aside(0.05), cov));
}

TEST(ImageMarksMotion, theMotionIsThatSinceTheReference)
{
    StandingPoint point;
    point.seen.reference.T_world_cam = aside(0.5);
    EXPECT_FALSE(point.isMarkAfter(aside(-0.5)));
    EXPECT_TRUE(point.isMarkAfter(aside(-0.4)));
}

TEST(ImageMarksMotion, nothingIsSaidOfPointsBehindTheCamera)
{
    Eigen::Isometry3d turned = aside(0.5);
    turned.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
    EXPECT_FALSE(StandingPoint().isMarkAfter(turned));
}

/** It moves through a mark. */
TEST(ImageMarksMotion, aPointThatMovesAsItShouldOrNotIsNone)
{
    StandingPoint known;
    const Eigen::Vector2d onMark_px = standing::Circle().place_px(0);
    standing::Seen moving;
    moving.add(
        standing::pointAt(onMark_px - Eigen::Vector2d(9, 3), standing::kDepth),
        standing::pointAt(onMark_px, standing::kDepth));
    moving.association.points.front().cur.uv_px += Eigen::Vector2d(3, 0);
    known.marks.split(moving.association, standing::camera());
    ASSERT_EQ(moving.association.doubtedPoints.size(), 1);
    const int before = cv::countNonZero(known.marks.mask());
    known.marks.learn({moving.association}, standing::camera(), {aside(0.5), Matrix6d::Zero()});
    EXPECT_EQ(cv::countNonZero(known.marks.mask()), before);
}
}  // namespace pointplane
