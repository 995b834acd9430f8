// SPDX-License-Identifier: BSD-3-Clause
#include "reference_points.h"

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include <algorithm>
#include <utility>

#include "image_noise.h"
#include "local_surface.h"
#include "patch_uncertainty.h"
#include "reference_patches.h"

namespace pointplane
{
namespace
{
/** Structure in both directions (a corner: a shift of brightness is solved for), or in one (an
 * edge: brightness is taken as constant). */
struct Candidate
{
    PointFeature point;
    Patch patch;
    PatchUncertainty uncertainty;
    Brightness brightness;
};

/** \param pyramid with derivatives. Corners are looked for in the halved image, four times as fast:
 * a patch that is searched for needs structure in it, its centre may be anywhere. */
std::vector<cv::Point2f> cornersOf(
    const std::vector<cv::Mat>& pyramid, const PointTracker::TParams& params)
{
    constexpr size_t kHalved = 2;  // images and derivatives take turns
    const bool isHalved = pyramid.size() > kHalved;
    const float scale = isHalved ? 2.0F : 1.0F;
    std::vector<cv::Point2f> out;
    cv::goodFeaturesToTrack(
        pyramid[isHalved ? kHalved : 0],
        out,
        2 * params.maxPoints,
        params.cornerQuality,
        params.minSpacingFraction * pyramid[0].cols / static_cast<double>(scale));
    for (cv::Point2f& corner : out)
    {
        corner *= scale;
    }
    return out;
}

/** Corners have structure enough nearer to their centre, where the surface is flatter. */
Patch middleOf(const Patch& window)
{
    const int halfPx = std::max(3 * window.halfPx() / 4, WarpedPatches::kComparedPx / 2);
    return window.inner(std::min(halfPx, window.halfPx()));
}

/** Nothing without structure or depth, and nothing on an edge where the depth jumps. */
std::optional<Candidate> candidateAt(
    const cv::Point2f& pixel,
    const RgbdFrame& frame,
    const cv::Mat& derivatives,
    double noise,
    const PointTracker::TParams& params,
    const PointLifter& lifter)
{
    constexpr double kEdgeOfCorner = 0.5;  // an edge's noise across it, of what a corner may have
    if (!isWellInside(pixel, frame.gray))
    {
        return {};
    }
    Patch patch(frame.gray, derivatives, pixel, params.windowPx / 2);
    const bool isCorner =
        patchUncertainty(patch, noise, Brightness::Shifted).worst() <= params.maxNoisePx;
    if (isCorner)
    {
        patch = middleOf(patch);
    }
    const Brightness brightness = isCorner ? Brightness::Shifted : Brightness::Constant;
    const PatchUncertainty uncertainty = patchUncertainty(patch, noise, brightness);
    if (!(uncertainty.best() <= (isCorner ? 1 : kEdgeOfCorner) * params.maxNoisePx))
    {
        return {};
    }
    const auto point = lifter.lift(frame, Eigen::Vector2f(pixel.x, pixel.y).cast<double>());
    if (!point || (!isCorner && isNearDepthJump(frame, *point)))
    {
        return {};
    }
    return Candidate{*point, std::move(patch), uncertainty, brightness};
}
}  // namespace

PointReference referencePoints(
    const RgbdFrame& frame, const PointTracker::TParams& params, const PointLifter& lifter)
{
    std::vector<cv::Mat> pyramid;
    cv::buildOpticalFlowPyramid(
        frame.gray, pyramid, {params.windowPx, params.windowPx}, params.numLevels - 1, true);
    const std::vector<cv::Point2f> corners = cornersOf(pyramid, params);
    const size_t maxPoints = std::min(corners.size(), static_cast<size_t>(params.maxPoints));
    const auto patches =
        std::make_shared<ReferencePatches>(params.windowPx, maxPoints, pyramid.size() / 2);
    PointReference out;
    const auto add = [&](const Candidate& c)
    {
        const Directions measured = c.uncertainty.measured(params.maxNoisePx);
        patches->add(pyramid, c.patch, c.brightness, measured);
        out.directions.push_back(static_cast<int>(measured.cols()));
        out.points.push_back(c.point);
        out.cov_px.push_back(c.uncertainty.covariance(params.maxNoisePx));
        out.ofBrightness_px.push_back(c.uncertainty.displacement(params.maxNoisePx));
    };
    const double noise = imageNoise(frame.gray);
    std::vector<Candidate> edges;
    for (size_t i = 0; i < corners.size() && out.points.size() < maxPoints; ++i)
    {
        auto candidate = candidateAt(corners[i], frame, pyramid[1], noise, params, lifter);
        if (candidate && candidate->brightness == Brightness::Shifted)
        {
            add(*candidate);
        }
        else if (candidate)
        {
            edges.push_back(std::move(*candidate));
        }
    }
    const auto enough = static_cast<size_t>(params.minPoints);
    for (size_t i = 0; i < edges.size() && out.points.size() < enough; ++i)
    {
        add(edges[i]);
    }
    out.patches = patches;
    return out;
}
}  // namespace pointplane
