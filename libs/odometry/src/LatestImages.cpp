// SPDX-License-Identifier: BSD-3-Clause
#include "LatestImages.h"

#include <pointplane/odometry/robot_mask.h>

#include <cstddef>
#include <cstring>
#include <limits>
#include <utility>

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

/** Leaves the memory to those who share it. */
void makeOwn(cv::Mat& image)
{
    if (image.u != nullptr && image.u->refcount > 1)
    {
        image.release();
    }
}

void keepReadings(const cv::Mat& depth, float least, float most, cv::Mat& out)
{
    out.create(depth.size(), depth.type());
    for (int v = 0; v < depth.rows; ++v)
    {
        const auto* in = depth.ptr<float>(v);
        auto* row = out.ptr<float>(v);
        for (int u = 0; u < depth.cols; ++u)
        {
            const bool isReading = in[u] >= least && in[u] <= most;  // NaN is not
            row[u] = isReading ? in[u] : std::numeric_limits<float>::quiet_NaN();
        }
    }
}
}  // namespace

LatestImages::LatestImages(double minDepth, double maxDepth)
    : minDepth_(static_cast<float>(minDepth)), maxDepth_(static_cast<float>(maxDepth))
{
}

void LatestImages::setMask(const cv::Mat& mask)
{
    leftOut_ = mask.empty() ? cv::Mat() : cv::Mat(withoutRobot(mask) == 0);
}

cv::Mat LatestImages::mask() const { return leftOut_.empty() ? cv::Mat() : cv::Mat(leftOut_ == 0); }

LatestImages::Novelty LatestImages::renew(RgbdFrame& frame)
{
    Novelty out;
    makeOwn(readings_);
    keepReadings(frame.depth, minDepth_, maxDepth_, readings_);
    if (!leftOut_.empty())
    {
        readings_.setTo(std::numeric_limits<float>::quiet_NaN(), leftOut_);
    }
    out.depth = !isSame(depth_, readings_);
    if (out.depth)
    {
        std::swap(depth_, readings_);
    }
    frame.depth = depth_;
    out.gray = frame.gray.empty() || !isSame(gray_, frame.gray);
    if (out.gray)
    {
        makeOwn(gray_);
        frame.gray.copyTo(gray_);
    }
    frame.gray = gray_;
    return out;
}
}  // namespace pointplane
