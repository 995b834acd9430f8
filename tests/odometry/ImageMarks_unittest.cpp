// SPDX-License-Identifier: BSD-3-Clause
#include "ImageMarks.h"

#include <cstdint>
#include <functional>

#include "standing_points.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using standing::camera;
using standing::kWindowPx;
using standing::pointAt;

/** Where a point of a camera is seen later. */
using Motion2 = std::function<PointFeature(const PointFeature&)>;

/** Points all over the image, 2 m away, with where they are found again. */
struct Pair
{
    /** \param rise_m of the depth, from the top of the image to its bottom */
    explicit Pair(const Motion2& later, int step_px = 40, double rise_m = 0)
    {
        for (int v = 20; v < camera().height; v += step_px)
        {
            for (int u = 20; u < camera().width; u += step_px)
            {
                const auto index = static_cast<int>(reference.points.points.size());
                reference.points.points.push_back(
                    pointAt({u, v}, 2 + rise_m * v / camera().height));
                association.points.push_back({index, later(reference.points.points.back())});
            }
        }
        association.reference = &reference;
    }
    Pair(const Pair&) = delete;

    /** \return number of marks */
    size_t split(const ImageMarks& marks)
    {
        marks.split(association, camera());
        return association.fixedPoints.size();
    }

    /** The frame is compared with this reference alone. */
    bool teach(ImageMarks& marks)
    {
        (void)split(marks);
        return marks.learn({association}, marksIn({association}), camera());
    }

    Reference reference;
    Association association;
};

PointFeature stays(const PointFeature& point) { return point; }

/** Stands in the image, before a wall that turns. */
PointFeature mark(const PointFeature& point)
{
    return pointAt(point.uv_px, 2 + (point.uv_px.x() - 160) / 1000);
}

Motion2 seenAfter(const Eigen::Isometry3d& T_cur_ref)
{
    return [T_cur_ref](const PointFeature& point)
    {
        const Eigen::Vector3d p = T_cur_ref * point.p_cam.mean;
        return pointAt(camera().project(p), p.z());
    };
}

/** After two frames that show marks. */
ImageMarks thatKnows()
{
    ImageMarks out(kWindowPx);
    EXPECT_FALSE(Pair(mark).teach(out));
    EXPECT_TRUE(Pair(mark).teach(out));
    return out;
}
}  // namespace

TEST(ImageMarks, whatStandsBeforeChangingDepthIsAMark)
{
    Pair pair(mark);
    const size_t all = pair.association.points.size();
    EXPECT_EQ(pair.split(ImageMarks(kWindowPx)), all);
    EXPECT_TRUE(pair.association.points.empty());
}

/** A sensor that warms up, before a camera that rests. */
TEST(ImageMarks, depthThatChangesAllOverTheImageShowsNone)
{
    const std::vector<std::function<double(double)>> changes{
        [](double z) { return z + 0.2; },
        [](double z) { return 0.9 * z; },
        [](double z) { return 1 / (1 / z + 0.05); }};
    for (const auto& change : changes)
    {
        Pair pair(
            [&](const PointFeature& point)
            { return pointAt(point.uv_px, change(point.p_cam.mean.z())); },
            40,
            1);
        EXPECT_EQ(pair.split(ImageMarks(kWindowPx)), 0) << change(2);
    }
}

TEST(ImageMarks, aSceneThatStandsHasNone)
{
    Pair pair([](const PointFeature& point) { return pointAt(point.uv_px, 2.01); });
    EXPECT_EQ(pair.split(ImageMarks(kWindowPx)), 0);
    EXPECT_EQ(pair.association.points.size(), pair.reference.points.points.size());
}

/** Points rest in the image where the camera moves to, and on the axis that it circles. */
TEST(ImageMarks, aCameraThatMovesSeesNone)
{
    for (const double ahead : {0.05, 0.2, 0.5})
    {
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.translation().z() = -ahead;
        Pair pair(seenAfter(T), 4);
        EXPECT_EQ(pair.split(ImageMarks(kWindowPx)), 0) << ahead << " m";
    }
    for (const double angle : {0.005, 0.02, 0.1})
    {
        const Eigen::Vector3d centre(0, 0, 2);
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.linear() = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitY()).toRotationMatrix();
        T.translation() = centre - T.linear() * centre;
        Pair pair(seenAfter(T), 4);
        EXPECT_EQ(pair.split(ImageMarks(kWindowPx)), 0) << angle << " rad";
    }
}

TEST(ImageMarks, someoneInFrontOfAWallIsNone)
{
    Pair pair([](const PointFeature& point)
              { return point.uv_px.x() < 60 ? mark(point) : pointAt(point.uv_px, 2); });
    EXPECT_EQ(pair.split(ImageMarks(kWindowPx)), 0);
}

TEST(ImageMarks, ofMarksAndSceneOnlyMarksAreTaken)
{
    const auto isText = [](const PointFeature& point) { return point.uv_px.y() < 130; };
    Pair pair(
        [&](const PointFeature& point)
        { return isText(point) ? mark(point) : pointAt(point.uv_px + Eigen::Vector2d(3, 0), 2); });
    EXPECT_EQ(pair.split(ImageMarks(kWindowPx)), 24);
    for (const PointTrack& track : pair.association.fixedPoints)
    {
        EXPECT_TRUE(isText(track.cur));
    }
}

/** Time of flight can be wrong by a tenth of the distance for one frame. */
TEST(ImageMarks, depthThatJumpsTellsNothing)
{
    ImageMarks marks(kWindowPx);
    for (const bool jumps : {true, false, true, false})
    {
        EXPECT_FALSE(Pair(jumps ? mark : stays).teach(marks));
    }
    EXPECT_FALSE(marks.areKnown());
    EXPECT_TRUE(marks.mask().empty());
}

/** A frame that also finds the first reference again, or not, but no point that stands there. */
bool teach(ImageMarks& marks, Pair& newer, bool findsFirst)
{
    newer.reference.id = 1;
    (void)newer.split(marks);
    const Reference first;
    Association none;
    none.reference = &first;
    std::vector<Association> all{newer.association};
    if (findsFirst)
    {
        all.push_back(none);
    }
    return marks.learn(all, marksIn(all), camera());
}

/** Between two frames in which the camera has hardly moved, marks look like a scene that stands. */
TEST(ImageMarks, aNewerReferenceDoesNotClearMarks)
{
    ImageMarks marks(kWindowPx);
    EXPECT_FALSE(Pair(mark).teach(marks));
    Pair newer(stays), again(mark);
    EXPECT_FALSE(teach(marks, newer, true));
    EXPECT_TRUE(teach(marks, again, true));
}

TEST(ImageMarks, aSuspicionEndsWithTheReferenceThatRaisedIt)
{
    ImageMarks marks(kWindowPx);
    EXPECT_FALSE(Pair(mark).teach(marks));
    Pair newer(mark);
    EXPECT_FALSE(teach(marks, newer, false));
}

TEST(ImageMarks, knownMarksAreCovered)
{
    ImageMarks marks = thatKnows();
    ASSERT_EQ(marks.mask().size(), cv::Size(320, 240));
    EXPECT_NE(marks.mask().at<std::uint8_t>(20, 20 + kWindowPx / 2), 0);
    EXPECT_EQ(marks.mask().at<std::uint8_t>(20, 20 + kWindowPx), 0);
    EXPECT_FALSE(Pair(mark).teach(marks));  // it is no news
    marks.forget();
    EXPECT_FALSE(marks.areKnown());
    EXPECT_TRUE(marks.mask().empty());
}

/** Depth images have no lens distortion. */
TEST(ImageMarks, marksAreCoveredWhereTheDepthImageShowsThem)
{
    ImageMarks marks(kWindowPx);
    PinholeCamera camera = standing::camera();
    camera.distortion[0] = -0.3;
    for (int times = 0; times < 2; ++times)
    {
        Pair pair(mark);
        (void)pair.split(marks);
        marks.learn({pair.association}, marksIn({pair.association}), camera);
    }
    const Eigen::Vector2d onDepth = camera.depthPixel({60, 60});
    const cv::Point pixel(cvRound(onDepth.x()), cvRound(onDepth.y()));
    ASSERT_GT(cv::norm(pixel - cv::Point(60, 60)), kWindowPx / 2);
    EXPECT_NE(marks.mask().at<std::uint8_t>(pixel), 0);
    EXPECT_EQ(marks.mask().at<std::uint8_t>(60, 60), 0);
}

/** Before a wall that the camera moves along, depth does not tell it. */
TEST(ImageMarks, onceMarksAreKnownNothingThatStandsCounts)
{
    Eigen::Isometry3d along = Eigen::Isometry3d::Identity();
    along.translation().x() = 0.05;
    const ImageMarks marks = thatKnows();
    Pair still(stays), moved(seenAfter(along));
    EXPECT_EQ(still.split(marks), 0);
    EXPECT_TRUE(still.association.points.empty());
    EXPECT_NE(marks.whyNoPoint({still.association}), "");
    EXPECT_EQ(still.association.doubtedPoints.size(), still.reference.points.points.size());
    EXPECT_EQ(moved.split(marks), 0);
    EXPECT_EQ(moved.association.points.size(), moved.reference.points.points.size());
    EXPECT_EQ(marks.whyNoPoint({moved.association}), "");
}

/** How many points of an association count, of which a share is found where marks are. */
size_t countingOf(double shareAtMarks)
{
    const ImageMarks marks = thatKnows();
    Pair pair(stays);
    std::vector<PointTrack>& points = pair.association.points;
    const size_t atMarks = std::lround(shareAtMarks * static_cast<double>(points.size()));
    for (size_t i = 0; i < points.size(); ++i)
    {
        const PointFeature& ref = pair.reference.points.points[i];
        const double toRight_px = ref.uv_px.x() < 160 ? 40 : -40;  // from mark to mark
        const double shift_px = i < atMarks ? toRight_px : toRight_px / 2;
        points[i].cur = pointAt(ref.uv_px + Eigen::Vector2d(shift_px, 2), 2);
    }
    (void)pair.split(marks);
    EXPECT_EQ(
        pair.association.points.size() + pair.association.doubtedPoints.size(),
        pair.reference.points.points.size());
    return pair.association.points.size();
}

TEST(ImageMarks, whatIsFoundWhereAMarkIsDoesNotCount)
{
    const size_t all = countingOf(0);
    EXPECT_GT(all, 40);
    EXPECT_EQ(countingOf(0.25), std::lround(0.75 * static_cast<double>(all)));
}

/** The others may be marks, too, that are taken for their neighbours. */
TEST(ImageMarks, amongMarksNoPointCounts)
{
    EXPECT_GT(countingOf(0.49), 20);
    EXPECT_EQ(countingOf(0.55), 0);
}

TEST(ImageMarks, whatShouldHaveMovedIsAMark)
{
    Eigen::Isometry3d along = Eigen::Isometry3d::Identity();
    along.translation().x() = 0.05;
    const cv::Point between(40, 40);  // of the points of thatKnows()
    Pair still(stays);
    still.reference.points.points.front() = still.association.points.front().cur =
        pointAt({40, 40}, 2);
    ImageMarks marks = thatKnows();
    (void)still.split(marks);
    marks.learn({still.association}, camera(), {});
    EXPECT_EQ(marks.mask().at<std::uint8_t>(between), 0);  // the camera stood
    marks.learn({still.association}, camera(), {along, 0.01 * Matrix6d::Identity()});
    EXPECT_EQ(marks.mask().at<std::uint8_t>(between), 0);  // nobody knows whether it moved
    marks.learn({still.association}, camera(), {along, 1e-6 * Matrix6d::Identity()});
    EXPECT_NE(marks.mask().at<std::uint8_t>(between), 0);
    ImageMarks unknown(kWindowPx);
    unknown.learn({still.association}, camera(), {along, Matrix6d::Zero()});
    EXPECT_TRUE(unknown.mask().empty());
}
}  // namespace pointplane
