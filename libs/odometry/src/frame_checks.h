// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/points/PointLifter.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <string>

namespace pointplane
{
/** Nothing that pixels are turned into rays with differs. */
[[nodiscard]] bool sameCamera(const PinholeCamera& a, const PinholeCamera& b);

/** Whether a frame's stamp is a number of seconds: finite, and not too large for them. */
[[nodiscard]] bool isTime(double stamp);

/** Why a frame cannot be used, or empty. \param maskSize empty: there is no mask */
[[nodiscard]] std::string problemOf(const RgbdFrame& frame, const cv::Size& maskSize);

/** Why hasDepth() is false of a frame's depth once readings that are out of range are left out, or
 * empty. */
[[nodiscard]] std::string whyNoDepth(const cv::Mat& depth, const PointLifter::TParams& range);

/** That no point is found in an image, with its brightness and contrast. */
[[nodiscard]] std::string whyNoPoint(const cv::Mat& gray);
}  // namespace pointplane
