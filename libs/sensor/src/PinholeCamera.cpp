// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/sensor/PinholeCamera.h>

#include <cmath>
#include <sstream>

namespace pointplane
{
namespace
{
/** Brown's model as in OpenCV: normalised undistorted -> normalised distorted. */
Eigen::Vector2d distorted(const std::array<double, 5>& k, const Eigen::Vector2d& p)
{
    const double x = p.x(), y = p.y(), r2 = x * x + y * y;
    const double radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    return {
        x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x),
        y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y};
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

Eigen::Vector2d PinholeCamera::normalised(const Eigen::Vector2d& uv_px) const
{
    const Eigen::Vector2d raw((uv_px.x() - cx) / fx, (uv_px.y() - cy) / fy);
    if (!isDistorted())
    {
        return raw;
    }
    // Fixed-point inversion; Kinect-like distortion converges to 1e-9 within 20 rounds.
    Eigen::Vector2d p = raw;
    for (int i = 0; i < 20; ++i)
    {
        const Eigen::Vector2d error = raw - distorted(distortion, p);
        p += error;
        if (error.squaredNorm() < 1e-20)
        {
            break;
        }
    }
    return p;
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
