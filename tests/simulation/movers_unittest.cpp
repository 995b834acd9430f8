// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/Scene.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <string>

#include "matchers.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
SimulationParams small(SimulationParams params = SimulationParams::ideal())
{
    params.width = 320;
    params.height = 240;
    params.duration = 4;
    return params;
}

/** The point of a pixel, camera frame [m]; NaN without depth. */
Eigen::Vector3d pointAt(const RgbdFrame& frame, int u, int v)
{
    const Eigen::Vector2d xy = frame.camera.normalised(Eigen::Vector2d(u, v));
    return static_cast<double>(frame.depth.at<float>(v, u)) * Eigen::Vector3d(xy.x(), xy.y(), 1);
}

/** Pixels whose 5 x 5 neighbourhood has the same label and no depth edge. */
cv::Mat inside(const cv::Mat& labels, const cv::Mat& depth)
{
    const cv::Mat square = cv::Mat::ones(5, 5, CV_8U);
    cv::Mat least, most, nearest, farthest;
    cv::erode(labels, least, square);
    cv::dilate(labels, most, square);
    cv::erode(depth, nearest, square);
    cv::dilate(depth, farthest, square);
    return (least == most) & (farthest - nearest < 0.03);
}
}  // namespace

class EveryMover : public testing::TestWithParam<std::string>
{
};

TEST_P(EveryMover, maskIsExactlyWhatDiffersFromTheSceneWithoutIt)
{
    const SimulatedSequence sequence(GetParam(), small(), 3);
    SimulationParams params = small();
    params.movers = false;
    const SimulatedSequence still(sequence.scene(), params, 3);
    EXPECT_TRUE(still.scene()->movers.empty());
    int moving = 0;
    for (const int i : {0, 40, 70, 110})
    {
        const cv::Mat labels = sequence.trueMovers(i).labels;
        EXPECT_EQ(cv::countNonZero(still.trueMovers(i).labels), 0);
        const cv::Mat with = sequence.frame(i).depth, without = still.frame(i).depth;
        for (int v = 0; v < labels.rows; ++v)
        {
            for (int u = 0; u < labels.cols; ++u)
            {
                const float a = with.at<float>(v, u), b = without.at<float>(v, u);
                if (labels.at<uchar>(v, u) == 0)
                {
                    ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << u << " " << v;
                }
                else
                {
                    ASSERT_FALSE(a >= b || std::isnan(a)) << u << " " << v;
                    ++moving;
                }
            }
        }
    }
    EXPECT_GT(moving, 4000);
}

TEST_P(EveryMover, depthAndColourMoveAsTheTruthSays)
{
    const SimulatedSequence sequence(GetParam(), small(), 3);
    int compared = 0, moved = 0;
    for (const int a : {40, 65, 80})
    {
        const int b = a + (std::string(GetParam()) == "seated" ? 24 : 3);  // people sit still
        const RgbdFrame from = sequence.frame(a), to = sequence.frame(b);
        const TrueMovers then = sequence.trueMovers(a), now = sequence.trueMovers(b);
        const cv::Mat clearThen = inside(then.labels, from.depth);
        const cv::Mat clearNow = inside(now.labels, to.depth);
        const Eigen::Isometry3d T_world_a = sequence.truth(from.stamp);
        const Eigen::Isometry3d T_b_world = sequence.truth(to.stamp).inverse();
        for (int v = 0; v < from.camera.height; v += 2)
        {
            for (int u = 0; u < from.camera.width; u += 2)
            {
                const int label = then.labels.at<uchar>(v, u);
                if (label == 0 || clearThen.at<uchar>(v, u) == 0)
                {
                    continue;
                }
                const auto k = static_cast<std::size_t>(label - 1);
                const Eigen::Vector3d p_world = T_world_a * pointAt(from, u, v);
                const Eigen::Vector3d q_world =
                    now.T_world_rest[k] * then.T_world_rest[k].inverse() * p_world;
                const Eigen::Vector3d q = T_b_world * q_world;
                const Eigen::Vector2d pixel = to.camera.project(q);
                const int x = static_cast<int>(std::lround(pixel.x()));
                const int y = static_cast<int>(std::lround(pixel.y()));
                if (x < 0 || y < 0 || x >= to.camera.width || y >= to.camera.height ||
                    now.labels.at<uchar>(y, x) != label || clearNow.at<uchar>(y, x) == 0)
                {
                    continue;  // left the view, or hidden
                }
                // Half a pixel on a slanted or round surface.
                EXPECT_NEAR(static_cast<double>(to.depth.at<float>(y, x)), q.z(), 0.012);
                moved += (q_world - p_world).norm() > 0.01 ? 1 : 0;
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 200);
    EXPECT_GT(moved, compared / 3);
}

TEST_P(EveryMover, sameSeedGivesTheSameBytes)
{
    const SimulatedSequence a(GetParam(), small({}), 5), b(GetParam(), small({}), 5);
    (void)b.frame(3);
    const RgbdFrame first = a.frame(50), second = b.frame(50);
    EXPECT_EQ(cv::norm(first.gray, second.gray, cv::NORM_INF), 0);
    EXPECT_EQ(
        cv::countNonZero(first.depth != second.depth),
        cv::countNonZero(first.depth != first.depth));
    EXPECT_EQ(cv::norm(a.trueMovers(50).labels, b.trueMovers(50).labels, cv::NORM_INF), 0);
}

INSTANTIATE_TEST_SUITE_P(
    movers,
    EveryMover,
    testing::Values("person", "push", "door", "half", "seated"),
    [](const auto& scene) { return scene.param; });

TEST(Movers, rowsOfARollingShutterSeeThemAtTheirOwnInstant)
{
    SimulationParams params = small();
    params.readoutDepth = 0.03;
    params.readoutColour = 0.02;
    params.depthDelay = -0.01;
    const SimulatedSequence sequence("door", params, 1);
    const int i = 45;  // while the door opens
    const RgbdFrame frame = sequence.frame(i);
    const Mover& door = sequence.scene()->movers.at(0);
    const double stamp = sequence.stamp(i), t0 = params.startStamp;
    const Surface* leaf = nullptr;
    for (const Surface& surface : sequence.scene()->surfaces)
    {
        leaf = surface.mover == 0 && leaf == nullptr ? &surface : leaf;
    }
    ASSERT_NE(leaf, nullptr);
    int onDoor = 0;
    double atMiddle = 0;
    for (int v = 0; v < params.height; v += 3)
    {
        const double at =
            stamp + params.depthDelay + (v / static_cast<double>(params.height) - 0.5) * 0.03;
        for (int u = 0; u < params.width; u += 3)
        {
            const Eigen::Vector3d p_world = sequence.truth(at) * pointAt(frame, u, v);
            const Eigen::Vector3d p = door.T_world_rest(at - t0).inverse() * p_world;
            const Eigen::Vector2d st = leaf->worldToPicture(p);
            const double distance = std::abs((p - leaf->origin).dot(leaf->e3));
            const bool isOn = distance < 1e-5 && st.x() > 0.02 && st.x() < leaf->width - 0.02 &&
                              st.y() > 0.02 && st.y() < leaf->height - 0.02;
            if (isOn)
            {
                ++onDoor;
                const Eigen::Vector3d other = door.T_world_rest(stamp - t0).inverse() * p_world;
                atMiddle = std::max(atMiddle, std::abs((other - leaf->origin).dot(leaf->e3)));
            }
        }
    }
    EXPECT_GT(onDoor, 1000);
    EXPECT_GT(atMiddle, 5e-3) << "the door moves during the readout";
}

TEST(Movers, aCameraThatIsFasterGoesAlongTheSamePath)
{
    SimulationParams params = small();
    const SimulatedSequence slow("desk", params, 2);
    params.motionSpeed = 4;
    const SimulatedSequence fast(slow.scene(), params, 2);
    for (const double t : {0.0, 0.1, 0.7})
    {
        EXPECT_THAT(
            fast.truth(params.startStamp + t),
            test::IsNearPose(slow.truth(params.startStamp + 4 * t), 1e-6, 1e-6));
    }
    params.motionSpeed = 0;
    const SimulatedSequence still(slow.scene(), params, 2);
    EXPECT_THAT(
        still.trueMotion(0, 90), test::IsNearPose(Eigen::Isometry3d::Identity(), 1e-12, 1e-12));
}

TEST(Movers, aCameraThatOnlyTurnsStaysInPlace)
{
    SimulationParams params = small();
    const SimulatedSequence moves("desk", params, 2);
    params.motionTurnsOnly = true;
    const SimulatedSequence turns(moves.scene(), params, 2);
    const double t = params.startStamp + 0.7;
    EXPECT_EQ(turns.truth(t).linear(), moves.truth(t).linear());
    EXPECT_EQ(turns.truth(t).translation(), turns.truth(params.startStamp).translation());
    EXPECT_GT((moves.truth(t).translation() - turns.truth(t).translation()).norm(), 0.01);
}
}  // namespace pointplane
