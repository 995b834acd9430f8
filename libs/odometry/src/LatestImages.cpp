// SPDX-License-Identifier: BSD-3-Clause
#include "LatestImages.h"

#include <cstddef>
#include <cstring>
#include <limits>

namespace pointplane
{
namespace
{
/** Of images with noise, the first row differs. */
bool isSame(const cv::Mat& a, const cv::Mat& b)
{
    if (a.size() != b.size() || a.type() != b.type())
    {
        return false;
    }
    const auto bytes = static_cast<std::size_t>(a.cols) * a.elemSize();
    for (int v = 0; v < a.rows; ++v)
    {
        if (std::memcmp(a.ptr(v), b.ptr(v), bytes) != 0)
        {
            return false;
        }
    }
    return true;
}

/** Leaves the memory so far to those who share it. \return whether the image is new; it becomes a
 * copy */
bool renewCopy(cv::Mat& image, cv::Mat& latest)
{
    const bool isNew = !isSame(latest, image);
    if (isNew)
    {
        if (latest.u != nullptr && latest.u->refcount > 1)
        {
            latest.release();
        }
        image.copyTo(latest);
    }
    image = latest;
    return isNew;
}

void keepReadings(const cv::Mat& depth, float least, float most, cv::Mat& out)
{
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    out.create(depth.size(), depth.type());
    for (int v = 0; v < depth.rows; ++v)
    {
        const auto* in = depth.ptr<float>(v);
        auto* row = out.ptr<float>(v);
        for (int u = 0; u < depth.cols; ++u)
        {
            row[u] = in[u] >= least && in[u] <= most ? in[u] : kNone;  // NaN is outside
        }
    }
}
}  // namespace

LatestImages::LatestImages(double minDepth, double maxDepth)
    : minDepth_(static_cast<float>(minDepth)), maxDepth_(static_cast<float>(maxDepth))
{
}

LatestImages::Novelty LatestImages::renew(RgbdFrame& frame)
{
    keepReadings(frame.depth, minDepth_, maxDepth_, readings_);
    frame.depth = readings_;
    Novelty out;
    out.depth = renewCopy(frame.depth, depth_);
    out.gray = frame.gray.empty() || renewCopy(frame.gray, gray_);
    return out;
}
}  // namespace pointplane
