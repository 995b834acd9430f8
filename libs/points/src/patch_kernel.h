// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

/** \file
 * Inner loops of the patch alignment on raw pointers. Columns are the lanes: every loop over x is
 * independent, so the compiler vectorises it without reordering a sum. */
namespace pointplane::patch_kernel
{
/** Correlations of a current patch I with a template T and its gradient. */
struct Sums
{
    float I, II, IT, Ix, Iy;
};

/** Weights of the four pixels around a position t in [0, 1) after the second one: cubic
 * convolution with a = -1/2 (Keys 1981). Bilinear weights would be faster, but their blur changes
 * with t, which moves the optimum by up to 0.05 px. */
struct CubicWeights
{
    float w[4];

    explicit CubicWeights(float t)
        : w{t * (-0.5F + t * (1 - 0.5F * t)),
            1 + t * t * (-2.5F + 1.5F * t),
            t * (0.5F + t * (2 - 1.5F * t)),
            t * t * (-0.5F + 0.5F * t)}
    {
    }

    /** Variance of the interpolated value over that of a pixel. */
    [[nodiscard]] float noiseGain() const
    {
        return w[0] * w[0] + w[1] * w[1] + w[2] * w[2] + w[3] * w[3];
    }
};

/** N x N samples minus `mean`. \param image top-left pixel of the (N+3) x (N+3) window
 * \param wx, wy weights at the common sub-pixel position */
template <int N>
inline void sample(
    const std::uint8_t* image,
    std::size_t stride,
    const CubicWeights& wx,
    const CubicWeights& wy,
    float mean,
    float* out)
{
    float rows[N + 3][N];
    for (int y = 0; y < N + 3; ++y, image += stride)
    {
        float pixels[N + 3];
        for (int x = 0; x < N + 3; ++x)
        {
            pixels[x] = static_cast<float>(image[x]) - mean;
        }
        for (int x = 0; x < N; ++x)
        {
            rows[y][x] = (wx.w[0] * pixels[x] + wx.w[1] * pixels[x + 1]) +
                         (wx.w[2] * pixels[x + 2] + wx.w[3] * pixels[x + 3]);
        }
    }
    for (int y = 0; y < N; ++y)
    {
        for (int x = 0; x < N; ++x)
        {
            out[y * N + x] = (wy.w[0] * rows[y][x] + wy.w[1] * rows[y + 1][x]) +
                             (wy.w[2] * rows[y + 2][x] + wy.w[3] * rows[y + 3][x]);
        }
    }
}

/** \param reference N*N each: template, x gradient, y gradient */
template <int N>
inline Sums correlate(const float* patch, const float* reference)
{
    const float* T = reference;
    const float* Tx = T + N * N;
    const float* Ty = Tx + N * N;
    float sI[4] = {}, sII[4] = {}, sIT[4] = {}, sIx[4] = {}, sIy[4] = {};
    for (int i = 0; i < N * N; i += 4)
    {
        for (int k = 0; k < 4; ++k)
        {
            const float v = patch[i + k];
            sI[k] += v;
            sII[k] += v * v;
            sIT[k] += v * T[i + k];
            sIx[k] += v * Tx[i + k];
            sIy[k] += v * Ty[i + k];
        }
    }
    const auto total = [](const float* s) { return (s[0] + s[1]) + (s[2] + s[3]); };
    return {total(sI), total(sII), total(sIT), total(sIx), total(sIy)};
}
}  // namespace pointplane::patch_kernel
