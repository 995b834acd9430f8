// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/sensor/DepthNoise.h>

namespace pointplane
{
void DepthNoise::check() const
{
    POINTPLANE_CHECK(
        sigmaInverseDepth > 0 && sigmaInverseDepth < 1,
        "sigmaInverseDepth = " << sigmaInverseDepth << " is not in (0, 1) 1/m");
    POINTPLANE_CHECK(
        sigmaPixelPx > 0 && sigmaPixelPx < 100,
        "sigmaPixelPx = " << sigmaPixelPx << " is not in (0, 100) px");
}

PointGaussian backProject(
    const PinholeCamera& camera, const DepthNoise& noise, const Eigen::Vector2d& uv_px, double z)
{
    return backProject(camera, noise.sigmaPixelPx, noise.sigmaZ(z), uv_px, z);
}

PointGaussian backProject(
    const PinholeCamera& camera,
    double sigmaPixelPx,
    double sigmaZ,
    const Eigen::Vector2d& uv_px,
    double z)
{
    Eigen::Matrix2d xyOverPixel;
    const Eigen::Vector2d xy = camera.normalised(uv_px, &xyOverPixel);
    const Eigen::Vector3d ray(xy.x(), xy.y(), 1);
    const Eigen::Matrix2d lateral = z * sigmaPixelPx * xyOverPixel;
    PointGaussian out;
    out.mean = z * ray;                                 // [P17 Eq. 1]
    out.cov = sigmaZ * sigmaZ * ray * ray.transpose();  // [P17 Eq. 2]
    out.cov.topLeftCorner<2, 2>() += lateral * lateral.transpose();
    return out;
}
}  // namespace pointplane
