// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/sensor/RgbdFrame.h>

namespace pointplane
{
bool hasDepth(const RgbdFrame& frame)
{
    const double needed = kLeastDepthShare * static_cast<double>(frame.depth.total());
    int numReadings = 0;
    for (int v = 0; v < frame.depth.rows && numReadings < needed; ++v)
    {
        const auto* row = frame.depth.ptr<float>(v);
        for (int u = 0; u < frame.depth.cols; ++u)
        {
            numReadings += row[u] > 0 ? 1 : 0;  // false for NaN
        }
    }
    return numReadings > 0 && numReadings >= needed;
}
}  // namespace pointplane
