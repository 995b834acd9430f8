// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>

#include <Eigen/LU>
#include <Eigen/SVD>

#include <cmath>

namespace pointplane
{
namespace
{
constexpr double kSmallAngle = 1e-5;
constexpr double kSeriesAngle = 1e-2;  // below it the closed forms of V lose digits

/** Left Jacobian V of SO(3): translation of exp(xi) is V(omega) rho. */
Eigen::Matrix3d so3LeftJacobian(const Eigen::Vector3d& omega)
{
    const double angle = omega.norm(), a2 = angle * angle;
    const Eigen::Matrix3d W = hat(omega);
    if (angle < kSeriesAngle)
    {
        return Eigen::Matrix3d::Identity() + (0.5 - a2 / 24 + a2 * a2 / 720) * W +
               (1.0 / 6 - a2 / 120 + a2 * a2 / 5040) * W * W;
    }
    return Eigen::Matrix3d::Identity() + (1 - std::cos(angle)) / a2 * W +
           (angle - std::sin(angle)) / (a2 * angle) * W * W;
}
}  // namespace

Eigen::Matrix3d hat(const Eigen::Vector3d& a)
{
    Eigen::Matrix3d out;
    out << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
    return out;
}

Eigen::Matrix3d so3Exp(const Eigen::Vector3d& omega)
{
    const double angle = omega.norm();
    if (angle < kSmallAngle)
    {
        const Eigen::Matrix3d W = hat(omega);
        return Eigen::Matrix3d::Identity() + W + 0.5 * W * W;
    }
    return Eigen::AngleAxisd(angle, omega / angle).toRotationMatrix();
}

Eigen::Vector3d so3Log(const Eigen::Matrix3d& R)
{
    Eigen::Quaterniond q(R);
    if (q.w() < 0)
    {
        q.coeffs() = -q.coeffs();
    }
    const double sinHalf = q.vec().norm();
    if (sinHalf < kSmallAngle)
    {
        return 2.0 / q.w() * q.vec();
    }
    return 2.0 * std::atan2(sinHalf, q.w()) / sinHalf * q.vec();
}

Eigen::Isometry3d se3Exp(const Vector6d& xi)
{
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = so3Exp(xi.tail<3>());
    T.translation() = so3LeftJacobian(xi.tail<3>()) * xi.head<3>();
    return T;
}

Vector6d se3Log(const Eigen::Isometry3d& T)
{
    Vector6d xi;
    xi.tail<3>() = so3Log(T.linear());
    xi.head<3>() = so3LeftJacobian(xi.tail<3>()).partialPivLu().solve(T.translation());
    return xi;
}

Matrix6d adjoint(const Eigen::Isometry3d& T)
{
    Matrix6d Ad = Matrix6d::Zero();
    Ad.topLeftCorner<3, 3>() = T.linear();
    Ad.bottomRightCorner<3, 3>() = T.linear();
    Ad.topRightCorner<3, 3>() = hat(T.translation()) * T.linear();
    return Ad;
}

Eigen::Isometry3d orthonormalised(const Eigen::Isometry3d& T)
{
    Eigen::Isometry3d out = T;
    out.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
    return out;
}

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& S)
{
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(S, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const bool isReflection = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0;
    const Eigen::Vector3d signs(1, 1, isReflection ? -1 : 1);
    return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}
}  // namespace pointplane
