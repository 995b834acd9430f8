// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/pose/MotionGaussian.h>

#include <Eigen/Cholesky>

namespace pointplane
{
MotionPrior MotionPrior::from(const MotionGaussian& predicted)
{
    MotionPrior out;
    out.mean = predicted.mean;
    out.pose = predicted.pose().cov.ldlt().solve(Matrix6d::Identity());
    // V given T is Gaussian around V_mean + K e_T: the information of V - K e_T.
    const Matrix6d K = predicted.cov.bottomLeftCorner<6, 6>() * out.pose;
    const Matrix6d cov =
        predicted.cov.bottomRightCorner<6, 6>() - K * predicted.cov.topRightCorner<6, 6>();
    Eigen::Matrix<double, 6, 12> J;
    J << -K, Matrix6d::Identity();
    out.velocityGivenPose = J.transpose() * cov.ldlt().solve(J);
    return out;
}

MotionPrior MotionPrior::fixedVelocity(const Motion& motion)
{
    MotionPrior out;
    out.mean = motion;
    out.velocityGivenPose.bottomRightCorner<6, 6>().diagonal().setConstant(
        1 / (kExactSigma * kExactSigma));
    return out;
}

Vector12d MotionPrior::residual(const Motion& motion) const
{
    Vector12d out;
    out << se3Log(mean.T_prev_cur * motion.T_prev_cur.inverse()), mean.velocity - motion.velocity;
    return out;
}
}  // namespace pointplane
