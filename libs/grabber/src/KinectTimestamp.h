// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

namespace pointplane
{
/** Seconds from the Kinect's 60 MHz counter, whose 32 bits overflow every 71.6 s. Both streams use
 * one counter and arrive slightly out of order, so differences are taken as signed. */
class KinectTimestamp
{
 public:
    static constexpr double kTick = 1.0 / 60e6;  //!< [s]

    /** [s] since an arbitrary zero; stamps may be up to 35 s before or after the previous one. */
    [[nodiscard]] double seconds(std::uint32_t ticks)
    {
        if (!last_)
        {
            last_ = ticks;
            unwrapped_ = ticks;
        }
        unwrapped_ += static_cast<std::int32_t>(ticks - *last_);
        last_ = ticks;
        return static_cast<double>(unwrapped_) * kTick;
    }

 private:
    std::optional<std::uint32_t> last_;
    std::int64_t unwrapped_{0};
};
}  // namespace pointplane
