// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/sensor/PinholeCamera.h>

#include <opencv2/core/mat.hpp>

#include <vector>

namespace pointplane
{
/** Renders the depth image of one camera into another that is rigidly attached to it.
 *
 * Each reading covers its footprint in the target, so that no holes appear when the target's pixels
 * are finer; the nearest surface wins. Inside a footprint the inverse depth follows its gradient in
 * the source (it is linear in the pixel on a plane), which avoids steps on slanted surfaces. */
class DepthRegistration
{
 public:
    /** \param source its depth lies at raw (distorted) pixels
     * \param target depth is rendered at its ideal (undistorted) pixels
     * \param T_target_source optical frames */
    DepthRegistration(
        const PinholeCamera& source,
        const PinholeCamera& target,
        const Eigen::Isometry3d& T_target_source);

    /** \param depth CV_32FC1, size of the source [m], NaN = none
     * \return CV_32FC1, size of the target [m], NaN = none */
    [[nodiscard]] cv::Mat render(const cv::Mat& depth) const;

 private:
    /** From one source pixel to the next column and to the next row, in the target [px], for a
     * surface as far from both. */
    [[nodiscard]] Eigen::Matrix2d pixelSteps(int u, int v) const;
    void splat(const cv::Mat& depth, int u, int v, cv::Mat& out) const;

    PinholeCamera source_;
    PinholeCamera target_;
    Eigen::Vector3d translation_;  // of the source in the target [m]
    std::vector<Eigen::Vector3f>
        rays_;  // of each source pixel, turned into the target; z = 1 before
};
}  // namespace pointplane
