// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/rpe.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
/** Error of any pair of poses in some 25 multiplications, so that 10^8 pairs are a matter of
 * seconds.
 *
 * With A_j = P_j inv(G_j) the script's error is E = inv(P_i) A_j G_i; its angle follows from
 * trace(R_Aj R_Gi R_Pi^T) and its translation has the length of A_j t_Gi - t_Pi. Evo's error is
 * the same with G and P, i and j swapped. */
class PairError
{
 public:
    /** \param truth one pose per estimate pose \param scale of the estimate's translations */
    PairError(
        const std::vector<Eigen::Isometry3d>& truth,
        const std::vector<Eigen::Isometry3d>& estimate,
        double scale,
        RpeFormula formula)
        : swap_(formula == RpeFormula::Evo)
    {
        terms_.reserve(estimate.size());
        for (std::size_t k = 0; k < estimate.size(); ++k)
        {
            Eigen::Isometry3d P = estimate[k];
            P.translation() *= scale;
            terms_.push_back(swap_ ? Terms(truth[k], P) : Terms(P, truth[k]));
        }
    }

    /** Translation error [m]. */
    [[nodiscard]] double translation(std::size_t i, std::size_t j) const
    {
        const Terms& a = terms_[swap_ ? i : j];
        const Terms& b = terms_[swap_ ? j : i];
        return (a.R_A * b.t_second + a.t_A - b.t_first).norm();
    }

    /** Rotation error [rad]. */
    [[nodiscard]] double rotation(std::size_t i, std::size_t j) const
    {
        const Terms& a = terms_[swap_ ? i : j];
        const Terms& b = terms_[swap_ ? j : i];
        const double trace = a.R_A.cwiseProduct(b.R_M).sum();
        return std::acos(std::clamp((trace - 1) / 2, -1.0, 1.0));
    }

 private:
    struct Terms
    {
        Terms(const Eigen::Isometry3d& first, const Eigen::Isometry3d& second)
            : t_first(first.translation()), t_second(second.translation())
        {
            const Eigen::Isometry3d A = first * second.inverse();
            R_A = A.linear();
            t_A = A.translation();
            R_M = first.linear() * second.linear().transpose();
        }
        Eigen::Matrix3d R_A, R_M;
        Eigen::Vector3d t_A, t_first, t_second;
    };
    bool swap_;
    std::vector<Terms> terms_;
};
}  // namespace pointplane
