// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/DepthSensor.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include "noise_images.h"

namespace pointplane
{
namespace
{
/** Spacing of the points between which the lateral displacement is interpolated [px]. */
constexpr double kLateralGridPx = 4.0;
/** The same of the calibration error [px]. */
constexpr double kCalibrationGridPx = 100.0;
}  // namespace

DepthSensor::DepthSensor(
    const SimulationParams& params, const Scene& scene, std::uint64_t cameraKey)
    : params_(params),
      camera_(params.trueCamera(cameraKey)),
      dropouts_(params, camera_, scene),
      depthScale_(static_cast<float>(params.depthScale(cameraKey))),
      step_(params.disparityStepPx / params.disparityPxMetre)
{
    // Rounding to multiples of step_ has variance step_^2 / 12; the rest comes from matching.
    const double total = params.sigmaInverseDepth;
    matchingSigma_ = std::sqrt(std::max(0.0, total * total - step_ * step_ / 12));
    if (params.calibrationSigma > 0)
    {
        calibrationError_ = gridNoise(
            {params.width, params.height},
            kCalibrationGridPx * params_.pixelScale(),
            params.calibrationSigma,
            {cameraKey, 5});
    }
}

/** \param length_px in an image 640 px wide \return pixels of this image, at least one */
int DepthSensor::wholePixels(double length_px) const
{
    return std::max(1, static_cast<int>(std::lround(length_px * params_.pixelScale())));
}

/** \return the inverse depth whose depth is the mean over each measured pixel, interpolated between
 * their centres; only pixels with a reading count */
cv::Mat DepthSensor::mixed(const cv::Mat& inverseDepth, const cv::Mat& readable) const
{
    const int side = wholePixels(params_.upsampling);
    const cv::Size measured((camera_.width + side - 1) / side, (camera_.height + side - 1) / side);
    const cv::Size whole = measured * side;
    const auto overMeasuredPixels = [&](const cv::Mat& image)
    {
        cv::Mat out;
        cv::copyMakeBorder(
            image,
            out,
            0,
            whole.height - image.rows,
            0,
            whole.width - image.cols,
            cv::BORDER_REPLICATE);
        cv::resize(out, out, measured, 0, 0, cv::INTER_AREA);
        cv::resize(out, out, whole, 0, 0, cv::INTER_LINEAR);
        return cv::Mat(out, cv::Rect(0, 0, camera_.width, camera_.height));
    };
    cv::Mat share, depth;
    readable.convertTo(share, CV_32F);
    cv::divide(share, inverseDepth, depth);
    depth.setTo(0, readable == 0);  // the sky's is infinite
    cv::Mat out;
    cv::divide(overMeasuredPixels(share), overMeasuredPixels(depth), out);
    return out;
}

DepthSensor::FrameNoise DepthSensor::frameNoise(std::uint64_t frameKey) const
{
    const cv::Size size(camera_.width, camera_.height);
    FrameNoise out;
    if (matchingSigma_ > 0)
    {
        const int window = wholePixels(params_.noiseWindowPx);
        out.matching = windowNoise(size, window, matchingSigma_, {frameKey, 1});
    }
    if (params_.sigmaDepth > 0)
    {
        const int pixels = wholePixels(params_.upsampling);
        out.depth = upsampledNoise(size, pixels, params_.sigmaDepth, {frameKey, 6});
    }
    if (params_.sigmaRelative > 0)
    {
        const double grid = params_.bendGridPx * params_.pixelScale();
        out.relative =
            gridNoise(size, grid, params_.sigmaRelative, {frameKey, 7}, Interpolation::Cubic);
    }
    if (params_.lateralSigmaPx > 0)
    {
        const double grid = std::max(2.0, kLateralGridPx * params_.pixelScale());
        const double sigma = params_.lateralSigmaPx * params_.pixelScale();
        gridNoise(size, grid, sigma, {frameKey, 2}).convertTo(out.dx, CV_16S);
        gridNoise(size, grid, sigma, {frameKey, 3}).convertTo(out.dy, CV_16S);
    }
    if (!calibrationError_.empty())
    {
        out.matching = out.matching.empty() ? calibrationError_ : out.matching + calibrationError_;
    }
    return out;
}

void DepthSensor::matchRow(
    const cv::Mat& inverseDepth,
    const cv::Mat& readable,
    const FrameNoise& noise,
    int v,
    float* q) const
{
    const float* truth = inverseDepth.ptr<float>(v);
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
    const cv::Mat ok = dropouts_.readable(cast);
    const cv::Mat truth = params_.mixedPixels ? mixed(cast.inverseDepth, ok) : cast.inverseDepth;
    const FrameNoise noise = frameNoise(frameKey);
    const auto step = static_cast<float>(step_);
    const float perStep = 1.0F / step;
    std::vector<float> q(static_cast<std::size_t>(camera_.width));
    cv::Mat depth(camera_.height, camera_.width, CV_32FC1);
    for (int v = 0; v < camera_.height; ++v)
    {
        matchRow(truth, ok, noise, v, q.data());
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
                value = step * std::floor(value * perStep + 0.5F);
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
