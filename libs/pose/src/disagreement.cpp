// SPDX-License-Identifier: BSD-3-Clause
#include "disagreement.h"

#include <Eigen/Cholesky>

namespace pointplane
{
namespace
{
/** Of a direction about which a group knows less than this, as a part of what all know, it says
 * nothing. */
constexpr double kLeastShare = 0.03;
}  // namespace

Disagreement disagreementOf(
    const std::map<int, FeatureSum>& groups,
    const Matrix12d& H,
    const Matrix12d& H_inverse,
    const Matrix12d& cov)
{
    Disagreement out;
    for (const auto& [reference, group] : groups)
    {
        const Matrix12d shared = group.H * H_inverse * group.M;
        const Matrix12d covOfGradient =
            group.M - shared - shared.transpose() + group.H * cov * group.H;
        const Eigen::LDLT<Matrix6d> known((group.H + kLeastShare * H).topLeftCorner<6, 6>());
        const Vector6d gradient = group.g.head<6>();
        out.observed += gradient.dot(known.solve(gradient));
        out.expected += known.solve(Matrix6d(covOfGradient.topLeftCorner<6, 6>())).trace();
    }
    return out;
}
}  // namespace pointplane
