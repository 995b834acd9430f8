// SPDX-License-Identifier: BSD-3-Clause
#include "lucas_kanade.h"

#include <opencv2/core/hal/intrin.hpp>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>

namespace pointplane
{
namespace
{
constexpr int kWeightBits = 14;
constexpr int kGreyBits = 5;  //!< of the samples' fraction of a grey level
constexpr float kScale = 1.F / (1 << 20);
constexpr int kStrip = 8;                  //!< columns that are treated at once
constexpr int kStripSamples = 3 * kStrip;  //!< grey, x and y gradients
constexpr int kLongestWindow = 63;

/** A position's whole pixel, and the weights of the four pixels around the position. */
struct Bilinear
{
    explicit Bilinear(const cv::Point2f& position) : u(cvFloor(position.x)), v(cvFloor(position.y))
    {
        const float a = position.x - static_cast<float>(u), b = position.y - static_cast<float>(v);
        constexpr float kOne = 1 << kWeightBits;
        w00 = cvRound((1.F - a) * (1.F - b) * kOne);
        w01 = cvRound(a * (1.F - b) * kOne);
        w10 = cvRound((1.F - a) * b * kOne);
        w11 = (1 << kWeightBits) - w00 - w01 - w10;
    }

    int u, v;
    int w00, w01, w10, w11;
};

/** Bilinear interpolation of neighbouring pixels, rounded. */
class StripSampler
{
 public:
    explicit StripSampler(const Bilinear& b)
        : upper_(pairOf(b.w00, b.w01)), lower_(pairOf(b.w10, b.w11))
    {
    }

    /** Eight pixels, each beside its right neighbour. */
    struct Neighbours
    {
        cv::v_int16x8 first, second;
    };

    [[nodiscard]] static Neighbours neighbours(const uchar* pixel)
    {
        cv::v_uint8x16 pairs, unused;
        cv::v_zip(cv::v_load_low(pixel), cv::v_load_low(pixel + 1), pairs, unused);
        cv::v_uint16x8 a, b;
        cv::v_expand(pairs, a, b);
        return {cv::v_reinterpret_as_s16(a), cv::v_reinterpret_as_s16(b)};
    }

    /** Grey values of eight pixels. */
    [[nodiscard]] cv::v_int16x8 grey(const Neighbours& upper, const Neighbours& lower) const
    {
        return interpolated<kWeightBits - kGreyBits>(
            upper.first, upper.second, lower.first, lower.second);
    }

    /** Gradients of four pixels, x and y in turn. */
    [[nodiscard]] cv::v_int16x8 gradients(const short* pixel, std::size_t step) const
    {
        cv::v_int16x8 a, b, c, d;
        cv::v_zip(cv::v_load(pixel), cv::v_load(pixel + 2), a, b);
        cv::v_zip(cv::v_load(pixel + step), cv::v_load(pixel + step + 2), c, d);
        return interpolated<kWeightBits>(a, b, c, d);
    }

 private:
    [[nodiscard]] static cv::v_int16x8 pairOf(int left, int right)
    {
        const auto bits = static_cast<unsigned>(left & 0xffff) | static_cast<unsigned>(right) << 16;
        return cv::v_reinterpret_as_s16(cv::v_setall_u32(bits));
    }

    /** \param a, b of the upper row \param c, d of the lower one */
    template <int bits>
    [[nodiscard]] cv::v_int16x8 interpolated(
        const cv::v_int16x8& a,
        const cv::v_int16x8& b,
        const cv::v_int16x8& c,
        const cv::v_int16x8& d) const
    {
        const cv::v_int32x4 half = cv::v_setall_s32(1 << (bits - 1));
        const cv::v_int32x4 left = cv::v_dotprod(a, upper_, half) + cv::v_dotprod(c, lower_);
        const cv::v_int32x4 right = cv::v_dotprod(b, upper_, half) + cv::v_dotprod(d, lower_);
        return cv::v_pack(left >> bits, right >> bits);
    }

    cv::v_int16x8 upper_, lower_;
};

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

/** In the image or its border. */
template <class T>
const T* elementAt(const cv::Mat& image, const cv::Point& pixel)
{
    const auto step = static_cast<std::ptrdiff_t>(image.step1());
    return image.ptr<T>() + pixel.y * step + std::ptrdiff_t{pixel.x} * image.channels();
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

PatchTemplates::PatchTemplates(int windowPx) : windowPx_(windowPx) {}

std::size_t PatchTemplates::templateSize() const
{
    const int stripsPerRow = (windowPx_ + kStrip - 1) / kStrip;
    return static_cast<std::size_t>(windowPx_ * stripsPerRow * kStripSamples);
}

void PatchTemplates::reserve(std::size_t patches, std::size_t levels)
{
    normals_.reserve(patches * levels);
    samples_.reserve(patches * levels * templateSize());
}

void PatchTemplates::add(
    const std::vector<cv::Mat>& pyramid, const cv::Point2f& centre, Brightness brightness)
{
    numLevels_ = pyramid.size() / 2;
    const float half = static_cast<float>(windowPx_ - 1) * 0.5F;
    for (std::size_t level = 0; level < numLevels_; ++level)
    {
        const cv::Point2f corner =
            centre * (1.F / static_cast<float>(1 << level)) - cv::Point2f(half, half);
        normals_.push_back(append(pyramid[2 * level], pyramid[2 * level + 1], corner, brightness));
    }
}

/** Adds the samples of one level. */
PatchTemplates::Normal PatchTemplates::append(
    const cv::Mat& image,
    const cv::Mat& derivatives,
    const cv::Point2f& corner,
    Brightness brightness)
{
    constexpr float kLeastEigenvalue = 1e-4F;
    samples_.resize(samples_.size() + templateSize(), 0);
    std::int16_t* const patch = samples_.data() + samples_.size() - templateSize();
    Gradients gradients = sampledAt(Bilinear(corner), image, derivatives, windowPx_, patch);
    if (brightness == Brightness::Shifted)
    {
        gradients.subtractMean();
    }
    const NormalSum sum = storeGradients(gradients, windowPx_, patch);
    Normal normal{sum.total(0) * kScale, sum.total(1) * kScale, sum.total(2) * kScale};
    const float determinant = normal.xx * normal.yy - normal.xy * normal.xy;
    const float difference = normal.xx - normal.yy;
    const float leastEigenvalue =
        (normal.yy + normal.xx - std::sqrt(difference * difference + 4.F * normal.xy * normal.xy)) /
        static_cast<float>(2 * windowPx_ * windowPx_);
    const bool hasStructure = leastEigenvalue >= kLeastEigenvalue && determinant >= FLT_EPSILON;
    normal.inverseDeterminant = hasStructure ? 1.F / determinant : 0.F;
    return normal;
}

/** Sum of the patch's gradients times what the image differs from it. */
cv::Point2f PatchTemplates::correlation(
    const std::int16_t* patch, const cv::Mat& image, const cv::Point2f& corner) const
{
    const Bilinear bilinear(corner);
    const StripSampler sampler(bilinear);
    const auto* pixel = elementAt<uchar>(image, {bilinear.u, bilinear.v});
    return kSumOfRows[windowPx_ / kStrip](sampler, patch, windowPx_, pixel, image.step[0]) * kScale;
}

/** One level. \return whether the patch has structure and the search ended inside */
bool PatchTemplates::align(
    std::size_t patchAndLevel,
    const cv::Mat& image,
    const PatchSearch& search,
    cv::Point2f& position) const
{
    constexpr double kOscillation = 0.01;  // [px]
    const Normal& normal = normals_[patchAndLevel];
    if (normal.inverseDeterminant == 0.F)
    {
        return false;
    }
    const std::int16_t* patch = samples_.data() + patchAndLevel * templateSize();
    const float half = static_cast<float>(windowPx_ - 1) * 0.5F;
    const cv::Point2f centre(half, half);
    cv::Point2f corner = position - centre, previousStep;
    for (int i = 0; i < search.maxIterations; ++i)
    {
        // One row less than the border allows: whole strips are read.
        const int u = cvFloor(corner.x), v = cvFloor(corner.y);
        if (u < -windowPx_ || u >= image.cols || v < -windowPx_ || v >= image.rows - 1)
        {
            return false;
        }
        const cv::Point2f b = correlation(patch, image, corner);
        const cv::Point2f step(
            (normal.xy * b.y - normal.yy * b.x) * normal.inverseDeterminant,
            (normal.xy * b.x - normal.xx * b.y) * normal.inverseDeterminant);
        corner += step;
        position = corner + centre;
        if (step.ddot(step) <= search.epsilon_px * search.epsilon_px)
        {
            break;
        }
        if (i > 0 && static_cast<double>(std::abs(step.x + previousStep.x)) < kOscillation &&
            static_cast<double>(std::abs(step.y + previousStep.y)) < kOscillation)
        {
            position -= step * 0.5F;
            break;
        }
        previousStep = step;
    }
    return true;
}

bool PatchTemplates::find(
    std::size_t patch,
    const std::vector<cv::Mat>& pyramid,
    const PatchSearch& search,
    cv::Point2f& position) const
{
    const std::size_t numLevels =
        std::min({static_cast<std::size_t>(search.numLevels), numLevels_, pyramid.size()});
    position *= 1.F / static_cast<float>(1 << (numLevels - 1));
    bool found = false;
    for (std::size_t level = numLevels; level-- > 0;)
    {
        found = align(patch * numLevels_ + level, pyramid[level], search, position);
        if (level > 0)
        {
            position *= 2.F;
        }
    }
    return found;
}
}  // namespace pointplane
