// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/odometry/robot_mask.h>

#include <opencv2/core.hpp>

#include <cmath>

namespace pointplane
{
cv::Mat withoutRobot(const cv::Mat& mask)
{
    POINTPLANE_CHECK(
        mask.type() == CV_8UC1 && mask.dims == 2 && !mask.empty(),
        "a mask has one byte for a pixel, in rows and columns");
    double least = 0, most = 0;
    cv::minMaxLoc(mask, &least, &most);
    const double middle = std::ceil(0.5 * most);
    POINTPLANE_CHECK(
        least < middle,
        "the mask is " << (most > 0 ? "white" : "black")
                       << " everywhere; it must be black where the camera sees the robot itself, "
                          "and white elsewhere");
    return mask >= middle;
}
}  // namespace pointplane
