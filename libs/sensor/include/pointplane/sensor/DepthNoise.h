// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PointGaussian.h>
#include <pointplane/sensor/PinholeCamera.h>

namespace pointplane
{
/** Noise of a structured-light depth camera: constant in inverse depth.
 *
 * Khoshelham & Elberink 2012, quoted by [P17, after Eq. 2]: sigma_Z = 1.425e-6 Z^2 in mm, that is
 * sigma_Z = 1.425e-3 Z^2 in metres, hence sigma of 1/Z is 1.425e-3 per metre at every depth. */
struct DepthNoise
{
    double sigmaInverseDepth{1.425e-3};  //!< [1/m]
    double sigmaPixelPx{0.5};            //!< [px], key point localisation [P17, after Eq. 2]

    /** Standard deviation of a depth reading. \param z [m] \return [m] */
    [[nodiscard]] double sigmaZ(double z) const { return sigmaInverseDepth * z * z; }

    template <class V>
    void visit(V&& v)
    {
        v("sigmaInverseDepth",
          sigmaInverseDepth,
          "1/m",
          "noise of the inverse depth; Khoshelham's sigma_Z = this * Z^2");
        v("sigmaPixelPx", sigmaPixelPx, "px", "noise of a key point's position");
    }
    void check() const;
};

/** Point at depth z behind a raw pixel, P = z (x, y, 1) [P17 Eq. 1], with its first-order
 * covariance J diag(sigma_p^2, sigma_p^2, sigma_Z^2) J^T [P17 Eq. 2]. Frame: camera, optical axes.
 * \param uv_px raw pixel \param z [m], > 0 */
[[nodiscard]] PointGaussian backProject(
    const PinholeCamera& camera, const DepthNoise& noise, const Eigen::Vector2d& uv_px, double z);

/** The same for a depth whose standard deviation is known otherwise. \param sigmaZ [m] */
[[nodiscard]] PointGaussian backProject(
    const PinholeCamera& camera,
    double sigmaPixelPx,
    double sigmaZ,
    const Eigen::Vector2d& uv_px,
    double z);
}  // namespace pointplane
