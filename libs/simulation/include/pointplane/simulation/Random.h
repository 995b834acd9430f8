// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <initializer_list>

namespace pointplane
{
/** Random numbers that are the same on every platform, unlike those of the standard distributions.
 * A counter runs through the finaliser of SplitMix64 (Steele, Lea & Flood 2014). Streams of any two
 * keys are independent, so any frame or row can be made without those before it. */
class Random
{
 public:
    /** \param keys e.g. {seed, frame, purpose, row} */
    explicit Random(std::initializer_list<std::uint64_t> keys)
    {
        for (const std::uint64_t key : keys)
        {
            state_ = mix(state_ + kGolden + key);
        }
    }

    [[nodiscard]] std::uint64_t bits()
    {
        state_ += kGolden;
        return mix(state_);
    }

    /** Uniform in [0, 1). */
    [[nodiscard]] double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
    [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }

    /** Uniform in 0 .. n-1, n > 0. */
    [[nodiscard]] int below(int n) { return static_cast<int>(uniform() * n); }

    /** Normal variable: the sum of the eight bytes of one word (kurtosis 2.85, at most 4.9 sigma).
     */
    [[nodiscard]] float gaussian()
    {
        return static_cast<float>(byteSum(bits()) - 1020) * kByteScale;
    }

    /** Two normal variables of a coarser kind (four bytes each, kurtosis 2.7), for image noise. */
    void gaussianPair(float& a, float& b)
    {
        const std::uint64_t x = bits();
        const std::uint64_t pairs = (x & kEvenBytes) + ((x >> 8) & kEvenBytes);
        const std::uint64_t sums = (pairs + (pairs >> 16)) & 0x0000ffff0000ffffULL;
        a = static_cast<float>(static_cast<int>(sums & 0xffff) - 510) * kHalfScale;
        b = static_cast<float>(static_cast<int>(sums >> 32) - 510) * kHalfScale;
    }

 private:
    static constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
    static constexpr std::uint64_t kEvenBytes = 0x00ff00ff00ff00ffULL;
    // A byte has variance (256^2 - 1) / 12.
    static constexpr float kByteScale = 1.0F / 209.02153F;
    static constexpr float kHalfScale = 1.0F / 147.80054F;

    [[nodiscard]] static std::uint64_t mix(std::uint64_t x)
    {
        x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
        x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
        return x ^ (x >> 31);
    }
    [[nodiscard]] static int byteSum(std::uint64_t x)
    {
        const std::uint64_t pairs = (x & kEvenBytes) + ((x >> 8) & kEvenBytes);
        return static_cast<int>((pairs * 0x0001000100010001ULL) >> 48);
    }

    std::uint64_t state_{0};
};
}  // namespace pointplane
