// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/points/PointDetector.h>
#include <pointplane/points/PointFeature.h>
#include <pointplane/points/PointLifter.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <opencv2/core/mat.hpp>

#include <vector>

namespace pointplane
{
/** Key points of a frame that have depth, and what they look like. */
struct DescribedPoints
{
    std::vector<PointFeature> points;
    cv::Mat descriptors;  //!< a row a point
};

[[nodiscard]] DescribedPoints describe(
    const RgbdFrame& frame, const PointDetector& detector, const PointLifter& lifter);
}  // namespace pointplane
