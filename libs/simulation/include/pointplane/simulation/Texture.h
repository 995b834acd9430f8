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
        const float clamped = std::min(std::max(lod, 0.0F), maxLod_);
        const int level = static_cast<int>(clamped);
        const auto blend =
            static_cast<std::uint64_t>((clamped - static_cast<float>(level)) * 256.0F);
        const std::uint64_t fine = bilinear(levels_[static_cast<std::size_t>(level)], x, y);
        if (blend == 0)
        {
            return fine;
        }
        const std::uint64_t coarse = bilinear(levels_[static_cast<std::size_t>(level) + 1], x, y);
        return ((fine * (256 - blend) + coarse * blend + kHalf) >> 8) & kLanes;
    }

 private:
    struct Level
    {
        int width{0}, height{0};
        float scale{1};  //!< 256 * 2^-level: texels of level 0 to 24.8 fixed point
        std::vector<std::uint64_t> texels;
    };
    static constexpr std::uint64_t kLanes = 0x00ff00ff00ff00ffULL;
    static constexpr std::uint64_t kHalf = 0x0080008000800080ULL;

    [[nodiscard]] static std::uint64_t bilinear(const Level& level, float x, float y)
    {
        const int xi = std::clamp(
            static_cast<int>((x + 0.5F) * level.scale) - 128, 0, (level.width - 1) * 256 - 1);
        const int yi = std::clamp(
            static_cast<int>((y + 0.5F) * level.scale) - 128, 0, (level.height - 1) * 256 - 1);
        const auto fx = static_cast<std::uint64_t>(xi & 255);
        const auto fy = static_cast<std::uint64_t>(yi & 255);
        const std::uint64_t* p =
            level.texels.data() + static_cast<std::ptrdiff_t>(yi >> 8) * level.width + (xi >> 8);
        const std::uint64_t w11 = (fx * fy) >> 8;
        const std::uint64_t sum = p[0] * (256 - fx - fy + w11) + p[1] * (fx - w11) +
                                  p[level.width] * (fy - w11) + p[level.width + 1] * w11;
        return ((sum + kHalf) >> 8) & kLanes;
    }

    double texel_{1};
    float maxLod_{0};
    std::vector<Level> levels_;
};
}  // namespace pointplane
