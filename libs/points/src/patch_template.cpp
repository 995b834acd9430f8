// SPDX-License-Identifier: BSD-3-Clause
#include "patch_template.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>

namespace pointplane
{
namespace
{
struct Gradient
{
    short x, y;
};

/** Those of one patch. */
class Gradients
{
 public:
    explicit Gradients(int windowPx) : windowPx_(windowPx) {}

    [[nodiscard]] Gradient& at(int x, int y)
    {
        return gradients_[static_cast<std::size_t>(y * windowPx_ + x)];
    }
    [[nodiscard]] const Gradient& at(int x, int y) const
    {
        return gradients_[static_cast<std::size_t>(y * windowPx_ + x)];
    }

    void subtractMean()
    {
        const auto end = gradients_.begin() + windowPx_ * windowPx_;
        int x = 0, y = 0;
        std::for_each(gradients_.begin(), end, [&](const Gradient& g) { x += g.x, y += g.y; });
        const double area = windowPx_ * windowPx_;
        const int meanX = cvRound(x / area), meanY = cvRound(y / area);
        std::for_each(
            gradients_.begin(),
            end,
            [&](Gradient& g) {
                g = {static_cast<short>(g.x - meanX), static_cast<short>(g.y - meanY)};
            });
    }

 private:
    int windowPx_;
    std::array<Gradient, kLongestWindow * kLongestWindow> gradients_;
};

/** Stores a column's gradient as GradientSum wants it. */
void storeGradient(std::int16_t* out, int column, bool isWhole, short gx, short gy)
{
    constexpr int kHalf = kStrip / 2;
    out += isWhole ? 4 * (column % kHalf) + column / kHalf : 2 * column;
    out[0] = gx;
    out[isWhole ? 2 : 1] = gy;
}

/** Sums of products of gradients, in the order of cv::calcOpticalFlowPyrLK: every fourth column of
 * the whole strips, and the last columns. */
class NormalSum
{
 public:
    /** \param column of the strip */
    void add(short gx, short gy, std::size_t column, bool isWhole)
    {
        float* sums = sums_[isWhole ? column % 4 : 4];
        sums[0] += static_cast<float>(gx * gx);
        sums[1] += static_cast<float>(gx * gy);
        sums[2] += static_cast<float>(gy * gy);
    }

    /** \param k 0: x x, 1: x y, 2: y y */
    [[nodiscard]] float total(int k) const
    {
        return sums_[4][k] + ((sums_[0][k] + sums_[2][k]) + (sums_[1][k] + sums_[3][k]));
    }

 private:
    float sums_[5][3] = {};
};

/** Stores a patch's grey values. \return its gradients */
Gradients sampledAt(
    const Bilinear& bilinear,
    const cv::Mat& image,
    const cv::Mat& derivatives,
    int windowPx,
    std::int16_t* strip)
{
    const StripSampler sampler(bilinear);
    Gradients out(windowPx);
    for (int y = 0; y < windowPx; ++y)
    {
        for (int x = 0; x < windowPx; x += kStrip, strip += kStripSamples)
        {
            const cv::Point pixel(bilinear.u + x, bilinear.v + y);
            const auto* grey = elementAt<uchar>(image, pixel);
            cv::v_store(
                strip,
                sampler.grey(
                    StripSampler::neighbours(grey),
                    StripSampler::neighbours(grey + image.step[0])));
            const auto* gradient = elementAt<short>(derivatives, pixel);
            short sampled[2 * kStrip];
            cv::v_store(sampled, sampler.gradients(gradient, derivatives.step1()));
            cv::v_store(
                sampled + kStrip, sampler.gradients(gradient + kStrip, derivatives.step1()));
            for (int k = 0; k < std::min(kStrip, windowPx - x); ++k)
            {
                out.at(x + k, y) = {sampled[2 * k], sampled[2 * k + 1]};
            }
        }
    }
    return out;
}

/** Stores a patch's gradients. \return the sums of their products */
NormalSum storeGradients(const Gradients& gradients, int windowPx, std::int16_t* strip)
{
    NormalSum out;
    for (int y = 0; y < windowPx; ++y)
    {
        for (int x = 0; x < windowPx; x += kStrip, strip += kStripSamples)
        {
            const bool isWhole = x + kStrip <= windowPx;
            for (int k = 0; k < std::min(kStrip, windowPx - x); ++k)
            {
                const auto [gx, gy] = gradients.at(x + k, y);
                storeGradient(strip + kStrip, k, isWhole, gx, gy);
                out.add(gx, gy, static_cast<std::size_t>(k), isWhole);
            }
        }
    }
    return out;
}
}  // namespace

std::size_t templateSize(int windowPx)
{
    const int stripsPerRow = (windowPx + kStrip - 1) / kStrip;
    return static_cast<std::size_t>(windowPx * stripsPerRow * kStripSamples);
}

NormalMatrix sampleTemplate(
    const cv::Mat& image,
    const cv::Mat& derivatives,
    const cv::Point2f& corner,
    int windowPx,
    Brightness brightness,
    std::int16_t* out)
{
    constexpr float kLeastEigenvalue = 1e-4F;
    Gradients gradients = sampledAt(Bilinear(corner), image, derivatives, windowPx, out);
    if (brightness == Brightness::Shifted)
    {
        gradients.subtractMean();
    }
    const NormalSum sum = storeGradients(gradients, windowPx, out);
    NormalMatrix normal{
        sum.total(0) * kProductScale, sum.total(1) * kProductScale, sum.total(2) * kProductScale};
    const float determinant = normal.xx * normal.yy - normal.xy * normal.xy;
    const float difference = normal.xx - normal.yy;
    const float leastEigenvalue =
        (normal.yy + normal.xx - std::sqrt(difference * difference + 4.F * normal.xy * normal.xy)) /
        static_cast<float>(2 * windowPx * windowPx);
    const bool hasStructure = leastEigenvalue >= kLeastEigenvalue && determinant >= FLT_EPSILON;
    normal.inverseDeterminant = hasStructure ? 1.F / determinant : 0.F;
    return normal;
}
}  // namespace pointplane
