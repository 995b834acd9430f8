// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/points/PatchAligner.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

#include "patch_kernel.h"
#include "patch_template.h"

namespace pointplane
{
namespace
{
constexpr int kMaxPatchPx = 16;
constexpr double kMaxStepPx = 2;   // a longer Gauss-Newton step is not to be trusted
constexpr double kMinGain = 0.05;  // of contrast, current over reference: less is no match
// Rounding to 8 bits in both images: the least noise there is [grey^2].
constexpr double kQuantisationVariance = 2.0 / 12;
constexpr double kInterpolationSigmaPx = 0.01;  // error of the cubic interpolation, measured
constexpr double kCoarseConvergencePx = 0.05;   // the next finer level goes on from there

/** Where the search of one level ended. */
struct LevelResult
{
    AlignStatus status{AlignStatus::NotConverged};
    Eigen::Vector2d uv_px{0, 0};
    double zncc{-1};
    double noiseGain{1};
    int iterations{0};
};

template <int N>
LevelResult searchLevel(
    const PatchReference::Level& level,
    const float* data,
    const cv::Mat& image,
    const Eigen::Vector2d& start,
    double convergencePx,
    const PatchAligner::TParams& params)
{
    constexpr double kHalf = 0.5 * (N - 1);
    alignas(64) float patch[N * N];
    LevelResult out;
    out.uv_px = start;
    while (out.iterations < params.maxIterations)
    {
        const double u = out.uv_px.x() - kHalf, v = out.uv_px.y() - kHalf;
        if (!isInside(image, u, v, u + N - 1, v + N - 1))
        {
            out.status = AlignStatus::OutOfImage;
            return out;
        }
        ++out.iterations;
        const int x = static_cast<int>(u), y = static_cast<int>(v);
        const patch_kernel::CubicWeights wx(static_cast<float>(u - x));
        const patch_kernel::CubicWeights wy(static_cast<float>(v - y));
        patch_kernel::sample<N>(
            image.ptr<uint8_t>(y - 1) + x - 1, image.step[0], wx, wy, level.mean, patch);
        const patch_kernel::Sums sums = patch_kernel::correlate<N>(patch, data);
        const double energy = static_cast<double>(sums.II - sums.I * sums.I / (N * N));
        const double gain = std::sqrt(std::max(0.0, energy) / static_cast<double>(level.energy));
        out.zncc = 0;
        out.noiseGain = static_cast<double>(wx.noiseGain() * wy.noiseGain());
        if (gain < kMinGain)
        {
            return out;
        }
        out.zncc = static_cast<double>(sums.IT / level.energy) / gain;
        Eigen::Vector2d step =
            level.inverse *
            Eigen::Vector2d(static_cast<double>(sums.Ix), static_cast<double>(sums.Iy)) / gain;
        const double length = step.norm();
        if (length > kMaxStepPx)
        {
            step *= kMaxStepPx / length;
        }
        out.uv_px -= step;  // inverse composition: the template moved by +step
        if (length < convergencePx)
        {
            out.status = AlignStatus::Converged;
            return out;
        }
        if ((out.uv_px - start).squaredNorm() > N * N)
        {
            return out;
        }
    }
    return out;
}

LevelResult searchLevel(
    const PatchReference::Level& level,
    const float* data,
    const cv::Mat& image,
    const Eigen::Vector2d& start,
    double convergencePx,
    const PatchAligner::TParams& params)
{
    switch (params.patchSizePx)
    {
        case 8:
            return searchLevel<8>(level, data, image, start, convergencePx, params);
        case 12:
            return searchLevel<12>(level, data, image, start, convergencePx, params);
        default:
            return searchLevel<16>(level, data, image, start, convergencePx, params);
    }
}

/** sigma^2 H^-1 of the final position; see the class comment. */
Eigen::Matrix2d positionCovariance(
    const PatchReference::Level& level, const LevelResult& result, int patchSize)
{
    const int count = patchSize * patchSize;
    const double residual = 2 * static_cast<double>(level.energy) * (1 - result.zncc);
    // Pixel noise of both images together, in grey levels of the reference.
    const double meanGain = 0.5 * (level.noiseGain + result.noiseGain);
    const double variance = std::max(residual / (count - 4) / meanGain, kQuantisationVariance);
    // Gradients of noise are no information; half of the noise is the reference's.
    const double fromNoise = gradientNoise(count, level, 0.5 * variance);
    const double maxVariance = 0.25 * count;
    const EigenSolver2 es(level.hessian);
    Eigen::Vector2d variances;
    for (int i = 0; i < 2; ++i)
    {
        const Eigen::Vector2d axis = es.eigenvectors().col(i);
        const bool isSearched = axis.dot(level.inverse * axis) > 0.5 / es.eigenvalues()[i];
        const double information = (es.eigenvalues()[i] - fromNoise) / variance;
        variances[i] = isSearched && information * maxVariance > 1 ? 1 / information : maxVariance;
        variances[i] += kInterpolationSigmaPx * kInterpolationSigmaPx;
    }
    return es.eigenvectors() * variances.asDiagonal() * es.eigenvectors().transpose();
}
}  // namespace

void PatchAligner::TParams::check() const
{
    POINTPLANE_CHECK(
        patchSizePx == 8 || patchSizePx == 12 || patchSizePx == 16,
        "patchSizePx = " << patchSizePx << " is not 8, 12 or 16");
    POINTPLANE_CHECK(
        numLevels >= 1 && numLevels <= PatchReference::kMaxLevels,
        "numLevels = " << numLevels << " is not in [1, " << PatchReference::kMaxLevels << "]");
    POINTPLANE_CHECK(maxIterations > 0, "maxIterations = " << maxIterations << " is not positive");
    POINTPLANE_CHECK(convergencePx > 0, "convergencePx = " << convergencePx << " is not positive");
    POINTPLANE_CHECK(noise >= 0, "noise = " << noise << " is negative");
    POINTPLANE_CHECK(minContrast > 0, "minContrast = " << minContrast << " is not positive");
    POINTPLANE_CHECK(minZncc >= -1 && minZncc < 1, "minZncc = " << minZncc << " is not in [-1, 1)");
}

PatchAligner::PatchAligner(const TParams& params) : params_(params) { params.check(); }

void PatchAligner::makeReference(
    const ImagePyramid& reference,
    const Eigen::Vector2d& uv_px,
    const Eigen::Matrix2d& A_ref_cur,
    PatchReference& out) const
{
    POINTPLANE_CHECK(!reference.empty(), "the reference image pyramid is empty");
    const int n = params_.patchSizePx;
    float samples[(kMaxPatchPx + 2) * (kMaxPatchPx + 2)];
    out.levels.fill({});
    out.data.resize(static_cast<size_t>(3 * n * n * params_.numLevels));
    const double zoom = std::sqrt(std::abs(A_ref_cur.determinant()));
    if (!uv_px.allFinite() || !A_ref_cur.allFinite() || !(zoom > 0.1 && zoom < 10))
    {
        return;
    }
    // Sample the reference at the level whose pixels are nearest in size to the current image's.
    const int levelShift = static_cast<int>(std::lround(std::log2(zoom)));
    for (int i = 0; i < params_.numLevels; ++i)
    {
        const int source = std::clamp(i + levelShift, 0, reference.numLevels() - 1);
        PatchReference::Level& level = out.levels[static_cast<size_t>(i)];
        level.noiseGain = sampleWarped(
            reference.level(source),
            std::ldexp(1.0, -source) * uv_px,
            std::ldexp(1.0, i - source) * A_ref_cur,
            n,
            samples);
        if (level.noiseGain > 0)
        {
            fillLevel(samples, params_, level, out.data.data() + 3 * n * n * i);
        }
    }
}

PatchReference PatchAligner::makeReference(
    const ImagePyramid& reference,
    const Eigen::Vector2d& uv_px,
    const Eigen::Matrix2d& A_ref_cur) const
{
    PatchReference out;
    makeReference(reference, uv_px, A_ref_cur, out);
    return out;
}

AlignResult PatchAligner::align(
    const PatchReference& reference,
    const ImagePyramid& current,
    const Eigen::Vector2d& start_px) const
{
    AlignResult out;
    out.uv_px = start_px;
    if (!reference.isUsable() || current.empty())
    {
        return out;
    }
    if (!start_px.allFinite())
    {
        out.status = AlignStatus::OutOfImage;
        return out;
    }
    const int n = params_.patchSizePx;
    LevelResult result;
    for (int i = std::min(params_.numLevels, current.numLevels()) - 1; i >= 0; --i)
    {
        const PatchReference::Level& level = reference.levels[static_cast<size_t>(i)];
        if (!level.isUsable)
        {
            continue;
        }
        result = searchLevel(
            level,
            reference.data.data() + 3 * n * n * i,
            current.level(i),
            std::ldexp(1.0, -i) * out.uv_px,
            i == 0 ? params_.convergencePx : std::max(params_.convergencePx, kCoarseConvergencePx),
            params_);
        out.iterations += result.iterations;
        // A coarse level that got nowhere must not spoil the start of the finer one.
        if (i == 0 || (result.status == AlignStatus::Converged && result.zncc >= params_.minZncc))
        {
            out.uv_px = std::ldexp(1.0, i) * result.uv_px;
        }
    }
    out.zncc = result.zncc;
    out.status = result.status;
    if (out.status == AlignStatus::Converged && out.zncc < params_.minZncc)
    {
        out.status = AlignStatus::Dissimilar;
    }
    out.cov = positionCovariance(reference.levels[0], result, n);
    return out;
}
}  // namespace pointplane
