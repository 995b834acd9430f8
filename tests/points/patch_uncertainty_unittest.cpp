// SPDX-License-Identifier: BSD-3-Clause
#include "patch_uncertainty.h"

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include <cmath>
#include <vector>

#include "image_noise.h"
#include "monte_carlo.h"
#include "texture.h"
#include "warped_patches.h"
#include <gtest/gtest.h>

using namespace pointplane;

namespace
{
constexpr int kWindowPx = 15;

cv::Mat derivativesOf(const cv::Mat& gray)
{
    std::vector<cv::Mat> pyramid;
    cv::buildOpticalFlowPyramid(gray, pyramid, {kWindowPx, kWindowPx}, 0, true);
    return pyramid[1];
}

/** Of the patch in the middle of an image of 100 x 100 pixels. */
PatchUncertainty inTheMiddle(const cv::Mat& gray, double noise, Brightness brightness)
{
    const Patch patch(gray, derivativesOf(gray), {50, 50}, kWindowPx / 2);
    return patchUncertainty(patch, noise, brightness);
}
}  // namespace

TEST(PatchUncertainty, OfAStepCornerIsByHand)
{
    // A dark quarter in the middle of the patch: along each of its two sides, 8 px inside the patch
    // have a step of 100, which Scharr sees as a gradient of 50 in two pixels beside each other.
    cv::Mat gray(100, 100, CV_8UC1, cv::Scalar(150));
    gray(cv::Rect(50, 50, 50, 50)).setTo(50);
    const double lambda = 7.5 * 2 * 50 * 50;
    EXPECT_NEAR(
        inTheMiddle(gray, 1.5, Brightness::Constant).worst(), 1.5 * std::sqrt(2 / lambda), 1e-3);
    // A shift of brightness looks like half of a move along the diagonal: all gradients point to
    // one side, each sum being 7.5 * 2 * 50.
    const double sum = 7.5 * 2 * 50;
    EXPECT_NEAR(
        inTheMiddle(gray, 1.5, Brightness::Shifted).worst(),
        1.5 * std::sqrt(2 / (lambda - 2 * sum * sum / (kWindowPx * kWindowPx))),
        1e-3);
}

TEST(PatchUncertainty, OfASlopeIsThatOfItsBrightness)
{
    const cv::Mat gray = test::renderImage(100, 100, [](double u, double) { return 20 + 2 * u; });
    const auto uncertaintyWith = [&](Brightness brightness)
    { return inTheMiddle(gray, 1.0, brightness); };
    EXPECT_NEAR(
        uncertaintyWith(Brightness::Constant).best(), std::sqrt(2.0 / (15 * 15 * 2 * 2)), 0.002);
    EXPECT_TRUE(std::isinf(uncertaintyWith(Brightness::Shifted).best()));
}

TEST(PatchUncertainty, OfAnEdgeIsInfiniteAlongIt)
{
    cv::Mat gray(100, 100, CV_8UC1, cv::Scalar(150));
    gray(cv::Rect(50, 0, 50, 100)).setTo(50);  // upright
    const PatchUncertainty u = inTheMiddle(gray, 1.0, Brightness::Constant);
    EXPECT_TRUE(std::isinf(u.worst()));
    EXPECT_NEAR(u.best(), std::sqrt(2 / (15 * 2 * 50.0 * 50.0)), 1e-3);
    EXPECT_NEAR(std::abs(u.axes(1, 0)), 1, 1e-6);

    const Eigen::Matrix2d cov = u.covariance(0.2);
    EXPECT_GT(cov(1, 1), 1e5);
    EXPECT_NEAR(cov(0, 0), u.best() * u.best(), 1e-9);
    EXPECT_NEAR(cov(0, 1), 0, 1e-6);
}

/** Images of a texture, each with noise of its own: its corner is found as well as told. */
TEST(PatchUncertainty, OfATextureIsThatOfMonteCarlo)
{
    constexpr int kSize = 40, kDraws = 1000;
    constexpr double kNoise = 3;
    const cv::Point2f centre(20, 20);
    const test::Texture texture(4, 7, 30);
    cv::Mat_<double> clean(kSize, kSize);
    clean.forEach([&](double& grey, const int* at) { grey = texture(at[1], at[0]); });
    test::GaussianSampler random(1);
    const auto grey = [&](int u, int v) { return clean(v, u); };
    const auto draw = [&] { return test::renderImage(kSize, kSize, grey, kNoise, &random); };
    for (const Brightness brightness : {Brightness::Constant, Brightness::Shifted})
    {
        std::vector<Eigen::Vector2d> errors;
        Eigen::Matrix2d told = Eigen::Matrix2d::Zero();
        for (int i = 0; i < kDraws; ++i)
        {
            const cv::Mat reference = draw();
            const Patch patch(reference, derivativesOf(reference), centre, kWindowPx / 2);
            const PatchUncertainty uncertainty = patchUncertainty(patch, kNoise, brightness);
            told += uncertainty.covariance(1) / kDraws;
            WarpedPatches patches;
            patches.reserve(1, kWindowPx / 2);
            patches.add(patch, brightness, uncertainty.measured(1));
            cv::Point2f found = centre;
            ASSERT_TRUE(patches.refine(0, draw(), Eigen::Matrix2d::Identity(), found));
            errors.emplace_back(
                static_cast<double>(found.x - centre.x), static_cast<double>(found.y - centre.y));
        }
        EXPECT_LT(test::whitenedDifference(test::sampleCovariance<2>(errors), told), 0.2);
    }
}

TEST(PatchUncertainty, ASlopeGoesWhereItsBrightnessIs)
{
    const cv::Mat gray = test::renderImage(100, 100, [](double u, double) { return 20 + 2 * u; });
    const auto displacementWith = [&](Brightness brightness)
    { return inTheMiddle(gray, 1.0, brightness).displacement(0.2); };
    // 120 grey levels at its centre, 2 a pixel.
    EXPECT_NEAR(displacementWith(Brightness::Constant).x(), -120.0 / 2, 0.1);
    EXPECT_EQ(displacementWith(Brightness::Constant).y(), 0) << "not measured";
    EXPECT_TRUE(displacementWith(Brightness::Shifted).isZero(0));
}

TEST(PatchUncertainty, BrightnessHardlyMovesAnEdge)
{
    cv::Mat gray(100, 100, CV_8UC1, cv::Scalar(150));
    gray(cv::Rect(50, 0, 50, 100)).setTo(50);
    const PatchUncertainty u = inTheMiddle(gray, 1.0, Brightness::Constant);
    // Gradients of -50 where it is 150 and 50.
    EXPECT_NEAR(u.displacement(0.2).x(), 50 * (150 + 50) / (2 * 50.0 * 50.0), 0.01);
    EXPECT_NEAR(u.displacement(0.2).y(), 0, 1e-6);
}

TEST(PatchUncertainty, WeakStructureOnAnEdgeDoesNotCount)
{
    for (const auto& [step, counts] : {std::pair(4, false), std::pair(20, true)})
    {
        cv::Mat gray(100, 100, CV_8UC1, cv::Scalar(150));
        gray(cv::Rect(0, 50, 50, 50)).setTo(150 - step);
        gray(cv::Rect(50, 0, 50, 100)).setTo(50);
        const PatchUncertainty u = inTheMiddle(gray, 0.3, Brightness::Constant);
        EXPECT_EQ(std::isfinite(u.worst()), counts) << step;
        EXPECT_LT(u.best(), 0.01);
    }
}

TEST(PatchUncertainty, OfNoiseIsLarge)
{
    const cv::Mat gray = test::blankWall(1.5), derivatives = derivativesOf(gray);
    const double noise = imageNoise(gray);
    for (int v = 20; v < 460; v += 40)
    {
        for (int u = 20; u < 620; u += 40)
        {
            const cv::Point2f centre(static_cast<float>(u), static_cast<float>(v));
            EXPECT_GT(
                patchUncertainty(
                    Patch(gray, derivatives, centre, kWindowPx / 2), noise, Brightness::Constant)
                    .worst(),
                0.1);
        }
    }
}
