// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/sensor/PinholeCamera.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace pointplane
{
namespace
{
/** Size of the image over the focal length: a pinhole camera does not see 178 degrees. */
constexpr double kWidestView = 100;

// Of the inversion of the lens' polynomial.
constexpr int kMostSteps = 20;
constexpr double kExact = 1e-12;      // normalised
constexpr double kReached_px = 1e-3;  // a ray that far from its pixel is another one

/** Brown's model as in OpenCV: normalised undistorted -> normalised distorted. */
Eigen::Vector2d distorted(const std::array<double, 5>& k, const Eigen::Vector2d& p)
{
    const double x = p.x(), y = p.y(), r2 = x * x + y * y;
    const double radial = 1 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
    return {
        x * radial + 2 * k[2] * x * y + k[3] * (r2 + 2 * x * x),
        y * radial + k[2] * (r2 + 2 * y * y) + 2 * k[3] * x * y};
}

/** Nearly (a pixel is 20 times as large as without distortion), or turned round. */
bool isFolded(const Eigen::Matrix2d& J) { return J.determinant() < 0.05 || J.trace() < 0; }

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
    else if (fx < 0)
    {
        out << "focal length is negative (fx=" << fx << "): the image would be mirrored";
    }
    else if (std::max(width / fx, height / std::abs(fy)) > kWidestView)
    {
        out << "focal length is too short for a pinhole camera (fx=" << fx << " fy=" << fy
            << ", image " << width << "x" << height << ")";
    }
    else if (width < 1 || height < 1)
    {
        out << "image is empty (" << width << "x" << height << ")";
    }
    else if (!(cx > 0 && cx < width && cy > 0 && cy < height))
    {
        out << "principal point is outside of the image (cx=" << cx << " cy=" << cy << ", image "
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
        // Newton from the centre, the first step to the raw position; three or four steps within a
        // Kinect's image.
        p.setZero();
        Eigen::Vector2d error = distorted(distortion, p) - raw;
        distortedOverIdeal = distortionJacobian(distortion, p);
        for (int i = 0; i < kMostSteps && error.norm() > kExact; ++i)
        {
            Eigen::Vector2d step = distortedOverIdeal.inverse() * error;
            while (isFolded(distortionJacobian(distortion, p - step)) && step.norm() > kExact)
            {
                step *= 0.5;
            }
            p -= step;
            error = distorted(distortion, p) - raw;
            distortedOverIdeal = distortionJacobian(distortion, p);
        }
        if (!(error.norm() * std::abs(fx) < kReached_px) || isFolded(distortedOverIdeal))
        {
            p.setConstant(std::numeric_limits<double>::quiet_NaN());
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
    if (!isDistorted())
    {
        return uv_px;
    }
    const Eigen::Vector2d xy = normalised(uv_px);
    return {fx * xy.x() + cx, fy * xy.y() + cy};
}

Eigen::Vector2d PinholeCamera::normalisedOfDepth(const Eigen::Vector2d& depthUv_px) const
{
    return {(depthUv_px.x() - cx) / fx, (depthUv_px.y() - cy) / fy};
}

Eigen::Vector2d PinholeCamera::project(const Eigen::Vector3d& p_cam) const
{
    Eigen::Vector2d p(p_cam.x() / p_cam.z(), p_cam.y() / p_cam.z());
    if (isDistorted())
    {
        if (isFolded(distortionJacobian(distortion, p)))
        {
            return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
        }
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
