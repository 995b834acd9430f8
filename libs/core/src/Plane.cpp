// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/Plane.h>
#include <pointplane/core/covariance.h>

namespace pointplane
{
Eigen::Vector3d minimalForm(const Plane& plane)
{
    POINTPLANE_CHECK(plane.d != 0, "a plane through the origin has no minimal form n/d");
    return plane.n / plane.d;
}

Plane hessianForm(const Eigen::Vector3d& theta_m)
{
    const double norm = theta_m.norm();
    POINTPLANE_CHECK(norm > 0, "theta_m = 0 is the plane at infinity");
    return {theta_m / norm, 1 / norm};  // [P17 Eq. 6]
}

Matrix43d jacobianHessianForm(const Eigen::Vector3d& theta_m)
{
    const double norm = theta_m.norm();
    const Eigen::Vector3d n = theta_m / norm;
    Matrix43d J;
    J.topRows<3>() = (Eigen::Matrix3d::Identity() - n * n.transpose()) / norm;
    J.bottomRows<1>() = -n.transpose() / (norm * norm);
    return J;
}

Plane transformed(const Eigen::Isometry3d& T_a_b, const Plane& plane_b)
{
    Plane out;
    out.n = T_a_b.linear() * plane_b.n;
    out.d = plane_b.d - out.n.dot(T_a_b.translation());
    return out;
}

Eigen::Matrix4d hessianCovariance(const PlaneGaussian& plane)
{
    return propagate(jacobianHessianForm(plane.theta_m), plane.cov_m);
}
}  // namespace pointplane
