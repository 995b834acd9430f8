// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

#include "monte_carlo.h"

namespace pointplane::test
{
/** A random grey texture as a sum of sine waves: known at every real position, so that images moved
 * or warped by a fraction of a pixel are exact. */
class Texture
{
 public:
    /** \param minPeriodPx finest detail \param maxPeriodPx coarsest \param contrast standard
     * deviation [grey] */
    explicit Texture(
        unsigned seed, double minPeriodPx = 7, double maxPeriodPx = 60, double contrast = 35)
    {
        GaussianSampler random(seed);
        constexpr int kWaves = 40;
        amplitude_ = contrast * std::sqrt(2.0 / kWaves);
        for (int i = 0; i < kWaves; ++i)
        {
            const double period =
                minPeriodPx * std::pow(maxPeriodPx / minPeriodPx, random.uniform());
            const double angle = random.uniform(0, 6.283185307179586);
            const double k = 6.283185307179586 / period;
            waves_.push_back(
                {k * std::cos(angle), k * std::sin(angle), random.uniform(0, 6.283185307179586)});
        }
    }

    [[nodiscard]] double operator()(double u, double v) const
    {
        double sum = 0;
        for (const Wave& w : waves_)
        {
            sum += std::sin(w.ku * u + w.kv * v + w.phase);
        }
        return 128 + amplitude_ * sum;
    }

 private:
    struct Wave
    {
        double ku, kv, phase;
    };
    std::vector<Wave> waves_;
    double amplitude_;
};

/** CV_8UC1 image of grey(u, v), rounded and clipped, with white noise. */
template <class F>
[[nodiscard]] cv::Mat renderImage(
    int width, int height, const F& grey, double noiseSigma = 0, GaussianSampler* random = nullptr)
{
    cv::Mat out(height, width, CV_8UC1);
    for (int v = 0; v < height; ++v)
    {
        for (int u = 0; u < width; ++u)
        {
            const double noise = noiseSigma > 0 ? noiseSigma * random->normal() : 0;
            out.at<uint8_t>(v, u) =
                static_cast<uint8_t>(std::clamp(std::lround(grey(u, v) + noise), 0L, 255L));
        }
    }
    return out;
}

/** A wall without texture, a little brighter to one side. */
[[nodiscard]] inline cv::Mat blankWall(double noise)
{
    GaussianSampler random(3);
    return renderImage(
        640, 480, [](double u, double v) { return 90 + 0.1 * u + 0.05 * v; }, noise, &random);
}
}  // namespace pointplane::test
