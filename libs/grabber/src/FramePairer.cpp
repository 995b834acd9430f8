// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/grabber/FramePairer.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
// A stream that waits longer than this many images has lost its partner: do not hoard its pixels.
constexpr std::size_t kMaxWaiting = 8;

/** Images that a stream lost between these two. */
std::int64_t numMissing(const CameraImage& last, const CameraImage& image, double period)
{
    constexpr double kLongestGap = 10.0;  // [s]; after more, the clock was set
    // An index that goes back is a stream that started again, not a loss. Drivers may number only
    // what they deliver: then the stamps tell.
    const std::int64_t byIndex = image.index - last.index - 1;
    const double step = image.deviceTime - last.deviceTime;
    const bool isTold = image.hasClock && std::abs(step) < kLongestGap;
    const std::int64_t byStamp = isTold ? std::llround(step / period) - 1 : 0;
    return std::max<std::int64_t>({byIndex, byStamp, 0});
}
}  // namespace

FramePairer::FramePairer(double maxSkew, double period, bool depthOnly)
    : maxSkew_(maxSkew), period_(period), depthOnly_(depthOnly)
{
    POINTPLANE_CHECK(maxSkew > 0.0, "maxSkew is " << maxSkew << " s, must be positive");
    POINTPLANE_CHECK(period > 0.0, "period is " << period << " s, must be positive");
}

void FramePairer::countGap(const CameraImage& image)
{
    const bool isDepth = image.stream == StreamKind::Depth;
    auto& last = isDepth ? lastDepth_ : lastColour_;
    auto& dropped = isDepth ? counts_.droppedDepth : counts_.droppedColour;
    dropped += last ? static_cast<std::uint64_t>(numMissing(*last, image, period_)) : 0;
    last = image;
    last->pixels.release();
}

void FramePairer::dropOldest(StreamKind stream)
{
    if (stream == StreamKind::Depth)
    {
        depth_.pop_front();
        ++counts_.unpairedDepth;
    }
    else
    {
        colour_.pop_front();
        ++counts_.unpairedColour;
    }
}

ImagePair FramePairer::takePair()
{
    ImagePair pair;
    pair.depth = std::move(depth_.front());
    depth_.pop_front();
    if (!depthOnly_)
    {
        pair.colour = std::move(colour_.front());
        colour_.pop_front();
        const double skew = pair.colour.deviceTime - pair.depth.deviceTime;
        sumSkew_ += skew;
        counts_.maxAbsSkew = std::max(counts_.maxAbsSkew, std::abs(skew));
    }
    ++counts_.pairs;
    counts_.meanSkew = sumSkew_ / static_cast<double>(counts_.pairs);
    return pair;
}

std::vector<ImagePair> FramePairer::add(const CameraImage& image)
{
    countGap(image);
    auto& waiting = image.stream == StreamKind::Depth ? depth_ : colour_;
    waiting.push_back(image);

    std::vector<ImagePair> pairs;
    if (depthOnly_ && !depth_.empty())
    {
        pairs.push_back(takePair());
        return pairs;
    }
    while (!depth_.empty() && !colour_.empty())
    {
        const double skew = colour_.front().deviceTime - depth_.front().deviceTime;
        if (std::abs(skew) <= maxSkew_)
        {
            pairs.push_back(takePair());
        }
        else
        {
            // The later one may still meet its partner; the earlier one cannot.
            dropOldest(skew > 0.0 ? StreamKind::Depth : StreamKind::Colour);
        }
    }
    if (waiting.size() > kMaxWaiting)
    {
        dropOldest(image.stream);
    }
    return pairs;
}

void FramePairer::finish()
{
    while (!depth_.empty())
    {
        dropOldest(StreamKind::Depth);
    }
    while (!colour_.empty())
    {
        dropOldest(StreamKind::Colour);
    }
}
}  // namespace pointplane
