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
    return {predicted.mean, predicted.cov.ldlt().solve(Matrix12d::Identity())};
}

MotionPrior MotionPrior::velocityGivenPose(const MotionGaussian& predicted)
{
    MotionPrior out = from(predicted);
    // The joint information without that of the marginal of the pose.
    const Matrix6d cov = predicted.cov.topLeftCorner<6, 6>();
    out.information.topLeftCorner<6, 6>() -= cov.ldlt().solve(Matrix6d::Identity());
    return out;
}

MotionPrior MotionPrior::fixedVelocity(const Motion& motion)
{
    MotionPrior out{motion, Matrix12d::Zero()};
    out.information.bottomRightCorner<6, 6>().diagonal().setConstant(
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
