// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/PoseGaussian.h>
#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>

namespace pointplane
{
PoseGaussian compose(const PoseGaussian& T_a_b, const PoseGaussian& T_b_c)
{
    return {
        orthonormalised(T_a_b.mean * T_b_c.mean),
        T_a_b.cov + propagate(adjoint(T_a_b.mean), T_b_c.cov)};
}

PoseGaussian inverse(const PoseGaussian& T_a_b)
{
    const Eigen::Isometry3d T_b_a = T_a_b.mean.inverse();
    return {T_b_a, propagate(adjoint(T_b_a), T_a_b.cov)};
}

PoseGaussian changeFrame(const Eigen::Isometry3d& T_s_c, const PoseGaussian& T_a_b)
{
    return {T_s_c * T_a_b.mean * T_s_c.inverse(), propagate(adjoint(T_s_c), T_a_b.cov)};
}

Vector6d leftError(const Eigen::Isometry3d& truth, const Eigen::Isometry3d& mean)
{
    return se3Log(truth * mean.inverse());
}
}  // namespace pointplane
