// SPDX-License-Identifier: BSD-3-Clause
#include "warped_patches.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include <array>
#include <cmath>

#include "monte_carlo.h"
#include "texture.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int kHalfPx = 7;
const Vector2d kPlace(80.3, 61.6);  //!< of the patch in the warped image
const Directions kBoth = Matrix2d::Identity();

cv::Mat textured(unsigned seed) { return test::renderImage(160, 120, test::Texture(seed, 7, 40)); }

/** The same, its pixels moved by a map around (70, 55), which comes to kPlace. */
cv::Mat warped(unsigned seed, const Matrix2d& A, double brighter = 0)
{
    const test::Texture texture(seed, 7, 40);
    const Matrix2d inverse = A.inverse();
    return test::renderImage(
        160,
        120,
        [&](double u, double v)
        {
            const Vector2d from = Vector2d(70, 55) + inverse * (Vector2d(u, v) - kPlace);
            return brighter + texture(from.x(), from.y());
        });
}

WarpedPatches patchAt(
    const cv::Mat& gray,
    const cv::Point2f& centre,
    const Directions& measured,
    Brightness brightness = Brightness::Shifted)
{
    std::vector<cv::Mat> pyramid;
    cv::buildOpticalFlowPyramid(gray, pyramid, {15, 15}, 0, true);
    WarpedPatches out;
    out.add(Patch(pyramid[0], pyramid[1], centre, kHalfPx), brightness, measured);
    return out;
}

/** How far beside its place a patch is found, from a start nearby; rms over textures [px]. */
double errorWith(const Matrix2d& told, const Matrix2d& A, double brighter = 0)
{
    double sum = 0;
    constexpr int kTextures = 8;
    for (unsigned seed = 1; seed <= kTextures; ++seed)
    {
        const WarpedPatches patches = patchAt(textured(seed), {70, 55}, kBoth);
        cv::Point2f position(80.8F, 61.2F);
        EXPECT_TRUE(patches.refine(0, warped(seed, A, brighter), told, position));
        sum += (Vector2d(position.x, position.y) - kPlace).squaredNorm();
    }
    return std::sqrt(sum / kTextures);
}
}  // namespace

TEST(WarpedPatches, findsWhatIsTurnedLargerOrSlanted)
{
    const Matrix2d turned = Eigen::Rotation2Dd(0.14).toRotationMatrix();
    const Matrix2d larger = 1.15 * Matrix2d::Identity();
    Matrix2d slanted;
    slanted << 0.85, 0.1, 0, 1;
    for (const Matrix2d& A : {turned, larger, slanted})
    {
        EXPECT_LT(errorWith(A, A), 0.05) << A;
        EXPECT_GT(errorWith(Matrix2d::Identity(), A), 0.2) << "found as if it were only shifted";
    }
}

/** From where it ended, it goes nowhere, also if it is told the wrong turn. */
TEST(WarpedPatches, theSearchGoesOnUntilItHasArrived)
{
    const Matrix2d turned = Eigen::Rotation2Dd(0.14).toRotationMatrix();
    for (unsigned seed = 1; seed <= 8; ++seed)
    {
        const WarpedPatches patches = patchAt(textured(seed), {70, 55}, kBoth);
        const cv::Mat image = warped(seed, turned);
        cv::Point2f first(81.3F, 60.6F);
        ASSERT_TRUE(patches.refine(0, image, Matrix2d::Identity(), first));
        cv::Point2f second = first;
        ASSERT_TRUE(patches.refine(0, image, Matrix2d::Identity(), second));
        EXPECT_LT(cv::norm(second - first), 0.05) << seed;
    }
}

TEST(WarpedPatches, aShiftOfBrightnessDoesNotMatter)
{
    const Matrix2d A = Eigen::Rotation2Dd(0.05).toRotationMatrix();
    EXPECT_NEAR(errorWith(A, A, 25), errorWith(A, A), 0.02);
}

/** The step by hand: a slope of 8 grey levels per pixel, 4 levels brighter. */
TEST(WarpedPatches, constantBrightnessFollowsASlope)
{
    const auto slope = [](double brighter)
    {
        return test::renderImage(
            40, 40, [=](double u, double) { return 8 * (u - 20) + 100 + brighter; });
    };
    const Directions across = Vector2d(1, 0);
    cv::Point2f position(20, 20);
    EXPECT_TRUE(patchAt(slope(0), position, across, Brightness::Constant)
                    .refine(0, slope(4), Matrix2d::Identity(), position));
    EXPECT_NEAR(position.x, 19.5, 1e-4);
    EXPECT_EQ(position.y, 20);
}

/** By hand: every pixel is 3 grey levels off, in turns, so the mean square is 9. Four pixels tell
 * as much as one; the slope of 8 levels per pixel over 15 x 15 pixels tells the position by 8. */
TEST(WarpedPatches, whatDoesNotFitIsNoise)
{
    const auto slope = [](double off)
    {
        return test::renderImage(
            40,
            40,
            [=](double u, double v)
            {
                const bool isEven = (std::lround(u) + std::lround(v)) % 2 == 0;
                return 8 * (u - 5) + (isEven ? off : -off);
            });
    };
    cv::Point2f position(20, 20);
    const auto variance = patchAt(slope(0), position, Vector2d(1, 0), Brightness::Constant)
                              .refine(0, slope(3), Matrix2d::Identity(), position);
    ASSERT_TRUE(variance);
    EXPECT_NEAR(*variance, 4 * 9.0 / (15 * 15 * 8 * 8), 1e-4);

    for (const int brighter : {0, 20})
    {
        position = {70, 55};
        const auto same = patchAt(textured(1), position, kBoth)
                              .refine(0, textured(1) + brighter, Matrix2d::Identity(), position);
        ASSERT_TRUE(same);
        EXPECT_NEAR(*same, 0, 1e-6) << brighter;
    }
}

/** Noise that is the same in squares of 2 x 2 pixels moves the position as much as is stated. */
TEST(WarpedPatches, theVarianceIsThatOfManyImages)
{
    test::GaussianSampler random(1);
    double stated = 0, squares = 0;
    constexpr int kImages = 300;
    const std::array<cv::Mat, 3> images{textured(1), textured(2), textured(3)};
    for (int k = 0; k < kImages; ++k)
    {
        const cv::Mat& image = images[static_cast<size_t>(k) % images.size()];
        cv::Mat noise(image.rows / 2, image.cols / 2, CV_32FC1), noisy;
        for (auto& value : cv::Mat_<float>(noise))
        {
            value = static_cast<float>(3 * random.normal());
        }
        cv::resize(noise, noise, image.size(), 0, 0, cv::INTER_NEAREST);
        cv::add(image, noise, noisy, cv::noArray(), CV_8U);
        cv::Point2f position(70, 55);
        const auto variance =
            patchAt(image, position, kBoth).refine(0, noisy, Matrix2d::Identity(), position);
        ASSERT_TRUE(variance);
        stated += *variance / kImages;
        squares +=
            (Vector2d(position.x, position.y) - Vector2d(70, 55)).squaredNorm() / 2 / kImages;
    }
    EXPECT_GT(squares / stated, 0.75);
    EXPECT_LT(squares / stated, 1.25);
}

TEST(WarpedPatches, moveAlongMeasuredDirectionsOnly)
{
    const Vector2d direction = Vector2d(3, 4) / 5;
    const cv::Mat image = textured(3);
    cv::Point2f position(70.4F, 55.1F);
    EXPECT_TRUE(
        patchAt(image, {70, 55}, direction).refine(0, image, Matrix2d::Identity(), position));
    const Vector2d moved(position.x - 70.4F, position.y - 55.1F);
    EXPECT_GT(moved.norm(), 0.05);
    EXPECT_NEAR(std::abs(direction.dot(moved)), moved.norm(), 1e-4);

    cv::Point2f still(70.4F, 55.1F);
    EXPECT_TRUE(
        patchAt(image, {70, 55}, Directions(2, 0)).refine(0, image, Matrix2d::Identity(), still));
    EXPECT_EQ(still, cv::Point2f(70.4F, 55.1F));
}

TEST(WarpedPatches, refuseToLeaveTheImageOrTheirStart)
{
    const cv::Mat image = textured(1);
    const WarpedPatches patches = patchAt(image, {70, 55}, kBoth);
    cv::Point2f position(7.5F, 60);
    EXPECT_FALSE(patches.refine(0, image, 1.2 * Matrix2d::Identity(), position));
    position = {70, 112.5F};
    EXPECT_FALSE(patches.refine(0, image, Matrix2d::Identity(), position));
    position = {70, 55};
    EXPECT_FALSE(patches.refine(0, image, Matrix2d::Constant(std::nan("")), position));

    // A slope that is 30 levels brighter is 3.75 px away.
    const auto slope = [](double brighter)
    {
        return test::renderImage(
            40, 40, [=](double u, double) { return 8 * (u - 20) + 100 + brighter; });
    };
    position = {20, 20};
    EXPECT_FALSE(patchAt(slope(0), position, Directions(Vector2d(1, 0)), Brightness::Constant)
                     .refine(0, slope(30), Matrix2d::Identity(), position));
    EXPECT_EQ(position, cv::Point2f(20, 20)) << "as it was";
}

TEST(WarpedPatches, patchesAtTheImagesBorderAreCut)
{
    const WarpedPatches patches = patchAt(textured(2), {3.2F, 60.7F}, kBoth);
    cv::Point2f position(13.9F, 67.1F);
    const cv::Mat moved = warped(2, Matrix2d::Identity());  // by (10.3, 6.6)
    EXPECT_TRUE(patches.refine(0, moved, Matrix2d::Identity(), position));
    EXPECT_NEAR(position.x, 13.5, 0.05);
    EXPECT_NEAR(position.y, 67.3, 0.05);
}

TEST(WarpedPatches, likenessIsBlindToGainAndBias)
{
    const cv::Mat image = textured(1);
    const WarpedPatches patches = patchAt(image, {70, 55}, kBoth);
    const Likeness same = patches.compare(0, image, {70, 55});
    EXPECT_NEAR(same.zncc, 1, 1e-9);
    EXPECT_EQ(same.brighter, 0);

    cv::Mat changed;
    image.convertTo(changed, CV_8U, 0.8, 30);
    EXPECT_GT(patches.compare(0, changed, {70, 55}).zncc, 0.999);
    EXPECT_LT(patches.compare(0, 255 - image, {70, 55}).zncc, -0.999);
    EXPECT_NEAR(patches.compare(0, image + 20, {70, 55}).brighter, 20, 1e-4);
    EXPECT_LT(patches.compare(0, image, {100, 75}).zncc, 0.8) << "elsewhere";
}

TEST(WarpedPatches, likenessIsSampledBetweenPixels)
{
    // A slope from left to right with a step from top to bottom.
    const auto at = [](double shift)
    {
        return test::renderImage(
            40, 40, [=](double u, double v) { return 4 * (u - shift) + (v < 20 ? 40 : 80); });
    };
    const WarpedPatches patches = patchAt(at(0), {20, 20}, kBoth);
    const Likeness likeness = patches.compare(0, at(0.5), {20.5F, 20});
    EXPECT_NEAR(likeness.zncc, 1, 1e-9);
    EXPECT_NEAR(likeness.brighter, 0, 1e-4);
    EXPECT_NEAR(patches.compare(0, at(0), {20.5F, 20}).brighter, 2, 1e-4);
}

TEST(WarpedPatches, nothingIsLikeAFlatPlace)
{
    const cv::Mat flat(40, 40, CV_8UC1, cv::Scalar(90));
    const WarpedPatches patches = patchAt(textured(1), {70, 55}, kBoth);
    EXPECT_EQ(patches.compare(0, flat, {20, 20}).zncc, 0);
}

TEST(WarpedPatches, whatIsHiddenBesideThePatchDoesNotMatter)
{
    const cv::Mat image = textured(1);
    const WarpedPatches patches = patchAt(image, {70, 55}, kBoth);
    cv::Mat hidden = image.clone();
    hidden(cv::Rect(75, 0, 85, 120)).setTo(0);  // from the fifth column on
    EXPECT_NEAR(patches.compare(0, hidden, {70, 55}).zncc, 1, 1e-9);
    hidden(cv::Rect(74, 0, 86, 120)).setTo(0);
    EXPECT_LT(patches.compare(0, hidden, {70, 55}).zncc, 0.9);
}
}  // namespace pointplane
