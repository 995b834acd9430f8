// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/sensor/PinholeCamera.h>

#include <opencv2/core/mat.hpp>

#include <vector>

namespace pointplane
{
/** The pixels of one plane's segment that have depth. */
struct SegmentPixels
{
    std::vector<Eigen::Vector3d> points;  //!< camera frame [m]
    std::vector<cv::Point> pixels;        //!< where each of them is
};

/** \param labels CV_8UC1, i + 1 = segment i \param depth CV_32FC1 [m] \return one per segment */
[[nodiscard]] std::vector<SegmentPixels> pixelsOfSegments(
    const cv::Mat& labels, const cv::Mat& depth, const PinholeCamera& camera, size_t numSegments);
}  // namespace pointplane
