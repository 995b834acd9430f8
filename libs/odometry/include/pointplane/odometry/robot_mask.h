// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/PinholeCamera.h>

#include <opencv2/core/mat.hpp>

namespace pointplane
{
/** What a mask of the robot leaves of an image. The robot is where the mask is darker than half of
 * its largest value, so masks may have 0 and 1, or JPEG's noise.
 * \param mask CV_8UC1 \return of the same size, 0 where the robot is, else 255
 * \throws std::invalid_argument if it is of another type or shape, or leaves everything or nothing
 */
[[nodiscard]] cv::Mat withoutRobot(const cv::Mat& mask);

/** A mask of the colour image, as the depth image shows it: that one has no lens distortion.
 * \param mask CV_8UC1, of the camera's size \return of the same size, 0 where the mask is 0; what
 * the colour image does not show is 255 */
[[nodiscard]] cv::Mat maskOfDepth(const cv::Mat& mask, const PinholeCamera& camera);
}  // namespace pointplane
