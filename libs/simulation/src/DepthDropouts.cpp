// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/DepthDropouts.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace pointplane
{
namespace
{
constexpr double kRadPerDeg = 3.14159265358979323846 / 180;
/** A disparity step larger than this splits a matching window [px]. */
constexpr double kEdgeDisparityPx = 1.0;
}  // namespace

DepthDropouts::DepthDropouts(
    const SimulationParams& params, const PinholeCamera& camera, const Scene& scene)
    : params_(params), camera_(camera)
{
    for (const Surface& surface : scene.surfaces)
    {
        hasDepth_.push_back(surface.hasDepth ? 1 : 0);
    }
}

void DepthDropouts::dropShadow(const float* inverseDepth, uchar* readable) const
{
    // The projector is to the right of the camera: column u lies on its column u - f b / Z. From
    // the right, what lies behind a column already lit is in shadow.
    const auto perInverseDepth = static_cast<float>(camera_.fx * params_.shadowBaseline);
    float lit = std::numeric_limits<float>::max();
    for (int u = camera_.width - 1; u >= 0; --u)
    {
        const float column = static_cast<float>(u) - perInverseDepth * inverseDepth[u];
        if (column > lit + 1.0F)
        {
            readable[u] = 0;
        }
        lit = std::min(lit, column);
    }
}

void DepthDropouts::dropFlat(const CastImage& cast, int v, uchar* readable) const
{
    const auto* q = cast.inverseDepth.ptr<float>(v);
    const auto* id = cast.ids.ptr<std::int32_t>(v);
    const int other = v > 0 ? v - 1 : v + 1;
    const auto* qOther = cast.inverseDepth.ptr<float>(other);
    const auto* idOther = cast.ids.ptr<std::int32_t>(other);
    const auto fx = static_cast<float>(camera_.fx), perFx = static_cast<float>(1 / camera_.fx);
    const auto fyUp = static_cast<float>(camera_.fy / (v - other));
    const auto cx = static_cast<float>(camera_.cx);
    const auto y = static_cast<float>((v - camera_.cy) / camera_.fy);
    const double cosine = std::cos(params_.maxIncidenceDeg * kRadPerDeg);
    const auto minCosineSquared = static_cast<float>(cosine * cosine);
    for (int u = 0; u < camera_.width; ++u)
    {
        // Differences within the surface only; the steeper one at its border.
        const int u0 = std::max(u - 1, 0), u1 = std::min(u + 1, camera_.width - 1);
        const float left = id[u0] == id[u] ? q[u] - q[u0] : 0.0F;
        const float right = id[u1] == id[u] ? q[u1] - q[u] : 0.0F;
        const float gx = fx * (left * left > right * right ? left : right);
        const float gy = idOther[u] == id[u] ? fyUp * (q[u] - qOther[u]) : 0.0F;
        // 1/Z = m . (x, y, 1) on the tangent plane; its normal is m / |m|.
        const float x = (static_cast<float>(u) - cx) * perFx;
        const float gz = q[u] - gx * x - gy * y;
        const float m2 = gx * gx + gy * gy + gz * gz;
        const bool flat = q[u] * q[u] < minCosineSquared * m2 * (x * x + y * y + 1);
        readable[u] = flat ? 0 : readable[u];
    }
}

void DepthDropouts::dropEdges(const cv::Mat& inverseDepth, int v, uchar* readable) const
{
    const int reach =
        std::max(1, static_cast<int>(std::lround(params_.edgeLossPx * params_.pixelScale())));
    const auto step = static_cast<float>(kEdgeDisparityPx / params_.disparityPxMetre);
    const auto* q = inverseDepth.ptr<float>(v);
    const auto* above = inverseDepth.ptr<float>(std::max(v - reach, 0));
    const auto* below = inverseDepth.ptr<float>(std::min(v + reach, camera_.height - 1));
    for (int u = 0; u < camera_.width; ++u)
    {
        const float left = q[std::max(u - reach, 0)];
        const float right = q[std::min(u + reach, camera_.width - 1)];
        const float far = std::max(
            std::max(std::abs(left - q[u]), std::abs(right - q[u])),
            std::max(std::abs(above[u] - q[u]), std::abs(below[u] - q[u])));
        if (far > step)
        {
            readable[u] = 0;
        }
    }
}

cv::Mat DepthDropouts::readable(const CastImage& cast) const
{
    cv::Mat out(camera_.height, camera_.width, CV_8UC1);
    const auto low = static_cast<float>(1 / params_.maxDepth);
    const auto high = static_cast<float>(1 / std::max(params_.minDepth, 1e-3));
    for (int v = 0; v < camera_.height; ++v)
    {
        auto* row = out.ptr<uchar>(v);
        const auto* q = cast.inverseDepth.ptr<float>(v);
        const auto* id = cast.ids.ptr<std::int32_t>(v);
        for (int u = 0; u < camera_.width; ++u)
        {
            row[u] = id[u] >= 0 && q[u] >= low && q[u] <= high &&
                             hasDepth_[static_cast<std::size_t>(id[u])]
                         ? 1
                         : 0;
        }
        if (params_.shadowBaseline > 0)
        {
            dropShadow(q, row);
        }
        if (params_.maxIncidenceDeg < 90)
        {
            dropFlat(cast, v, row);
        }
        if (params_.edgeLossPx > 0)
        {
            dropEdges(cast.inverseDepth, v, row);
        }
    }
    return out;
}
}  // namespace pointplane
