// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace pointplane
{
/** Mip-mapped colour picture on a surface, sampled trilinearly. A texel is kept as four 16-bit
 * lanes of one word (blue, green, red, 0), so that all channels are interpolated at once. */
class Texture
{
 public:
    Texture() = default;

    /** \param bgr CV_8UC3, at least 4 x 4 \param texel side of a texel [m] */
    Texture(const cv::Mat& bgr, double texel);

    [[nodiscard]] double texel() const { return texel_; }
    [[nodiscard]] bool empty() const { return levels_.empty(); }

    /** \param x, y position in texels of level 0; (0, 0) is the centre of the first
     * \param lod level of detail: log2 of the footprint in texels \return lanes of 0 .. 255 */
    [[nodiscard]] std::uint64_t sample(float x, float y, float lod) const
    {
        const Blend blend = blendOf(lod);
        if (blend.coarse == 0)
        {
            return bilinear(levels_[blend.level], x, y);
        }
        if (blend.coarse == 256)
        {
            return bilinear(levels_[blend.level + 1], x, y);
        }
        const std::uint64_t fine = bilinear(levels_[blend.level], x, y);
        const std::uint64_t coarse = bilinear(levels_[blend.level + 1], x, y);
        return ((fine * (256 - blend.coarse) + coarse * blend.coarse + kHalf) >> 8) & kLanes;
    }

    /** Fetches the memory that sample() with the same arguments will read. Without it, a slanted
     * walk over a picture of many megabytes waits at every step. */
    void prefetch(float x, float y, float lod) const
    {
        const Blend blend = blendOf(lod);
        if (blend.coarse < 256)
        {
            prefetch(levels_[blend.level], x, y);
        }
        if (blend.coarse > 0)
        {
            prefetch(levels_[blend.level + 1], x, y);
        }
    }

 private:
    struct Level
    {
        /** Bounded 24.8 fixed point coordinates. \param x, y texels of level 0 */
        [[nodiscard]] int fixedX(float x) const
        {
            return std::clamp(static_cast<int>((x + 0.5F) * scale) - 128, 0, width * 256 - 257);
        }
        [[nodiscard]] int fixedY(float y) const
        {
            return std::clamp(static_cast<int>((y + 0.5F) * scale) - 128, 0, height * 256 - 257);
        }
        [[nodiscard]] const std::uint64_t* at(int xi, int yi) const
        {
            return texels.data() + static_cast<std::ptrdiff_t>(yi >> 8) * width + (xi >> 8);
        }

        int width{0}, height{0};
        float scale{1};  //!< 256 * 2^-level: texels of level 0 to 24.8 fixed point
        std::vector<std::uint64_t> texels;
    };
    /** A level and the weight of the next coarser one, of 256. */
    struct Blend
    {
        std::size_t level;
        std::uint64_t coarse;
    };
    /** Blends over the middle half of the way between two levels: elsewhere one is enough. */
    [[nodiscard]] Blend blendOf(float lod) const
    {
        const float clamped = std::min(std::max(lod, 0.0F), maxLod_);
        const int level = static_cast<int>(clamped);
        const float way = 2.0F * (clamped - static_cast<float>(level)) - 0.5F;
        const float coarse = std::min(std::max(way, 0.0F), 1.0F) * 256.0F;
        return {static_cast<std::size_t>(level), static_cast<std::uint64_t>(coarse)};
    }

    static constexpr std::uint64_t kLanes = 0x00ff00ff00ff00ffULL;
    static constexpr std::uint64_t kHalf = 0x0080008000800080ULL;

    [[nodiscard]] static std::uint64_t bilinear(const Level& level, float x, float y)
    {
        const int xi = level.fixedX(x), yi = level.fixedY(y);
        const auto fx = static_cast<std::uint64_t>(xi & 255);
        const auto fy = static_cast<std::uint64_t>(yi & 255);
        const std::uint64_t* p = level.at(xi, yi);
        const std::uint64_t w11 = (fx * fy) >> 8;
        const std::uint64_t sum = p[0] * (256 - fx - fy + w11) + p[1] * (fx - w11) +
                                  p[level.width] * (fy - w11) + p[level.width + 1] * w11;
        return ((sum + kHalf) >> 8) & kLanes;
    }

    static void prefetch(const Level& level, float x, float y)
    {
        const std::uint64_t* p = level.at(level.fixedX(x), level.fixedY(y));
        __builtin_prefetch(p);
        __builtin_prefetch(p + level.width);
    }

    double texel_{1};
    float maxLod_{0};
    std::vector<Level> levels_;
};
}  // namespace pointplane
