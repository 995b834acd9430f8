// SPDX-License-Identifier: BSD-3-Clause
#include "LatestImages.h"

#include <cstddef>
#include <cstring>

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

/** Leaves the memory so far to those who share it. */
void copy(const cv::Mat& from, cv::Mat& to)
{
    if (to.u != nullptr && to.u->refcount > 1)
    {
        to.release();
    }
    from.copyTo(to);
}
}  // namespace

bool LatestImages::renew(RgbdFrame& frame)
{
    const bool isNew = !isSame(depth_, frame.depth) || !isSame(gray_, frame.gray);
    if (isNew)
    {
        copy(frame.depth, depth_);
        copy(frame.gray, gray_);
    }
    frame.depth = depth_;
    frame.gray = gray_;
    return isNew;
}
}  // namespace pointplane
