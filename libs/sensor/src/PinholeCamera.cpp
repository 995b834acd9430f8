// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/sensor/PinholeCamera.h>

#include <Eigen/LU>

#include <cmath>
#include <sstream>

namespace pointplane
{
namespace
{
/** In image sizes: no lens looks that far aside, not even one whose image has been cropped. */
constexpr double kFarPrincipalPoint = 10;

/** Brown's model as in OpenCV: normalised undistorted -> normalised distorted. */
Eigen::Vector2d distorted(const std::array<double, 5>& k, const Eigen::Vector2d& p)
{
    const double x = p.x(), y = p.y(), r2 = x * x + y * y;
    const double radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    return {
        x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x),
        y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y};
}

/** 2x2 Jacobian of distorted() with respect to p. */
Eigen::Matrix2d distortionJacobian(const std::array<double, 5>& k, const Eigen::Vector2d& p)
{
    const double x = p.x(), y = p.y(), r2 = x * x + y * y;
    const double radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    const double slope = k[0] + r2 * (2 * k[1] + r2 * 3 * k[4]);  // of radial over r2
    const double mixed = 2 * (x * y * slope + k[2] * x + k[3] * y);
    Eigen::Matrix2d J;
    J << radial + 2 * x * x * slope + 2 * k[2] * y + 6 * k[3] * x, mixed, mixed,
        radial + 2 * y * y * slope + 6 * k[2] * y + 2 * k[3] * x;
    return J;
}
}  // namespace

std::string PinholeCamera::problem() const
{
    std::ostringstream out;
    bool finite = std::isfinite(fx) && std::isfinite(fy) && std::isfinite(cx) && std::isfinite(cy);
    for (const double k : distortion)
    {
        finite = finite && std::isfinite(k);
    }
    if (!finite)
    {
        out << "camera intrinsics are not finite (fx=" << fx << " fy=" << fy << " cx=" << cx
            << " cy=" << cy << ")";
    }
    else if (std::abs(fx) < 1e-3 || std::abs(fy) < 1e-3)
    {
        out << "focal length is zero (fx=" << fx << " fy=" << fy << ")";
    }
    else if (width < 1 || height < 1)
    {
        out << "image is empty (" << width << "x" << height << ")";
    }
    else if (
        std::abs(cx) > kFarPrincipalPoint * width || std::abs(cy) > kFarPrincipalPoint * height)
    {
        out << "principal point is far outside the image (cx=" << cx << " cy=" << cy << ", image "
            << width << "x" << height << ")";
    }
    return out.str();
}

bool PinholeCamera::isDistorted() const
{
    for (const double k : distortion)
    {
        if (k != 0)
        {
            return true;
        }
    }
    return false;
}

Eigen::Vector2d PinholeCamera::normalised(const Eigen::Vector2d& uv_px, Eigen::Matrix2d* J) const
{
    const Eigen::Vector2d raw((uv_px.x() - cx) / fx, (uv_px.y() - cy) / fy);
    Eigen::Vector2d p = raw;
    Eigen::Matrix2d distortedOverIdeal = Eigen::Matrix2d::Identity();
    if (isDistorted())
    {
        // Newton from the raw position; two or three steps within a Kinect's image. The polynomial
        // may fold over outside of the calibrated area: there, stop before the Jacobian does.
        for (int i = 0; i < 10; ++i)
        {
            distortedOverIdeal = distortionJacobian(distortion, p);
            const Eigen::Vector2d error = distorted(distortion, p) - raw;
            if (error.squaredNorm() < 1e-24 || distortedOverIdeal.determinant() < 0.05)
            {
                break;
            }
            p -= distortedOverIdeal.inverse() * error;
        }
    }
    if (J != nullptr)
    {
        *J = distortedOverIdeal.inverse() * Eigen::Vector2d(1 / fx, 1 / fy).asDiagonal();
    }
    return p;
}

Eigen::Vector2d PinholeCamera::depthPixel(const Eigen::Vector2d& uv_px) const
{
    if (!depthAtUndistortedPixel || !isDistorted())
    {
        return uv_px;
    }
    const Eigen::Vector2d xy = normalised(uv_px);
    return {fx * xy.x() + cx, fy * xy.y() + cy};
}

Eigen::Vector2d PinholeCamera::normalisedOfDepth(const Eigen::Vector2d& depthUv_px) const
{
    if (!depthAtUndistortedPixel && isDistorted())
    {
        return normalised(depthUv_px);
    }
    return {(depthUv_px.x() - cx) / fx, (depthUv_px.y() - cy) / fy};
}

Eigen::Vector2d PinholeCamera::project(const Eigen::Vector3d& p_cam) const
{
    Eigen::Vector2d p(p_cam.x() / p_cam.z(), p_cam.y() / p_cam.z());
    if (isDistorted())
    {
        p = distorted(distortion, p);
    }
    return {fx * p.x() + cx, fy * p.y() + cy};
}

PinholeCamera PinholeCamera::scaled(double factor) const
{
    PinholeCamera out = *this;
    out.width = static_cast<int>(std::lround(width * factor));
    out.height = static_cast<int>(std::lround(height * factor));
    out.fx *= factor;
    out.fy *= factor;
    out.cx = (cx + 0.5) * factor - 0.5;
    out.cy = (cy + 0.5) * factor - 0.5;
    return out;
}
}  // namespace pointplane
