// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
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

/** Numbers the frames of a stream that has no index of its own: a frame that comes n periods after
 * the last one has an index n higher, so that gaps show. */
class KinectFrameIndex
{
 public:
    [[nodiscard]] std::int64_t next(double time, int fps)
    {
        if (last_)
        {
            const auto periods = std::llround((time - *last_) * fps);
            index_ += periods > 1 ? periods : 1;
        }
        last_ = time;
        return index_;
    }

 private:
    std::optional<double> last_;
    std::int64_t index_{0};
};
}  // namespace pointplane
