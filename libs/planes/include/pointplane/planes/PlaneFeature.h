// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Plane.h>

#include <opencv2/core/mat.hpp>

#include <vector>

namespace pointplane
{
/** A plane seen in one frame. */
struct PlaneFeature
{
    PlaneGaussian plane_cam;  //!< camera frame, optical axes
    int numPixels{0};         //!< inliers that the fit used [px]
    /** How an error of the inverse depth that grows linearly with the line enters theta_m, as with
     * a rolling shutter: A^-1 sum_i f_i r_i r_i^T with A = sum_i r_i r_i^T over the pixels' rays r
     * and f = readoutFraction(). */
    Eigen::Matrix3d readoutLever{Eigen::Matrix3d::Zero()};
};

/** All planes of a frame and which pixels they cover. */
struct PlaneSet
{
    std::vector<PlaneFeature> planes;
    cv::Mat labels;  //!< CV_8UC1, image size: 0 = no plane, i + 1 = planes[i]
};
}  // namespace pointplane
