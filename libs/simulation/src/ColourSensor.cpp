// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/simulation/ColourSensor.h>
#include <pointplane/simulation/Random.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

#include "two_pi.h"

namespace pointplane
{
namespace
{
cv::Mat averaged(const std::vector<cv::Mat>& pictures)
{
    if (pictures.size() == 1)
    {
        return pictures.front();
    }
    cv::Mat sum = cv::Mat::zeros(pictures.front().size(), CV_16UC3);
    for (const cv::Mat& picture : pictures)
    {
        cv::add(sum, picture, sum, cv::noArray(), CV_16UC3);
    }
    cv::Mat out;
    sum.convertTo(out, CV_8UC3, 1.0 / static_cast<double>(pictures.size()));
    return out;
}
}  // namespace

ColourSensor::ColourSensor(const SimulationParams& params, std::uint64_t seed)
    : params_(params),
      swingPhase_(Random({seed, 0xe4b}).uniform(0, kTwoPi)),
      falloff_(params.height, params.width, CV_32FC1)
{
    const double cx = 0.5 * (params.width - 1), cy = 0.5 * (params.height - 1);
    for (int v = 0; v < params.height; ++v)
    {
        for (int u = 0; u < params.width; ++u)
        {
            const double r2 = ((u - cx) * (u - cx) + (v - cy) * (v - cy)) / (cx * cx + cy * cy);
            falloff_.at<float>(v, u) = static_cast<float>(1 - params.vignetting * r2);
        }
    }
    for (int i = 0; i < 256; ++i)
    {
        // Half of the variance at mid grey is read-out noise, half is shot noise. With less light
        // the gain multiplies both; of the shot noise there was less.
        const double readOut = 0.5 / (params.light * params.light), shot = i / 256.0 / params.light;
        sigmas_.push_back(static_cast<float>(params.imageNoise * std::sqrt(readOut + shot)));
    }
}

double ColourSensor::gain(double t) const
{
    // Automatic exposure follows slowly, with a jump now and then.
    const double slow = std::sin(kTwoPi * t / 5.3 + swingPhase_);
    const double jump = std::sin(kTwoPi * t / 7.9 + 2 * swingPhase_) > 0.6 ? 1 : 0;
    return 1 + params_.exposureSwing * (0.6 * slow + 0.4 * jump);
}

cv::Mat ColourSensor::sense(
    const std::vector<cv::Mat>& exposures, double t, std::uint64_t frameKey) const
{
    POINTPLANE_CHECK(!exposures.empty(), "no exposure");
    cv::Mat picture = averaged(exposures);
    if (params_.lensBlurPx > 0)
    {
        const double sigma = params_.lensBlurPx * params_.width / 640.0;
        const int side = 1 + 2 * std::max(1, static_cast<int>(std::ceil(3 * sigma - 1)));
        cv::GaussianBlur(picture, picture, {side, side}, sigma, sigma, cv::BORDER_REPLICATE);
    }
    if (params_.imageNoise == 0 && params_.vignetting == 0 && params_.exposureSwing == 0)
    {
        return picture;
    }
    const auto frameGain = static_cast<float>(gain(t));
    cv::Mat out(picture.size(), CV_8UC3);
    for (int v = 0; v < picture.rows; ++v)
    {
        Random random({frameKey, 4, static_cast<std::uint64_t>(v)});
        const auto* in = picture.ptr<uchar>(v);
        const auto* falloff = falloff_.ptr<float>(v);
        auto* row = out.ptr<uchar>(v);
        for (int u = 0; u < picture.cols; ++u)
        {
            float noise[4];
            random.gaussianPair(noise[0], noise[1]);
            random.gaussianPair(noise[2], noise[3]);
            const float brightness = frameGain * falloff[u];
            for (int c = 0; c < 3; ++c)
            {
                const uchar level = in[3 * u + c];
                const float value =
                    static_cast<float>(level) * brightness + 0.5F + sigmas_[level] * noise[c];
                row[3 * u + c] = static_cast<uchar>(std::min(std::max(value, 0.0F), 255.0F));
            }
        }
    }
    return out;
}
}  // namespace pointplane
