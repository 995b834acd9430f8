// SPDX-License-Identifier: BSD-3-Clause
#include "template_correlation.h"

#include "patch_template.h"

namespace pointplane
{
namespace
{
/** Sums of differences times gradients, in the order of cv::calcOpticalFlowPyrLK. */
class GradientSum
{
 public:
    /** \param strip of a template */
    void addWhole(const cv::v_int16x8& sample, const std::int16_t* strip)
    {
        const cv::v_int16x8 difference = sample - cv::v_load(strip);
        cv::v_int16x8 low, high, first, second;
        cv::v_zip(difference, difference, low, high);
        cv::v_zip(low, high, first, second);
        first_ += cv::v_cvt_f32(cv::v_dotprod(first, cv::v_load(strip + kStrip)));
        second_ += cv::v_cvt_f32(cv::v_dotprod(second, cv::v_load(strip + 2 * kStrip)));
    }

    /** Column by column. \param isLong has more than four columns */
    void addPart(const cv::v_int16x8& sample, const std::int16_t* strip, bool isLong)
    {
        const cv::v_int16x8 difference = sample - cv::v_load(strip);
        cv::v_int16x8 low, high;
        cv::v_zip(difference, difference, low, high);
        addColumns(low, cv::v_load(strip + kStrip));
        if (isLong)
        {
            addColumns(high, cv::v_load(strip + 2 * kStrip));
        }
    }

    [[nodiscard]] cv::Point2f total() const
    {
        float part[4], whole[4];
        cv::v_store(part, part_);
        cv::v_store(whole, first_ + second_);
        return {part[0] + (whole[0] + whole[2]), part[1] + (whole[1] + whole[3])};
    }

 private:
    void addColumns(const cv::v_int16x8& difference, const cv::v_int16x8& gradient)
    {
        cv::v_int32x4 a, b;
        cv::v_mul_expand(difference, gradient, a, b);
        for (const cv::v_float32x4& columns : {cv::v_cvt_f32(a), cv::v_cvt_f32(b)})
        {
            part_ += columns;
            part_ += cv::v_combine_high(columns, columns);
        }
    }

    cv::v_float32x4 first_{cv::v_setzero_f32()}, second_{cv::v_setzero_f32()};
    cv::v_float32x4 part_{cv::v_setzero_f32()};  //!< x, y
};

/** Sum over all rows of a template. Each row of pixels is the lower one, then the upper one of the
 * next samples: as many strips as a row has are a constant, to stay in registers. */
template <int kNumWhole>
cv::Point2f sumOfRows(
    const StripSampler& sampler,
    const std::int16_t* patch,
    int windowPx,
    const uchar* pixel,
    std::size_t step)
{
    const int rest = windowPx % kStrip;
    GradientSum sum;
    StripSampler::Neighbours upper[kNumWhole + 1];
    for (int k = 0; k <= kNumWhole; ++k)
    {
        upper[k] = StripSampler::neighbours(pixel + k * kStrip);
    }
    for (int y = 0; y < windowPx; ++y)
    {
        pixel += step;
        for (int k = 0; k < kNumWhole; ++k, patch += kStripSamples)
        {
            const auto lower = StripSampler::neighbours(pixel + k * kStrip);
            sum.addWhole(sampler.grey(upper[k], lower), patch);
            upper[k] = lower;
        }
        if (rest > 0)
        {
            const auto lower = StripSampler::neighbours(pixel + kNumWhole * kStrip);
            sum.addPart(sampler.grey(upper[kNumWhole], lower), patch, rest > kStrip / 2);
            upper[kNumWhole] = lower;
            patch += kStripSamples;
        }
    }
    return sum.total();
}

/** By the number of whole strips. */
constexpr decltype(&sumOfRows<0>) kSumOfRows[] = {
    sumOfRows<0>,
    sumOfRows<1>,
    sumOfRows<2>,
    sumOfRows<3>,
    sumOfRows<4>,
    sumOfRows<5>,
    sumOfRows<6>,
    sumOfRows<7>};
}  // namespace

cv::Point2f templateCorrelation(
    const std::int16_t* patch, int windowPx, const cv::Mat& image, const cv::Point2f& corner)
{
    const Bilinear bilinear(corner);
    const StripSampler sampler(bilinear);
    const auto* pixel = elementAt<uchar>(image, {bilinear.u, bilinear.v});
    return kSumOfRows[windowPx / kStrip](sampler, patch, windowPx, pixel, image.step[0]) *
           kProductScale;
}
}  // namespace pointplane
