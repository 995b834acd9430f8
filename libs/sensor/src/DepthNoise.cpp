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
    const Eigen::Vector2d xy = camera.normalised(uv_px);
    const Eigen::Vector3d ray(xy.x(), xy.y(), 1);
    const double sigmaZ = noise.sigmaZ(z);
    // Columns of J: dP/du, dP/dv, dP/dZ. The distortion's own derivative is within 5 % of 1/f.
    const double a = z / camera.fx * noise.sigmaPixelPx;
    const double b = z / camera.fy * noise.sigmaPixelPx;
    PointGaussian out;
    out.mean = z * ray;                                 // [P17 Eq. 1]
    out.cov = sigmaZ * sigmaZ * ray * ray.transpose();  // [P17 Eq. 2]
    out.cov(0, 0) += a * a;
    out.cov(1, 1) += b * b;
    return out;
}
}  // namespace pointplane
