// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/PinholeCamera.h>
#include <pointplane/simulation/Scene.h>

#include <opencv2/core/mat.hpp>

#include <vector>

namespace pointplane
{
/** When a row of a picture was taken, and from where. */
struct RowPose
{
    Eigen::Isometry3d T_world_cam{Eigen::Isometry3d::Identity()};
    double t{0};  //!< [s] since the beginning: where the movers are
};

/** The poses of a picture's rows, top row first. */
using RowPoses = std::vector<RowPose>;

/** What the rays of a picture hit. */
struct CastImage
{
    cv::Mat inverseDepth;  //!< CV_32FC1 [1/m], 0 = nothing
    cv::Mat ids;           //!< CV_32SC1, index of the surface, -1 = nothing
};

/** Casts the rays of a picture. \param poses one per row of the camera
 * \throws std::invalid_argument if the camera is distorted or the number of poses is wrong */
[[nodiscard]] CastImage castImage(
    const Scene& scene, const PinholeCamera& camera, const RowPoses& poses);

/** Colours of a cast picture, CV_8UC3.
 * \param antialias pixels at the edges of surfaces are averages over four samples */
[[nodiscard]] cv::Mat shadeImage(
    const Scene& scene,
    const PinholeCamera& camera,
    const RowPoses& poses,
    const CastImage& cast,
    bool antialias);
}  // namespace pointplane
