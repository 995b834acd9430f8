// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>
#include <pointplane/pose/residuals.h>

namespace pointplane
{
namespace
{
/** C = d n = theta / |theta|^2 [P17, before Eq. 7] and its Jacobian. */
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

/** theta_a = s u with u = R theta_b, s = 1 / (1 - u . t), and d theta_a / d theta_b. */
struct PlaneTransform
{
    PlaneTransform(const Eigen::Isometry3d& T_a_b, const Eigen::Vector3d& theta_b)
    {
        const Eigen::Vector3d u = T_a_b.linear() * theta_b;
        const double s = 1 / (1 - u.dot(T_a_b.translation()));
        theta = s * u;
        J = s * (Eigen::Matrix3d::Identity() + s * u * T_a_b.translation().transpose()) *
            T_a_b.linear();
    }
    Eigen::Vector3d theta;
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

Residual pointResidual(const PointPair& pair, const Motion& motion)
{
    Residual out;
    const Eigen::Matrix3d R = motion.T_prev_cur.linear();
    const Eigen::Vector3d p_prev =
        motion.T_prev_cur * (pair.cur.mean + pair.dCur_dV * motion.velocity);
    out.r = pair.ref.mean - p_prev;  // [P17 Eq. 8]
    out.curCov = propagate(R, pair.cur.cov);
    out.cov = pair.ref.cov + out.curCov;  // [P17, after Eq. 10]
    out.J << -Eigen::Matrix3d::Identity(), hat(p_prev);
    out.J_V = -R * pair.dCur_dV;
    out.ofReferenceVelocity = pair.dRef_dV;
    out.ofCamera = pair.dRef_dCamera - R * pair.dCur_dCamera;
    return out;
}

PlaneGaussian transformed(const Eigen::Isometry3d& T_a_b, const PlaneGaussian& plane_b)
{
    const PlaneTransform plane_a(T_a_b, plane_b.theta_m);
    return {plane_a.theta, propagate(plane_a.J, plane_b.cov_m)};
}

Eigen::Matrix3d transformJacobian(const Eigen::Isometry3d& T_a_b, const Eigen::Vector3d& theta_b)
{
    return PlaneTransform(T_a_b, theta_b).J;
}

Residual planeResidualMinimal(const PlanePair& pair, const Motion& motion)
{
    const PlaneTransform cur(motion.T_prev_cur, pair.cur.theta_m + pair.dCur_dV * motion.velocity);
    Residual out;
    out.r = pair.ref.theta_m - cur.theta;
    out.curCov = propagate(cur.J, pair.cur.cov_m);
    out.cov = pair.ref.cov_m + out.curCov;
    out.J = -jacobianOfTransform(cur.theta);
    out.J_V = -cur.J * pair.dCur_dV;
    out.ofReferenceVelocity = pair.dRef_dV;
    out.ofCamera = pair.dRef_dCamera - cur.J * pair.dCur_dCamera;
    return out;
}

Residual planeResidualClosestPoint(const PlanePair& pair, const Motion& motion)
{
    const Eigen::Isometry3d T_cur_prev = motion.T_prev_cur.inverse();
    const PlaneTransform moved(T_cur_prev, pair.ref.theta_m);
    const ClosestPoint reference(moved.theta),
        cur(pair.cur.theta_m + pair.dCur_dV * motion.velocity);
    const Eigen::Matrix3d byReference = reference.J * moved.J;
    Residual out;
    out.r = reference.C - cur.C;  // [P17 Eq. 9]
    out.curCov = propagate(cur.J, pair.cur.cov_m);
    out.cov = propagate(byReference, pair.ref.cov_m) + out.curCov;  // [P17, after Eq. 10]
    // T_cur_prev exp(-xi) moves the reference.
    out.J = -byReference * jacobianOfTransform(pair.ref.theta_m);
    out.J_V = -cur.J * pair.dCur_dV;
    out.ofReferenceVelocity = byReference * pair.dRef_dV;
    out.ofCamera = byReference * pair.dRef_dCamera - cur.J * pair.dCur_dCamera;
    return out;
}
}  // namespace pointplane
