// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/points/PatchAligner.h>

#include <Eigen/LU>
#include <opencv2/core.hpp>

#include <cmath>
#include <stdexcept>

#include "matchers.h"
#include "monte_carlo.h"
#include "texture.h"
#include <gtest/gtest.h>

using namespace pointplane;
using namespace pointplane::test;

namespace
{
constexpr int kWidth = 240, kHeight = 180;
using Vector2d = Eigen::Vector2d;
using Matrix2d = Eigen::Matrix2d;

/** p_ref = A_ref_cur (p_cur - centre) + centre - shift; I_cur = gain I_ref + bias. */
struct View
{
    Matrix2d A_ref_cur{Matrix2d::Identity()};
    Vector2d shift{0, 0};
    double gain{1}, bias{0}, noise{0};

    [[nodiscard]] Vector2d toReference(const Vector2d& cur) const
    {
        const Vector2d centre(0.5 * kWidth, 0.5 * kHeight);
        return A_ref_cur * (cur - shift - centre) + centre;
    }
    [[nodiscard]] Vector2d toCurrent(const Vector2d& ref) const
    {
        const Vector2d centre(0.5 * kWidth, 0.5 * kHeight);
        return A_ref_cur.inverse() * (ref - centre) + centre + shift;
    }
    template <class F>
    [[nodiscard]] cv::Mat render(const F& texture, GaussianSampler& random) const
    {
        return renderImage(
            kWidth,
            kHeight,
            [&](double u, double v)
            {
                const Vector2d p = toReference({u, v});
                return gain * texture(p.x(), p.y()) + bias;
            },
            noise,
            &random);
    }
};

struct Score
{
    int tried{0}, converged{0};
    double rms{0}, worst{0}, nees{0};
};

/** Tracks a grid of patches from a view of the texture to another, from a wrong start. */
Score track(
    const View& from,
    const View& to,
    const PatchAligner::TParams& params,
    const Vector2d& startError,
    unsigned seed = 5)
{
    const Texture texture(seed);
    GaussianSampler random(seed + 100);
    const ImagePyramid reference(from.render(texture, random), params.numLevels);
    const ImagePyramid current(to.render(texture, random), params.numLevels);
    const PatchAligner aligner(params);
    Score score;
    for (double v = 45.3; v < kHeight - 45; v += 7.7)
    {
        for (double u = 45.7; u < kWidth - 45; u += 7.3)
        {
            const PatchReference patch =
                aligner.makeReference(reference, {u, v}, from.A_ref_cur.inverse() * to.A_ref_cur);
            if (!patch.isUsable())
            {
                continue;
            }
            ++score.tried;
            const Vector2d truth = to.toCurrent(from.toReference({u, v}));
            const AlignResult result = aligner.align(patch, current, truth + startError);
            if (!result.isConverged())
            {
                continue;
            }
            ++score.converged;
            const Vector2d error = result.uv_px - truth;
            score.rms += error.squaredNorm();
            score.worst = std::max(score.worst, error.norm());
            score.nees += error.dot(result.cov.inverse() * error);
        }
    }
    score.rms = std::sqrt(score.rms / score.converged / 2);
    score.nees /= 2 * score.converged;
    return score;
}

PatchAligner::TParams oneLevel(int size = 8)
{
    PatchAligner::TParams params;
    params.patchSizePx = size;
    params.numLevels = 1;
    return params;
}
}  // namespace

TEST(PatchAligner, findsSubPixelShifts)
{
    for (const int size : {8, 12, 16})
    {
        for (const Vector2d& shift : {Vector2d(0, 0), Vector2d(0.25, -0.5), Vector2d(0.5, 0.37)})
        {
            View moved;
            moved.shift = shift;
            const Score score = track({}, moved, oneLevel(size), {0.8, -0.7});
            EXPECT_GT(score.tried, 200);
            EXPECT_GT(score.converged, 0.97 * score.tried) << size << " " << shift.transpose();
            EXPECT_LT(score.rms, 0.03) << size << " " << shift.transpose();
        }
    }
}

TEST(PatchAligner, accurateAndHonestWithNoise)
{
    View first, second;
    first.noise = second.noise = 1.5;
    second.shift = {0.3, 0.6};
    for (const int size : {8, 12, 16})
    {
        const Score score = track(first, second, oneLevel(size), {0.5, 0.5});
        EXPECT_GT(score.converged, 0.97 * score.tried) << size;
        EXPECT_LT(score.rms, 0.04) << size;
        EXPECT_NEAR(score.nees, 1, 0.25) << size;
    }
}

TEST(PatchAligner, followsAffineWarps)
{
    View first, second;
    first.noise = second.noise = 1;
    const double c = std::cos(0.35), s = std::sin(0.35);
    second.shift = {0.4, -0.3};
    for (const Matrix2d& A :
         {(Matrix2d() << c, -s, s, c).finished(),           // 20 degrees of roll
          (Matrix2d() << 1.25, 0, 0, 1.25).finished(),      // 25 % farther
          (Matrix2d() << 0.8, 0.1, -0.05, 0.9).finished(),  // nearer and slanted
          (Matrix2d() << 1.1, 0.3, 0.0, 0.9).finished()})   // sheared
    {
        second.A_ref_cur = A;
        PatchAligner::TParams params = oneLevel();
        const Score score = track(first, second, params, {0.4, -0.4});
        EXPECT_GT(score.tried, 200) << A;
        EXPECT_GT(score.converged, 0.95 * score.tried) << A;
        EXPECT_LT(score.rms, 0.05) << A;
    }
}

TEST(PatchAligner, ignoresGainAndBias)
{
    View first, second;
    first.gain = 0.8;
    second.gain = 0.5;
    second.bias = 50;
    second.noise = 0.5;
    second.shift = {-0.2, 0.45};
    const Score score = track(first, second, oneLevel(), {0.5, 0.5});
    EXPECT_GT(score.converged, 0.97 * score.tried);
    EXPECT_LT(score.rms, 0.04);
    EXPECT_NEAR(score.nees, 1, 0.25);
}

TEST(PatchAligner, coarseToFineReachesFarther)
{
    View first, second;
    first.noise = second.noise = 1;
    PatchAligner::TParams params;
    const Vector2d far(7, -6);
    params.numLevels = 1;
    const Score fineOnly = track(first, second, params, far);
    params.numLevels = 4;
    const Score coarseToFine = track(first, second, params, far);
    EXPECT_LT(fineOnly.converged, 0.5 * fineOnly.tried);
    EXPECT_GT(coarseToFine.converged, 0.9 * coarseToFine.tried);
    EXPECT_LT(coarseToFine.rms, 0.05);
}

TEST(PatchAligner, covarianceMatchesMonteCarlo)
{
    // One patch, many noise realisations in both images, at the worst sub-pixel phase.
    const Texture texture(9);
    GaussianSampler random(51);
    View first, second;
    first.noise = second.noise = 3;
    second.shift = {0.5, 0.5};
    const PatchAligner aligner(oneLevel());
    const Vector2d uv(120, 90);
    std::vector<Vector2d> errors;
    Matrix2d predicted = Matrix2d::Zero();
    const cv::Rect window(96, 66, 48, 48);
    const Vector2d corner(window.x, window.y);
    const auto clean = [&](const View& view)
    {
        cv::Mat out(window.size(), CV_64FC1);
        for (int v = 0; v < out.rows; ++v)
        {
            for (int u = 0; u < out.cols; ++u)
            {
                const Vector2d p = view.toReference(corner + Vector2d(u, v));
                out.at<double>(v, u) = texture(p.x(), p.y());
            }
        }
        return out;
    };
    const cv::Mat cleanFirst = clean(first), cleanSecond = clean(second);
    const auto noisy = [&](const cv::Mat& image, double sigma)
    {
        const auto pixel = [&](int u, int v) { return image.at<double>(v, u); };
        return ImagePyramid(renderImage(image.cols, image.rows, pixel, sigma, &random), 1);
    };
    constexpr int kSamples = 4000;
    for (int i = 0; i < kSamples; ++i)
    {
        const PatchReference patch =
            aligner.makeReference(noisy(cleanFirst, first.noise), uv - corner);
        const AlignResult result = aligner.align(
            patch,
            noisy(cleanSecond, second.noise),
            uv - corner + second.shift + Vector2d(0.3, -0.2));
        ASSERT_TRUE(result.isConverged());
        errors.push_back(result.uv_px + corner - uv - second.shift);
        predicted += result.cov / kSamples;
    }
    const Matrix2d sampled = sampleCovariance(errors);
    EXPECT_LT(whitenedDifference(sampled, predicted), 0.25) << "sampled\n"
                                                            << sampled << "\npredicted\n"
                                                            << predicted;
}

TEST(PatchAligner, edgeIsUncertainAlongItself)
{
    const double angle = 0.4;
    const Vector2d along(-std::sin(angle), std::cos(angle)),
        across(std::cos(angle), std::sin(angle));
    GaussianSampler random(61);
    const auto edge = [&](double u, double v)
    { return 128 + 80 * std::tanh(0.7 * (across.dot(Vector2d(u, v) - Vector2d(60, 50)))); };
    const ImagePyramid reference(renderImage(120, 100, edge, 2, &random), 1);
    const ImagePyramid current(renderImage(120, 100, edge, 2, &random), 1);
    const PatchAligner aligner(oneLevel());
    const PatchReference patch = aligner.makeReference(reference, {60, 50});
    ASSERT_TRUE(patch.isUsable());
    const AlignResult result = aligner.align(patch, current, Vector2d(60, 50) + 0.6 * across);
    ASSERT_TRUE(result.isConverged());
    EXPECT_NEAR(across.dot(result.uv_px - Vector2d(60, 50)), 0, 0.1);
    EXPECT_GT(std::sqrt(along.dot(result.cov * along)), 1);
    EXPECT_LT(std::sqrt(across.dot(result.cov * across)), 0.15);
    EXPECT_TRUE(isPositiveDefinite(result.cov));
}

TEST(PatchAligner, flatAndRampPatchesAreUnusable)
{
    GaussianSampler random(71);
    const auto flat = [](double, double) { return 90.0; };
    const auto ramp = [](double u, double) { return 2 * u; };
    const PatchAligner aligner;
    for (const ImagePyramid& image :
         {ImagePyramid(renderImage(120, 100, flat, 2, &random), 3),
          ImagePyramid(renderImage(120, 100, ramp), 3)})
    {
        const PatchReference patch = aligner.makeReference(image, {60, 50});
        EXPECT_FALSE(patch.isUsable());
        EXPECT_EQ(aligner.align(patch, image, {60, 50}).status, AlignStatus::Unusable);
    }
}

TEST(PatchAligner, anotherTextureIsDissimilar)
{
    GaussianSampler random(72);
    const ImagePyramid reference(renderImage(120, 100, Texture(1)), 1);
    const ImagePyramid current(renderImage(120, 100, Texture(2)), 1);
    const ImagePyramid blank(cv::Mat(100, 120, CV_8UC1, cv::Scalar(50)), 1);
    PatchAligner::TParams params = oneLevel(16);
    params.minZncc = 0.9;
    const PatchAligner aligner(params);
    const PatchReference patch = aligner.makeReference(reference, {60, 50});
    EXPECT_FALSE(aligner.align(patch, current, {60, 50}).isConverged());
    EXPECT_FALSE(aligner.align(patch, blank, {60, 50}).isConverged());
}

TEST(PatchAligner, safeAtEveryBorder)
{
    // Exact-size buffers, so that an address sanitizer sees a read beyond them.
    const Texture texture(3);
    const ImagePyramid image(renderImage(64, 48, texture), 3);
    const PatchAligner aligner;
    const PatchReference patch = aligner.makeReference(image, {30, 24});
    ASSERT_TRUE(patch.isUsable());
    for (double v = -6; v < 54; v += 0.5)
    {
        for (double u = -6; u < 70; u += 0.5)
        {
            const PatchReference border = aligner.makeReference(image, {u, v});
            const bool inside = u >= 4.5 && v >= 4.5 && u < 63 - 4.5 && v < 47 - 4.5;
            EXPECT_TRUE(inside || !border.isUsable()) << u << " " << v;
            const AlignResult result = aligner.align(patch, image, {u, v});
            if (result.isConverged())
            {
                EXPECT_TRUE(result.uv_px.x() >= 3 && result.uv_px.x() <= 60);
            }
        }
    }
    const double nan = std::nan("");
    EXPECT_EQ(aligner.align(patch, image, {nan, 5}).status, AlignStatus::OutOfImage);
    EXPECT_EQ(aligner.align(patch, image, {1e300, 5}).status, AlignStatus::OutOfImage);
    EXPECT_FALSE(aligner.makeReference(image, {nan, 5}).isUsable());
    EXPECT_FALSE(aligner.makeReference(image, {30, 24}, Matrix2d::Zero()).isUsable());
}

TEST(PatchAligner, reusedReferenceForgetsTheOldPatch)
{
    const ImagePyramid image(renderImage(120, 100, Texture(3)), 3);
    const PatchAligner aligner;
    PatchReference reused = aligner.makeReference(image, {40, 50});
    aligner.makeReference(image, {60, 50}, Matrix2d::Identity(), reused);
    const AlignResult a = aligner.align(reused, image, {60.4, 50});
    const AlignResult b = aligner.align(aligner.makeReference(image, {60, 50}), image, {60.4, 50});
    EXPECT_EQ(a.uv_px, b.uv_px);
    EXPECT_EQ(a.cov, b.cov);
    aligner.makeReference(image, {0, 0}, Matrix2d::Identity(), reused);
    EXPECT_FALSE(reused.isUsable());
}

TEST(PatchAligner, checkNamesTheKey)
{
    PatchAligner::TParams params;
    params.patchSizePx = 9;
    EXPECT_THROW(PatchAligner{params}, std::invalid_argument);
    params = {};
    params.numLevels = 7;
    EXPECT_THROW(PatchAligner{params}, std::invalid_argument);
}
