// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/core/mat.hpp>

#include <cstddef>

namespace pointplane
{
constexpr int kStrip = 8;        //!< columns that are sampled at once
constexpr int kWeightBits = 14;  //!< of the weights of neighbouring pixels
constexpr int kGreyBits = 5;     //!< of the samples' fraction of a grey level

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

/** In the image or its border. */
template <class T>
const T* elementAt(const cv::Mat& image, const cv::Point& pixel)
{
    const auto step = static_cast<std::ptrdiff_t>(image.step1());
    return image.ptr<T>() + pixel.y * step + std::ptrdiff_t{pixel.x} * image.channels();
}
}  // namespace pointplane
