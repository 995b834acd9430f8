// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <optional>

#include "FrameRecord.h"

namespace pointplane
{
/** How the camera moves in a frame, optical axes. */
struct CameraSpeed
{
    Eigen::Vector3d translation{0, 0, 0};  //!< [m/s]
    double rotation{0};                    //!< [rad/s]
};

/** A picture of what was found in a frame, as [P17, Fig. 4], with a legend below it. Points that
 * the pose follows are green circles, rejected ones red crosses, new ones white dots. Planes have
 * the colour of the standard deviation of their distance (pale small, dark large); those that the
 * pose does not follow are outlined only. An arrow shows where the camera moves, a thin one
 * if the motion is measured in part.
 * Where there is no gray image, it is on the depth. \param item of a frame \param seconds since the
 * first frame; NaN if its stamp tells nothing
 * \param size of the picture, if there are no images
 * \return CV_8UC3, BGR, as wide as the image */
[[nodiscard]] cv::Mat drawOverlay(
    const OutputItem& item, double seconds, const std::optional<CameraSpeed>& speed, cv::Size size);
}  // namespace pointplane
