// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/pose/residuals.h>

namespace pointplane
{
namespace
{
/** C = d n = theta / |theta|^2 and its Jacobian. */
struct ClosestPoint
{
    explicit ClosestPoint(const Eigen::Vector3d& theta)
    {
        const double norm2 = theta.squaredNorm();
        C = theta / norm2;
        J = (Eigen::Matrix3d::Identity() - 2 * theta * theta.transpose() / norm2) / norm2;
    }
    Eigen::Vector3d C;
    Eigen::Matrix3d J;
};

/** d theta_a / d xi for theta_a = exp(xi) applied to a plane already in frame a. */
Matrix36d jacobianOfTransform(const Eigen::Vector3d& theta_a)
{
    Matrix36d J;
    J << theta_a * theta_a.transpose(), -hat(theta_a);
    return J;
}
}  // namespace

Residual pointResidual(const PointPair& pair, const Eigen::Isometry3d& T_base_cur)
{
    Residual out;
    const Eigen::Vector3d p_base = T_base_cur * pair.cur.mean;
    out.r = pair.base.mean - p_base;  // [P17 Eq. 8]
    out.cov = pair.base.cov + propagate(T_base_cur.linear(), pair.cur.cov);
    out.J << -Eigen::Matrix3d::Identity(), hat(p_base);
    return out;
}

PlaneGaussian transformed(const Eigen::Isometry3d& T_a_b, const PlaneGaussian& plane_b)
{
    const Eigen::Vector3d u = T_a_b.linear() * plane_b.theta_m;
    const double s = 1 / (1 - u.dot(T_a_b.translation()));
    const Eigen::Matrix3d J =
        s * (Eigen::Matrix3d::Identity() + s * u * T_a_b.translation().transpose()) *
        T_a_b.linear();
    return {s * u, propagate(J, plane_b.cov_m)};
}

Residual planeResidualMinimal(const PlanePair& pair, const Eigen::Isometry3d& T_base_cur)
{
    const PlaneGaussian plane_base = transformed(T_base_cur, pair.cur);
    Residual out;
    out.r = pair.base.theta_m - plane_base.theta_m;
    out.cov = pair.base.cov_m + plane_base.cov_m;
    out.J = -jacobianOfTransform(plane_base.theta_m);
    return out;
}

Residual planeResidualClosestPoint(const PlanePair& pair, const Eigen::Isometry3d& T_base_cur)
{
    const PlaneGaussian plane_base = transformed(T_base_cur, pair.cur);
    const ClosestPoint measured(plane_base.theta_m), reference(pair.base.theta_m);
    Residual out;
    out.r = reference.C - measured.C;  // [P17 Eq. 9], up to the sign of both
    out.cov = propagate(reference.J, pair.base.cov_m) + propagate(measured.J, plane_base.cov_m);
    out.J = -measured.J * jacobianOfTransform(plane_base.theta_m);
    return out;
}
}  // namespace pointplane
