// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/PinholeCamera.h>

#include <opencv2/core/mat.hpp>

#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>

namespace pointplane
{
/** True for the encodings of depth: 16UC1, mono16 and 32FC1, and what
 * compressed_depth_image_transport writes. */
[[nodiscard]] bool isDepth(const sensor_msgs::Image& image);
[[nodiscard]] bool isDepth(const sensor_msgs::CompressedImage& image);

/** Pixels as OpenCV has them: CV_8UC3 BGR, CV_8UC1, CV_16UC1, or CV_32FC1 [m].
 * \throws BadFrame without a place: an encoding that is not known, or data that do not fit it */
[[nodiscard]] cv::Mat toMat(const sensor_msgs::Image& image);
[[nodiscard]] cv::Mat toMat(const sensor_msgs::CompressedImage& image);

/** Whether there is distortion of RealSense's kind, from distorted to undistorted pixels. */
[[nodiscard]] bool hasInverseDistortion(const sensor_msgs::CameraInfo& info);

/** \param isRectified the images are: without distortion, by the matrix P
 * \return without inverse distortion
 * \throws InputError for distortion other than plumb_bob's five parameters */
[[nodiscard]] PinholeCamera toCamera(const sensor_msgs::CameraInfo& info, bool isRectified);
}  // namespace pointplane
