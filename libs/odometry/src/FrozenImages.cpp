// SPDX-License-Identifier: BSD-3-Clause
#include "FrozenImages.h"

#include <opencv2/core/mat.hpp>

#include <algorithm>
#include <cstddef>
#include <cstring>

namespace pointplane
{
namespace
{
/** FNV-1a (Fowler, Noll, Vo) of all bytes, eight at a time, in lanes that do not wait for each other.
 */
class Hash
{
 public:
    void add(const cv::Mat& image)
    {
        for (int v = 0; v < image.rows; ++v)
        {
            const auto* row = image.ptr<unsigned char>(v);
            const auto size = static_cast<std::size_t>(image.cols) * image.elemSize();
            for (std::size_t i = 0; i < size; i += kLanes * kWord)
            {
                std::uint64_t words[kLanes] = {};
                std::memcpy(words, row + i, std::min(sizeof words, size - i));
                for (std::size_t k = 0; k < kLanes; ++k)
                {
                    mix(lanes_[k], words[k]);
                }
            }
        }
    }

    [[nodiscard]] std::uint64_t value() const
    {
        std::uint64_t out = kStart;
        for (const std::uint64_t lane : lanes_)
        {
            mix(out, lane);
        }
        return out;
    }

 private:
    static constexpr std::size_t kLanes = 4, kWord = sizeof(std::uint64_t);
    static constexpr std::uint64_t kStart = 0xcbf29ce484222325U, kPrime = 0x100000001b3U;

    static void mix(std::uint64_t& hash, std::uint64_t word) { hash = (hash ^ word) * kPrime; }

    std::uint64_t lanes_[kLanes] = {kStart, kStart, kStart, kStart};
};
}  // namespace

bool FrozenImages::repeats(const RgbdFrame& frame)
{
    Hash hash;
    hash.add(frame.depth);
    hash.add(frame.gray);
    const bool out = previous_ == hash.value();
    previous_ = hash.value();
    return out;
}
}  // namespace pointplane
