// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/range.h>
#include <pointplane/points/PointLifter.h>

#include <opencv2/core.hpp>

#include <cmath>

#include "local_surface.h"

namespace pointplane
{
namespace
{
/** Depth with its standard deviation [m]; z = 0 without a usable reading. */
struct DepthReading
{
    double z{0}, sigma{0};
};

/** Of the eight neighbours of a pixel without a reading, so many have to have one: where depth
 * ends, it is of another surface. */
constexpr int kMostNeighbours = 5;

/** Mixture of the Gaussians of the 3x3 readings around a pixel, weights 4 / 2 / 1; the window is
 * cut off at the border of the image. */
DepthReading mixture(
    const cv::Mat& depth, int u, int v, const PointLifter::TParams& params, const DepthNoise& noise)
{
    double sumW = 0, sumVariance = 0, sumScatter = 0;
    int numNeighbours = 0;
    bool hasOwn = false;
    DepthReading out;
    for (int dv = -1; dv <= 1; ++dv)
    {
        for (int du = -1; du <= 1; ++du)
        {
            if (u + du < 0 || v + dv < 0 || u + du >= depth.cols || v + dv >= depth.rows)
            {
                continue;
            }
            const auto z = static_cast<double>(depth.at<float>(v + dv, u + du));
            if (!(z >= params.minDepth && z <= params.maxDepth))  // false for NaN
            {
                continue;
            }
            const double w = (du == 0 ? 2 : 1) * (dv == 0 ? 2 : 1);
            const double sigma = noise.sigmaZ(z);
            sumW += w;
            const double step = z - out.z;
            out.z += w / sumW * step;
            sumVariance += w * sigma * sigma;
            sumScatter += w * step * (z - out.z);
            const bool isOwn = du == 0 && dv == 0;
            hasOwn = hasOwn || isOwn;
            numNeighbours += isOwn ? 0 : 1;
        }
    }
    if (!hasOwn && numNeighbours < kMostNeighbours)
    {
        return {};
    }
    out.sigma = std::sqrt((sumVariance + sumScatter) / sumW);
    return out;
}
}  // namespace

void PointLifter::TParams::check() const
{
    POINTPLANE_CHECK(
        depthModel == "nearest" || depthModel == "mixture",
        "depthModel = " << depthModel << " is not nearest or mixture");
    checkRange("maxEdgeSigmas", maxEdgeSigmas, 0, 1e4);
    checkLength("minDepth", minDepth, 1e-3, 10);
    checkLength("maxDepth", maxDepth, 1e-3, 200);
    POINTPLANE_CHECK(
        maxDepth > minDepth, "maxDepth = " << maxDepth << " is not above minDepth = " << minDepth);
}

PointLifter::PointLifter(const TParams& params, const DepthNoise& noise)
    : params_(params), noise_(noise)
{
    params.check();
}

std::optional<PointFeature> PointLifter::lift(
    const RgbdFrame& frame, const Eigen::Vector2d& uv_px) const
{
    const Eigen::Vector2d onDepth = frame.camera.depthPixel(uv_px);
    if (!(onDepth.x() > -0.5 && onDepth.x() < frame.depth.cols - 0.5 && onDepth.y() > -0.5 &&
          onDepth.y() < frame.depth.rows - 0.5))
    {
        return {};
    }
    const auto u = static_cast<int>(std::lround(onDepth.x()));
    const auto v = static_cast<int>(std::lround(onDepth.y()));
    DepthReading reading = mixture(frame.depth, u, v, params_, noise_);
    const bool isEdge = params_.maxEdgeSigmas > 0 &&
                        reading.sigma > params_.maxEdgeSigmas * noise_.sigmaZ(reading.z);
    if (reading.z == 0 || isEdge)
    {
        return {};
    }
    if (params_.depthModel == "nearest")
    {
        reading.z = static_cast<double>(frame.depth.at<float>(v, u));  // [P17 Eq. 1]
        reading.sigma = noise_.sigmaZ(reading.z);
        if (!(reading.z >= params_.minDepth && reading.z <= params_.maxDepth))
        {
            return {};
        }
    }
    PointFeature out;
    out.uv_px = uv_px;
    out.p_cam = backProject(frame.camera, noise_.sigmaPixelPx, reading.sigma, uv_px, reading.z);
    out.theta_m = localSurface(frame, out);
    return out;
}

PointFeature PointLifter::onRay(
    const RgbdFrame& frame, const Eigen::Vector2d& uv_px, double z) const
{
    PointFeature out;
    out.uv_px = uv_px;
    out.hasDepth = false;
    out.p_cam = backProject(frame.camera, noise_.sigmaPixelPx, z, uv_px, z);
    out.theta_m = {0, 0, -1 / z};
    return out;
}

LiftedPoints PointLifter::liftAll(
    const RgbdFrame& frame, const std::vector<Eigen::Vector2d>& uv_px) const
{
    LiftedPoints out;
    out.points.reserve(uv_px.size());
    out.index.reserve(uv_px.size());
    for (size_t i = 0; i < uv_px.size(); ++i)
    {
        if (const auto point = lift(frame, uv_px[i]))
        {
            out.points.push_back(*point);
            out.index.push_back(static_cast<int>(i));
        }
    }
    return out;
}
}  // namespace pointplane
