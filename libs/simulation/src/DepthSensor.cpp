// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/DepthSensor.h>
#include <pointplane/simulation/Random.h>

#include <opencv2/imgproc.hpp>

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
/** Spacing of the points between which the lateral displacement is interpolated [px]. */
constexpr double kLateralGridPx = 4.0;
/** The same of the calibration error [px]. */
constexpr double kCalibrationGridPx = 100.0;

cv::Mat whiteNoise(int rows, int cols, double sigma, std::uint64_t key, std::uint64_t purpose)
{
    cv::Mat out(rows, cols, CV_32FC1);
    for (int v = 0; v < rows; ++v)
    {
        Random random({key, purpose, static_cast<std::uint64_t>(v)});
        auto* row = out.ptr<float>(v);
        for (int u = 0; u < cols; ++u)
        {
            row[u] = static_cast<float>(sigma) * random.gaussian();
        }
    }
    return out;
}

/** Noise with standard deviation sigma whose neighbours share a window x window box. */
cv::Mat windowNoise(
    cv::Size size, int window, double sigma, std::uint64_t key, std::uint64_t purpose)
{
    cv::Mat white =
        whiteNoise(size.height + window - 1, size.width + window - 1, sigma * window, key, purpose);
    if (window == 1)
    {
        return white;
    }
    cv::Mat out;
    cv::boxFilter(white, out, CV_32F, {window, window}, {0, 0});
    return out(cv::Rect(cv::Point(0, 0), size));
}

/** Noise that is interpolated between points of a grid; smoothly (cubic), if it shall have no
 * kinks. */
cv::Mat gridNoise(
    cv::Size size,
    double grid,
    double sigma,
    std::uint64_t key,
    std::uint64_t purpose,
    bool smooth = false)
{
    const int rows = static_cast<int>(std::ceil(size.height / grid)) + 1;
    const int cols = static_cast<int>(std::ceil(size.width / grid)) + 1;
    // Linear interpolation leaves 4/9 of the variance on average in two dimensions, cubic 0.73.
    const double factor = smooth ? 1.17 : 1.5;
    const cv::Mat coarse = whiteNoise(rows, cols, factor * sigma, key, purpose);
    cv::Mat fine;
    cv::resize(coarse, fine, {}, grid, grid, smooth ? cv::INTER_CUBIC : cv::INTER_LINEAR);
    return fine(cv::Rect(cv::Point(0, 0), size));
}
}  // namespace

DepthSensor::DepthSensor(
    const SimulationParams& params, const Scene& scene, std::uint64_t cameraKey)
    : params_(params),
      camera_(params.trueCamera(cameraKey)),
      depthScale_(static_cast<float>(params.depthScale(cameraKey))),
      pixelScale_(params.width / 640.0),
      step_(params.disparityStepPx / params.disparityPxMetre)
{
    // Rounding to multiples of step_ has variance step_^2 / 12; the rest comes from matching.
    const double total = params.sigmaInverseDepth;
    matchingSigma_ = std::sqrt(std::max(0.0, total * total - step_ * step_ / 12));
    if (params.calibrationSigma > 0)
    {
        calibrationError_ = gridNoise(
            {params.width, params.height},
            kCalibrationGridPx * pixelScale_,
            params.calibrationSigma,
            cameraKey,
            5);
    }
    for (const Surface& surface : scene.surfaces)
    {
        hasDepth_.push_back(surface.hasDepth ? 1 : 0);
    }
}

void DepthSensor::dropShadow(const float* inverseDepth, uchar* readable) const
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

void DepthSensor::dropFlat(const CastImage& cast, int v, uchar* readable) const
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

void DepthSensor::dropEdges(const cv::Mat& inverseDepth, int v, uchar* readable) const
{
    const int reach = std::max(1, static_cast<int>(std::lround(params_.edgeLossPx * pixelScale_)));
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

cv::Mat DepthSensor::readable(const CastImage& cast) const
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

DepthSensor::FrameNoise DepthSensor::frameNoise(std::uint64_t frameKey) const
{
    const cv::Size size(camera_.width, camera_.height);
    FrameNoise out;
    if (matchingSigma_ > 0)
    {
        const int window =
            std::max(1, static_cast<int>(std::lround(params_.noiseWindowPx * pixelScale_)));
        out.matching = windowNoise(size, window, matchingSigma_, frameKey, 1);
    }
    if (params_.sigmaDepth > 0)
    {
        out.depth = params_.upsampling == 1
                        ? whiteNoise(size.height, size.width, params_.sigmaDepth, frameKey, 6)
                        : gridNoise(size, params_.upsampling, params_.sigmaDepth, frameKey, 6);
    }
    if (params_.sigmaRelative > 0)
    {
        const double grid = params_.bendGridPx * pixelScale_;
        out.relative = gridNoise(size, grid, params_.sigmaRelative, frameKey, 7, true);
    }
    if (params_.lateralSigmaPx > 0)
    {
        const double grid = std::max(2.0, kLateralGridPx * pixelScale_);
        const double sigma = params_.lateralSigmaPx * pixelScale_;
        gridNoise(size, grid, sigma, frameKey, 2).convertTo(out.dx, CV_16S);
        gridNoise(size, grid, sigma, frameKey, 3).convertTo(out.dy, CV_16S);
    }
    if (!calibrationError_.empty())
    {
        out.matching = out.matching.empty() ? calibrationError_ : out.matching + calibrationError_;
    }
    return out;
}

void DepthSensor::matchRow(
    const CastImage& cast, const cv::Mat& readable, const FrameNoise& noise, int v, float* q) const
{
    const float* truth = cast.inverseDepth.ptr<float>(v);
    const uchar* ok = readable.ptr<uchar>(v);
    if (noise.dx.empty())
    {
        for (int u = 0; u < camera_.width; ++u)
        {
            q[u] = ok[u] != 0 ? truth[u] : 0.0F;
        }
        return;
    }
    const auto* dx = noise.dx.ptr<short>(v);
    const auto* dy = noise.dy.ptr<short>(v);
    for (int u = 0; u < camera_.width; ++u)
    {
        const int x = std::clamp(u + dx[u], 0, camera_.width - 1);
        const int y = std::clamp(v + dy[u], 0, camera_.height - 1);
        const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(y - v) * camera_.width + x;
        q[u] = ok[from] != 0 ? truth[from] : 0.0F;
    }
}

void DepthSensor::addLengths(const FrameNoise& noise, int v, float* depth) const
{
    for (int u = 0; !noise.relative.empty() && u < camera_.width; ++u)
    {
        depth[u] *= 1 + noise.relative.at<float>(v, u);
    }
    for (int u = 0; !noise.depth.empty() && u < camera_.width; ++u)
    {
        depth[u] += noise.depth.at<float>(v, u);
    }
}

cv::Mat DepthSensor::sense(const CastImage& cast, std::uint64_t frameKey) const
{
    const cv::Mat ok = readable(cast);
    const FrameNoise noise = frameNoise(frameKey);
    const auto step = static_cast<float>(step_);
    const float perStep = 1.0F / step;
    std::vector<float> q(static_cast<std::size_t>(camera_.width));
    cv::Mat depth(camera_.height, camera_.width, CV_32FC1);
    for (int v = 0; v < camera_.height; ++v)
    {
        matchRow(cast, ok, noise, v, q.data());
        if (!noise.matching.empty())
        {
            const auto* error = noise.matching.ptr<float>(v);
            for (int u = 0; u < camera_.width; ++u)
            {
                const auto k = static_cast<std::size_t>(u);
                q[k] = q[k] > 0 ? q[k] + error[u] : 0.0F;
            }
        }
        if (step > 0)
        {
            for (float& value : q)
            {
                value = step * static_cast<float>(static_cast<int>(value * perStep + 0.5F));
            }
        }
        auto* out = depth.ptr<float>(v);
        for (int u = 0; u < camera_.width; ++u)
        {
            const float value = q[static_cast<std::size_t>(u)];
            out[u] = value > 0 ? depthScale_ / value : std::numeric_limits<float>::quiet_NaN();
        }
        addLengths(noise, v, out);
    }
    return depth;
}
}  // namespace pointplane
