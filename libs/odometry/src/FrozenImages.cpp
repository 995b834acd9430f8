// SPDX-License-Identifier: BSD-3-Clause
#include "FrozenImages.h"

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
}  // namespace

bool FrozenImages::repeats(const RgbdFrame& frame)
{
    if (isSame(depth_, frame.depth) && isSame(gray_, frame.gray))
    {
        return true;
    }
    frame.depth.copyTo(depth_);
    frame.gray.copyTo(gray_);
    return false;
}
}  // namespace pointplane
