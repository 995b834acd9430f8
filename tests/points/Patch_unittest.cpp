// SPDX-License-Identifier: BSD-3-Clause
#include "Patch.h"

#include <opencv2/video/tracking.hpp>

#include "texture.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** \param grey of a pixel */
template <class F>
Patch patchOf(const F& grey, const cv::Point2f& centre, int halfPx)
{
    std::vector<cv::Mat> pyramid;
    cv::buildOpticalFlowPyramid(test::renderImage(60, 50, grey), pyramid, {15, 15}, 0, true);
    return {pyramid[0], pyramid[1], centre, halfPx};
}

double slope(double u, double v) { return 20 + 2 * u + 1 * v; }
}  // namespace

TEST(Patch, HoldsGreysAndGradients)
{
    const Patch patch = patchOf(slope, {30, 20}, 3);
    ASSERT_EQ(patch.greys().size(), 49);
    EXPECT_EQ(patch.greys()[0], static_cast<float>(slope(27, 17)));
    EXPECT_EQ(patch.greys()[48], static_cast<float>(slope(33, 23)));
    EXPECT_TRUE((patch.gradients().colwise() - Eigen::Vector2d(2, 1)).isZero(0));
}

TEST(Patch, StructureIsWhatAShiftOfBrightnessLeaves)
{
    const Patch patch = patchOf(slope, {30, 20}, 3);
    Eigen::Matrix2d all;
    all << 4, 2, 2, 1;
    EXPECT_TRUE(patch.structure(Brightness::Constant).isApprox(49 * all));
    EXPECT_TRUE(patch.structure(Brightness::Shifted).isZero(1e-9));
    EXPECT_EQ(patch.explained(Brightness::Shifted), Eigen::Vector2d(2, 1));
    EXPECT_EQ(patch.explained(Brightness::Constant), Eigen::Vector2d(0, 0));
}

TEST(Patch, StructureOfNoiseIsItsMean)
{
    constexpr double kNoise = 3;
    double sum = 0, expected = 0;
    for (unsigned seed = 1; seed <= 40; ++seed)
    {
        test::GaussianSampler random(seed);
        const Patch patch =
            patchOf([&](double, double) { return 100 + kNoise * random.normal(); }, {30, 20}, 7);
        sum += patch.structure(Brightness::Constant).trace() / 2;
        expected += patch.structureOfNoise(kNoise);
    }
    EXPECT_NEAR(sum / expected, 1, 0.05);
}

TEST(Patch, InnerIsTheSmallerPatch)
{
    const test::Texture texture(1, 5, 40);
    // The second and third are cut where the image ends.
    for (const cv::Point2f& centre : {cv::Point2f(30, 20), {2, 3}, {58, 46}})
    {
        const Patch inner = patchOf(texture, centre, 7).inner(4);
        const Patch expected = patchOf(texture, centre, 4);
        EXPECT_EQ(inner.pixels(), expected.pixels());
        EXPECT_EQ(inner.halfPx(), 4);
        EXPECT_EQ(inner.greys(), expected.greys());
        EXPECT_EQ(inner.gradients(), expected.gradients());
    }
}
}  // namespace pointplane
