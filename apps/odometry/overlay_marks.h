// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/OdometryResult.h>

#include <opencv2/core/mat.hpp>

namespace pointplane
{
// Ends of the colour scale for the standard deviation of a plane's distance [m].
constexpr double kSmallSigma = 1e-4;
constexpr double kLargeSigma = 1e-1;

/** @name Colours of an overlay, BGR
 * @{ */
inline const cv::Scalar kUsed{80, 255, 80}, kDoubted{0, 200, 255}, kRejected{60, 60, 255};
inline const cv::Scalar kNew{255, 255, 255}, kMoving{255, 0, 255};
inline const cv::Scalar kText{255, 255, 255}, kArrow{0, 220, 255};
/** @} */

/** Pale to dark blue, level 0 to 255; CV_8UC3, one row. No mark is blue. */
[[nodiscard]] const cv::Mat& colourMap();

/** Of a standard deviation [m], on a logarithmic scale. */
[[nodiscard]] cv::Vec3b sigmaColour(double sigma);

/** The mark of a point, with a dark rim, in the picture or in its legend. */
void drawPoint(FeatureUse use, const cv::Point2d& at, cv::Mat& picture);
}  // namespace pointplane
