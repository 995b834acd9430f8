// SPDX-License-Identifier: BSD-3-Clause
#include "ImageAligner.h"

#include <pointplane/core/se3.h>

#include <random>

#include "hell_frames.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Key points of a random room seen from two cameras; descriptors are unique, but for a share of
 * wrong ones, which lead to another point. */
struct SyntheticViews
{
    SyntheticViews(const Eigen::Isometry3d& T_cur_ref, double wrongShare, int numPoints)
    {
        std::mt19937 random(3);
        std::uniform_real_distribution<double> u(0.1, 0.9);
        for (int i = 0; i < numPoints; ++i)
        {
            const Eigen::Vector2d xy = camera.normalised({640 * u(random), 480 * u(random)});
            const Eigen::Vector3d p = (1 + 2 * u(random)) * xy.homogeneous();
            add(reference, p, i);
            add(current, T_cur_ref * p, i < wrongShare * numPoints ? numPoints + i : i);
        }
        for (int i = 0; i < wrongShare * numPoints; ++i)
        {
            const Eigen::Vector2d xy = camera.normalised({640 * u(random), 480 * u(random)});
            add(current, (1 + 2 * u(random)) * xy.homogeneous(), i);
        }
    }

    void add(DescribedPoints& to, const Eigen::Vector3d& p, int name) const
    {
        PointFeature point;
        point.p_cam.mean = p;
        point.uv_px = camera.project(p);
        to.points.push_back(point);
        std::mt19937 bits(static_cast<unsigned>(name));
        cv::Mat row(1, 32, CV_8UC1);
        for (int k = 0; k < 32; ++k)
        {
            row.at<uchar>(k) = static_cast<uchar>(bits());
        }
        to.descriptors.push_back(row);
    }

    PinholeCamera camera;
    DescribedPoints reference, current;
};

Eigen::Isometry3d bigMotion()
{
    Vector6d xi;
    xi << 0.3, -0.2, 0.25, 0.2, -0.4, 0.6;
    return se3Exp(xi);
}

std::optional<Eigen::Isometry3d> motionBetween(
    const DescribedPoints& reference, const DescribedPoints& current, const PinholeCamera& camera)
{
    const ImageAligner aligner({}, {});
    return aligner.align(aligner.match(reference, current), camera);
}

/** Of the matches, those that a motion puts on each other. */
int numExplained(const Eigen::Isometry3d& T_cur_ref, const SyntheticViews& views)
{
    const MatchedPoints matches = ImageAligner({}, {}).match(views.reference, views.current);
    int out = 0;
    for (size_t i = 0; i < matches.ref.size(); ++i)
    {
        out += (T_cur_ref * matches.ref[i] - matches.cur[i]).norm() < 0.05 ? 1 : 0;
    }
    return out;
}
}  // namespace

TEST(ImageAligner, exactPointsTellAnyMotionExactly)
{
    const SyntheticViews views(bigMotion(), 0, 50);
    const auto motion = motionBetween(views.reference, views.current, views.camera);
    ASSERT_TRUE(motion);
    EXPECT_EQ(numExplained(*motion, views), 50);
    EXPECT_THAT(*motion, test::IsNearPose(bigMotion(), 1e-9, 1e-9));
}

TEST(ImageAligner, mostMatchesMayBeWrong)
{
    const SyntheticViews views(bigMotion(), 0.7, 100);
    const auto motion = motionBetween(views.reference, views.current, views.camera);
    ASSERT_TRUE(motion);
    EXPECT_GE(numExplained(*motion, views), 30);
    EXPECT_LE(numExplained(*motion, views), 36);
    EXPECT_THAT(*motion, test::IsNearPose(bigMotion(), 0.02, 0.02));
}

TEST(ImageAligner, chanceIsNoMotion)
{
    const SyntheticViews views(bigMotion(), 1, 60);
    EXPECT_FALSE(motionBetween(views.reference, views.current, views.camera));
    EXPECT_FALSE(motionBetween({}, views.current, views.camera));
    EXPECT_FALSE(motionBetween(views.reference, {}, views.camera));
}

TEST(ImageAligner, imagesHalfASecondApart)
{
    const ImageAligner aligner({}, {});
    const auto describe = [&](int i)
    { return aligner.describe(test::CachedSequence::desk().frame(i)); };
    for (const int from : {0, 60, 120})
    {
        const int to = from + 15;
        const auto motion = motionBetween(
            describe(from), describe(to), test::CachedSequence::desk().frame(to).camera);
        ASSERT_TRUE(motion) << from;
        EXPECT_THAT(
            *motion,
            test::IsNearPose(
                test::CachedSequence::desk().sequence().trueMotion(to, from), 0.05, 0.05));
    }
}

TEST(ImageAligner, sameInputSameAnswer)
{
    const SyntheticViews views(bigMotion(), 0.5, 80);
    const auto a = motionBetween(views.reference, views.current, views.camera);
    const auto b = motionBetween(views.reference, views.current, views.camera);
    ASSERT_TRUE(a && b);
    EXPECT_TRUE(a->matrix() == b->matrix());
}
}  // namespace pointplane
