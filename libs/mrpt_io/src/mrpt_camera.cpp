// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/mrpt_camera.h>

#include <algorithm>

namespace pointplane
{
PinholeCamera fromMrpt(const mrpt::img::TCamera& from)
{
    constexpr unsigned kLargest = 1U << 20U;  // of damaged files
    PinholeCamera out;
    out.width = static_cast<int>(std::min(from.ncols, kLargest));
    out.height = static_cast<int>(std::min(from.nrows, kLargest));
    out.fx = from.fx();
    out.fy = from.fy();
    out.cx = from.cx();
    out.cy = from.cy();
    if (from.distortion == mrpt::img::DistortionModel::plumb_bob)
    {
        std::copy_n(from.dist.begin(), out.distortion.size(), out.distortion.begin());
    }
    return out;
}
}  // namespace pointplane
