// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "lucas_kanade.h"
#include "warped_patches.h"

namespace pointplane
{
/** What the points of a reference look like: searched for over the pyramid, then placed exactly. */
struct ReferencePatches
{
    PatchTemplates searched;
    WarpedPatches refined;

    ReferencePatches(int windowPx, std::size_t numPoints, std::size_t numLevels)
        : searched(windowPx)
    {
        searched.reserve(numPoints, numLevels);
        refined.reserve(numPoints, windowPx / 2);
    }

    /** \param pyramid with derivatives \param patch by which the point is placed, at most as large
     * as the search's window \param brightness constant for edges, along which it may be all that
     * tells anything \param measured see WarpedPatches */
    void add(
        const std::vector<cv::Mat>& pyramid,
        const Patch& patch,
        Brightness brightness,
        const Directions& measured)
    {
        searched.add(pyramid, patch.centre(), brightness);
        refined.add(patch, brightness, measured);
    }
};

/** Far enough from the image's border for a patch to be compared there. */
[[nodiscard]] inline bool isWellInside(const cv::Point2f& p, const cv::Mat& image)
{
    constexpr int kBorderPx = 8;
    return p.x >= kBorderPx && p.y >= kBorderPx &&
           p.x <= static_cast<float>(image.cols - 1 - kBorderPx) &&
           p.y <= static_cast<float>(image.rows - 1 - kBorderPx);
}
}  // namespace pointplane
