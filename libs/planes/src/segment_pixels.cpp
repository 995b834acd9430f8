// SPDX-License-Identifier: BSD-3-Clause
#include "segment_pixels.h"

namespace pointplane
{
std::vector<SegmentPixels> pixelsOfSegments(
    const cv::Mat& labels, const cv::Mat& depth, const PinholeCamera& camera, size_t numSegments)
{
    std::vector<SegmentPixels> out(numSegments);
    for (int v = 0; v < labels.rows; ++v)
    {
        const auto* label = labels.ptr<uchar>(v);
        const auto* row = depth.ptr<float>(v);
        for (int u = 0; u < labels.cols; ++u)
        {
            const double z = static_cast<double>(row[u]);
            if (label[u] > 0 && z > 0)  // false for NaN
            {
                SegmentPixels& segment = out[static_cast<size_t>(label[u] - 1)];
                segment.points.emplace_back(
                    z * (u - camera.cx) / camera.fx, z * (v - camera.cy) / camera.fy, z);
                segment.pixels.emplace_back(u, v);
            }
        }
    }
    return out;
}
}  // namespace pointplane
