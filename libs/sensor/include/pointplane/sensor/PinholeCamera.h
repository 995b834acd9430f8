// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

#include <Eigen/Core>

#include <array>
#include <string>

namespace pointplane
{
/** Pinhole camera with the five-parameter Brown distortion of OpenCV and MRPT.
 *
 * Pixel (0, 0) is the centre of the top-left pixel. Optical axes: x right, y down, z forward. A
 * negative fy is legal (image y axis up, as in ICL-NUIM). The colour image and the depth image that
 * is registered to it share fx, fy, cx, cy. Lens distortion is in the colour image alone: the depth
 * image is an ideal pinhole's, as a Kinect's registration makes it (measured on TUM fr1).
 */
struct PinholeCamera
{
    int width{640}, height{480};                        //!< [px]
    double fx{525}, fy{525}, cx{319.5}, cy{239.5};      //!< [px]
    std::array<double, 5> distortion{{0, 0, 0, 0, 0}};  //!< k1 k2 p1 p2 k3

    /** Nobody calibrated this camera: its intrinsics are those of its model, or a guess. */
    bool isNominal{false};

    /** What cameras of one model differ by (standard deviation): the focal length, relative, and
     * the principal point over the width of the image. */
    static constexpr double kNominal = 0.02;

    /** \return what is wrong (NaN, zero focal length, empty image...); empty if the camera is
     * usable */
    [[nodiscard]] std::string problem() const;

    [[nodiscard]] bool isDistorted() const;

    /** Undistorted normalised coordinates (x, y) of the ray (x, y, 1) through a raw pixel. NaN if
     * no ray reaches it: far outside of the calibrated area, the polynomial may fold over. \param J
     * if given: 2x2 Jacobian of (x, y) with respect to the raw pixel [1/px] */
    [[nodiscard]] Eigen::Vector2d normalised(
        const Eigen::Vector2d& uv_px, Eigen::Matrix2d* J = nullptr) const;

    /** Pixel of the depth image that sees the same ray as a raw colour pixel. */
    [[nodiscard]] Eigen::Vector2d depthPixel(const Eigen::Vector2d& uv_px) const;

    /** Normalised coordinates (x, y) of the ray through a pixel of the depth image. */
    [[nodiscard]] Eigen::Vector2d normalisedOfDepth(const Eigen::Vector2d& depthUv_px) const;

    /** Raw (distorted) pixel of a point in front of the camera [m]; NaN where the distortion turns
     * the image round, beyond what the camera sees. */
    [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& p_cam) const;

    /** The same camera after the image has been resized by `factor` (pixel centres kept right). */
    [[nodiscard]] PinholeCamera scaled(double factor) const;
};
}  // namespace pointplane
