// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/pose/MotionGaussian.h>

#include <Eigen/Cholesky>

namespace pointplane
{
namespace
{
/** As good as certain, and still far from the limits of double precision. */
constexpr double kFixedSigma = 1e-6;  // [m/s, rad/s]
}  // namespace

MotionPrior MotionPrior::from(const MotionGaussian& predicted)
{
    MotionPrior out;
    out.mean = predicted.mean;
    out.pose = predicted.pose().cov.ldlt().solve(Matrix6d::Identity());
    out.velocityGivenPose = predicted.cov.ldlt().solve(Matrix12d::Identity());
    out.velocityGivenPose.topLeftCorner<6, 6>() -= out.pose;
    return out;
}

MotionPrior MotionPrior::fixedVelocity(const Motion& motion)
{
    MotionPrior out;
    out.mean = motion;
    out.velocityGivenPose.bottomRightCorner<6, 6>().diagonal().setConstant(
        1 / (kFixedSigma * kFixedSigma));
    return out;
}

Vector12d MotionPrior::residual(const Motion& motion) const
{
    Vector12d out;
    out << se3Log(mean.T_base_cur * motion.T_base_cur.inverse()), mean.velocity - motion.velocity;
    return out;
}
}  // namespace pointplane
