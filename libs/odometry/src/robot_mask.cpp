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

cv::Mat maskOfDepth(const cv::Mat& mask, const PinholeCamera& camera)
{
    if (!camera.isDistorted())
    {
        return mask;
    }
    cv::Mat out(mask.size(), CV_8UC1, cv::Scalar(255));
    const cv::Rect inside({}, mask.size());
    for (int v = 0; v < out.rows; ++v)
    {
        for (int u = 0; u < out.cols; ++u)
        {
            const Eigen::Vector2d seen =
                camera.project(camera.normalisedOfDepth({u, v}).homogeneous());
            const cv::Point pixel = seen.allFinite()
                                        ? cv::Point(cvRound(seen.x()), cvRound(seen.y()))
                                        : cv::Point(-1, -1);
            out.at<uchar>(v, u) = inside.contains(pixel) ? mask.at<uchar>(pixel) : 255;
        }
    }
    return out;
}
}  // namespace pointplane
