// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/Surface.h>

#include <cmath>

#include "two_pi.h"

namespace pointplane
{
namespace
{
double inverseDepthCylinder(
    const Surface& s, const Eigen::Vector3d& eye, const Eigen::Vector3d& ray)
{
    const Eigen::Vector3d o = eye - s.origin;
    const double ox = o.dot(s.e1), oy = o.dot(s.e2), oz = o.dot(s.e3);
    const double dx = ray.dot(s.e1), dy = ray.dot(s.e2), dz = ray.dot(s.e3);
    // (ox q + dx)^2 + (oy q + dy)^2 = r^2 q^2; the larger root is the nearer wall.
    const double a = ox * ox + oy * oy - s.radius * s.radius;
    const double b = ox * dx + oy * dy;
    const double discriminant = b * b - a * (dx * dx + dy * dy);
    if (a <= 0 || discriminant <= 0 || b >= 0)
    {
        return 0;
    }
    const double q = (-b + std::sqrt(discriminant)) / a;
    const double height = oz + dz / q;
    return height >= 0 && height <= s.height ? q : 0;
}
}  // namespace

Eigen::Vector2d Surface::pictureSize() const
{
    switch (kind)
    {
        case Kind::Disc:
            return {2 * radius, 2 * radius};
        case Kind::Cylinder:
            return {kTwoPi * radius, height};
        default:
            return {width, height};
    }
}

void Surface::pictureToWorld(
    double s, double t, Eigen::Vector3d& point, Eigen::Vector3d& normal) const
{
    if (kind == Kind::Cylinder)
    {
        const double angle = s / radius - kTwoPi / 2;
        normal = std::cos(angle) * e1 + std::sin(angle) * e2;
        point = origin + radius * normal + t * e3;
        return;
    }
    const double offset = kind == Kind::Disc ? radius : 0;
    normal = e3;
    point = origin + (s - offset) * e1 + (t - offset) * e2;
}

Eigen::Vector2d Surface::worldToPicture(const Eigen::Vector3d& point) const
{
    const Eigen::Vector3d p = point - origin;
    const double s = p.dot(e1), t = p.dot(e2);
    switch (kind)
    {
        case Kind::Disc:
            return {s + radius, t + radius};
        case Kind::Cylinder:
            return {(std::atan2(t, s) + kTwoPi / 2) * radius, p.dot(e3)};
        default:
            return {s, t};
    }
}

double Surface::inverseDepth(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) const
{
    if (kind == Kind::Cylinder)
    {
        return inverseDepthCylinder(*this, eye, ray);
    }
    const Eigen::Vector3d o = eye - origin;
    const double above = o.dot(e3);
    if (above <= 0)
    {
        return 0;
    }
    const double q = -ray.dot(e3) / above;
    if (q <= 0)
    {
        return 0;
    }
    const double s = o.dot(e1) + ray.dot(e1) / q;
    const double t = o.dot(e2) + ray.dot(e2) / q;
    const bool inside = kind == Kind::Disc ? s * s + t * t <= radius * radius
                                           : s >= 0 && s <= width && t >= 0 && t <= height;
    return inside ? q : 0;
}
}  // namespace pointplane
