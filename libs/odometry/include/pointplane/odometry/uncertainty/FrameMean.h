// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace pointplane
{
/** Running mean of a value per frame: at first the plain mean of all frames, later exponentially
 * weighted. */
template <class T = double>
class FrameMean
{
 public:
    /** \param first value before the first frame \param counts as if so many frames had had it */
    explicit FrameMean(const T& first = {}, double counts = 0) : value_(first), numFrames_(counts)
    {
    }

    /** \param rate share of this frame in the mean, at least */
    void follow(const T& value, double rate)
    {
        ++numFrames_;
        value_ += std::max(rate, 1 / numFrames_) * (value - value_);
    }

    [[nodiscard]] const T& value() const { return value_; }
    [[nodiscard]] double numFrames() const { return numFrames_; }

 private:
    T value_;
    double numFrames_;
};
}  // namespace pointplane
