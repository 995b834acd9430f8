// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/DepthNoise.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <Eigen/Geometry>
#include <opencv2/core/types.hpp>

#include <vector>

namespace pointplane
{
/** Parts of an image that show a surface where an earlier frame saw none: it has moved there.
 *
 * An earlier frame that looked through a place tells that it was empty. What a thing that has moved
 * uncovers is not marked, nor one that has not moved far enough to leave its own outline. */
struct MovingRegions
{
    std::vector<cv::Rect> cells;  //!< of a thin grid over the image [px]
    int numCompared{0};           //!< cells of which an earlier frame can tell

    /** Of the cells that were compared, 0 to 1. */
    [[nodiscard]] double share() const
    {
        return numCompared > 0 ? static_cast<double>(cells.size()) / numCompared : 0;
    }

    /** More of a view than holes of the depth image and thin things make. */
    static constexpr double kSureShare = 0.1;

    /** Whether something surely moves. */
    [[nodiscard]] bool areSure() const { return share() > kSureShare; }
};

/** An earlier frame, and from where it saw the current one's surfaces. */
struct EarlierView
{
    const RgbdFrame* frame{nullptr};
    /** From the camera when the current depth image was exposed to the camera when the earlier one
     * was. */
    Eigen::Isometry3d T_earlier_cur{Eigen::Isometry3d::Identity()};
    /** What depths may differ by beside the sensor's noise and distortion: [m], and a part of the
     * depth. */
    double slack_m{0}, slackShare{0};
};

/** Cells of the current depth image that one of the earlier frames saw through. */
[[nodiscard]] MovingRegions findMovingRegions(
    const RgbdFrame& current, const std::vector<EarlierView>& earlier, const DepthNoise& noise);
}  // namespace pointplane
