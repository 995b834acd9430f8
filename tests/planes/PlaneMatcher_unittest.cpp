// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/PlaneMatcher.h>

#include <opencv2/core.hpp>

#include <cmath>
#include <stdexcept>

#include "synthetic_depth.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
const PinholeCamera kCamera = test::kinectCamera();
const Eigen::Isometry3d kStill = Eigen::Isometry3d::Identity();

/** A plane set of rectangular segments. */
class PlaneSetMaker
{
 public:
    PlaneSetMaker() { set.labels = cv::Mat::zeros(kCamera.height, kCamera.width, CV_8UC1); }

    PlaneSetMaker& add(const Eigen::Vector3d& n, double d, const cv::Rect& segment)
    {
        PlaneFeature plane;
        plane.plane_cam = {n.normalized() / d, 1e-6 * Eigen::Matrix3d::Identity()};
        plane.numPixels = segment.area();
        set.planes.push_back(plane);
        set.labels(segment).setTo(static_cast<double>(set.planes.size()));
        return *this;
    }
    PlaneSet set;
};

/** Normal to the camera, turned by an angle about the image's y axis. */
Eigen::Vector3d tilted(double deg)
{
    return {std::sin(deg * M_PI / 180), 0, -std::cos(deg * M_PI / 180)};
}

PlaneSet one(const Eigen::Vector3d& n, double d, const cv::Rect& segment = {0, 0, 640, 480})
{
    return PlaneSetMaker().add(n, d, segment).set;
}

bool matches(const PlaneSet& a, const PlaneSet& b, const Eigen::Isometry3d& T_b_a = kStill)
{
    return PlaneMatcher({}).match(a, b, kCamera, T_b_a).size() == 1;
}
}  // namespace

TEST(PlaneMatcher, overlapOfHalfOfTheSmallerSegment)
{
    const PlaneSet left = one(tilted(0), 2, {0, 0, 320, 480});
    EXPECT_TRUE(matches(left, one(tilted(0), 2, {160, 0, 320, 480})));
    EXPECT_FALSE(matches(left, one(tilted(0), 2, {161, 0, 320, 480})));
    // Half of the small one is enough, whichever of the two it is.
    const PlaneSet small = one(tilted(0), 2, {280, 80, 80, 80});
    EXPECT_TRUE(matches(left, small));
    EXPECT_TRUE(matches(small, left));
    EXPECT_FALSE(matches(left, one(tilted(0), 2, {288, 80, 80, 80})));
    EXPECT_FALSE(matches(left, one(tilted(0), 2, {320, 0, 320, 480})));
}

/** Segments smaller than the grid on which moved ones are compared. */
TEST(PlaneMatcher, unmovedSegmentsAreComparedPixelByPixel)
{
    const PlaneSet small = one(tilted(0), 2, {17, 17, 6, 6});
    EXPECT_TRUE(matches(small, one(tilted(0), 2, {20, 17, 6, 6})));
    EXPECT_FALSE(matches(small, one(tilted(0), 2, {21, 17, 6, 6})));
}

TEST(PlaneMatcher, normalsWithinTenDegrees)
{
    EXPECT_TRUE(matches(one(tilted(0), 2), one(tilted(9.9), 2)));
    EXPECT_FALSE(matches(one(tilted(0), 2), one(tilted(10.1), 2)));
    EXPECT_FALSE(matches(one(tilted(-5.1), 2), one(tilted(5.0), 2)));
}

TEST(PlaneMatcher, distancesWithinTenCentimetres)
{
    EXPECT_TRUE(matches(one(tilted(0), 2), one(tilted(0), 2.099)));
    EXPECT_FALSE(matches(one(tilted(0), 2), one(tilted(0), 2.101)));
    EXPECT_TRUE(matches(one(tilted(0), 2), one(tilted(0), 1.901)));
    EXPECT_FALSE(matches(one(tilted(0), 2), one(tilted(0), 1.899)));
}

TEST(PlaneMatcher, limitsAreParameters)
{
    PlaneMatcher::TParams params;
    params.maxNormalAngleDeg = 20;
    params.maxDistance = 0.3;
    params.minOverlap = 0.9;
    const PlaneMatcher matcher(params);
    EXPECT_EQ(matcher.match(one(tilted(0), 2), one(tilted(19), 2.2), kCamera, kStill).size(), 1U);
    const PlaneSet half = one(tilted(0), 2, {160, 0, 320, 480});
    EXPECT_TRUE(matcher.match(one(tilted(0), 2, {0, 0, 320, 480}), half, kCamera, kStill).empty());
    params.minOverlap = 0;
    EXPECT_THROW(PlaneMatcher{params}, std::invalid_argument);
}

/** |d'N' - dN| counts angle times distance: the nearer in d need not be the nearer plane. */
TEST(PlaneMatcher, smallestPlaneToPlaneDistanceWins)
{
    const PlaneSet ref = one(tilted(0), 2);
    const PlaneSet cur = PlaneSetMaker()
                             .add(tilted(5), 2.00, {0, 0, 320, 480})    // 0.17 m apart
                             .add(tilted(1), 2.05, {320, 0, 320, 480})  // 0.06 m
                             .set;
    const auto found = PlaneMatcher({}).match(ref, cur, kCamera, kStill);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].cur, 1);
}

TEST(PlaneMatcher, eachPlaneIsMatchedOnceNearestFirst)
{
    // Both references overlap the first current plane; the second reference is nearer to it.
    const PlaneSet ref = PlaneSetMaker()
                             .add(tilted(2), 2, {0, 0, 320, 480})
                             .add(tilted(0), 2, {320, 0, 320, 480})
                             .set;
    const PlaneSet cur = one(tilted(0), 2.01);
    const auto found = PlaneMatcher({}).match(ref, cur, kCamera, kStill);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].ref, 1);

    const auto self = PlaneMatcher({}).match(ref, ref, kCamera, kStill);
    ASSERT_EQ(self.size(), 2U);
    EXPECT_EQ(self[0].ref, 0);
    EXPECT_EQ(self[0].cur, 0);
    EXPECT_EQ(self[1].ref, 1);
    EXPECT_EQ(self[1].cur, 1);
}

/** A plane whose nearest candidate matches another. To the paper the second nearest is none, as it
 * is not "the plane candidate with the minimum plane-to-plane distance". */
TEST(PlaneMatcher, theSecondNearestIsNoMatchInThePaper)
{
    const PlaneSet ref = PlaneSetMaker()
                             .add(tilted(2), 2, {0, 0, 320, 480})
                             .add(tilted(0), 2, {320, 0, 320, 480})
                             .set;
    const PlaneSet cur = PlaneSetMaker()
                             .add(tilted(0), 2.01, {160, 0, 320, 480})  // the nearest of both
                             .add(tilted(7), 2.00, {0, 0, 160, 480})    // the second of the first
                             .set;
    PlaneMatcher::TParams params;
    params.secondNearest = false;
    const auto papers = PlaneMatcher(params).match(ref, cur, kCamera, kStill);
    ASSERT_EQ(papers.size(), 1U);
    EXPECT_EQ(papers[0].ref, 1);
    EXPECT_EQ(papers[0].cur, 0);

    const auto ours = PlaneMatcher({}).match(ref, cur, kCamera, kStill);
    ASSERT_EQ(ours.size(), 2U);
    EXPECT_EQ(ours[0].ref, 0);
    EXPECT_EQ(ours[0].cur, 1);
    EXPECT_EQ(ours[1].ref, 1);
    EXPECT_EQ(ours[1].cur, 0);
}

TEST(PlaneMatcher, predictedMotionIsTakenOut)
{
    // 0.3 m towards the plane, turned by 12 degrees: another plane by the paper's test.
    Eigen::Isometry3d T_cur_ref = Eigen::Isometry3d::Identity();
    T_cur_ref.linear() =
        Eigen::AngleAxisd(12 * M_PI / 180, Eigen::Vector3d::UnitY()).toRotationMatrix();
    T_cur_ref.translation() << 0, 0, -0.3;
    const Plane moved = transformed(T_cur_ref, Plane{tilted(0), 2});
    const PlaneSet ref = one(tilted(0), 2), cur = one(moved.n, moved.d);
    EXPECT_FALSE(matches(ref, cur));
    EXPECT_TRUE(matches(ref, cur, T_cur_ref));
    EXPECT_FALSE(matches(ref, ref, T_cur_ref));
}

TEST(PlaneMatcher, segmentsMoveAlongWithThePrediction)
{
    // 0.4 m sideways at 2 m: 105 px to the left.
    Eigen::Isometry3d T_cur_ref = Eigen::Isometry3d::Identity();
    T_cur_ref.translation() << -0.4, 0, 0;
    const PlaneSet ref = one(tilted(0), 2, {240, 160, 80, 160});
    const PlaneSet cur = one(tilted(0), 2, {135, 160, 80, 160});
    EXPECT_FALSE(matches(ref, cur));
    EXPECT_TRUE(matches(ref, cur, T_cur_ref));
}

TEST(PlaneMatcher, nothingMatchesNothing)
{
    const PlaneSet ref = one(tilted(0), 2);
    PlaneSet none = PlaneSetMaker().set, smaller = ref;
    smaller.labels = cv::Mat::ones(240, 320, CV_8UC1);
    EXPECT_FALSE(matches(ref, none));
    EXPECT_FALSE(matches(none, ref));
    EXPECT_FALSE(matches(ref, smaller));
    EXPECT_FALSE(matches(PlaneSet{}, PlaneSet{}));
    // Behind the camera after the predicted motion.
    Eigen::Isometry3d T_cur_ref = Eigen::Isometry3d::Identity();
    T_cur_ref.translation() << 0, 0, -5;
    EXPECT_FALSE(matches(ref, ref, T_cur_ref));
}
}  // namespace pointplane
