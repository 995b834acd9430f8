// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/se3.h>
#include <pointplane/evaluation/association.h>
#include <pointplane/evaluation/ate.h>
#include <pointplane/evaluation/scored_trajectories.h>

#include <stdexcept>

#include "short_number.h"

namespace pointplane
{
Eigen::Isometry3d alignPoints(const Eigen::Matrix3Xd& points_a, const Eigen::Matrix3Xd& points_b)
{
    const Eigen::Vector3d mean_a = points_a.rowwise().mean();
    const Eigen::Vector3d mean_b = points_b.rowwise().mean();
    const Eigen::Matrix3d W =
        (points_a.colwise() - mean_a) * (points_b.colwise() - mean_b).transpose();
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = nearestRotation(W);
    T.translation() = mean_a - T.linear() * mean_b;
    return T;
}

namespace
{
/** \return indices of ground truth and estimate
 * \throws std::runtime_error if there are not two pairs */
std::vector<std::pair<std::size_t, std::size_t>> pairsOf(
    const Trajectory& groundTruth, const Trajectory& estimate, const AteOptions& options)
{
    auto pairs =
        associate(groundTruth.stamps, estimate.stamps, options.offset, options.maxDifference);
    if (pairs.size() < 2)
    {
        throw std::runtime_error(
            std::string(pairs.empty() ? "no" : "only one") +
            " pose of the estimate has ground truth within " +
            std::to_string(options.maxDifference) +
            " s; at least two are needed (--max-difference, --offset)");
    }
    return pairs;
}
}  // namespace

AteResult absoluteTrajectoryError(
    const Trajectory& groundTruth, const Trajectory& estimate, const AteOptions& options)
{
    checkOverlap(groundTruth, estimate, options.offset);
    checkPositions(groundTruth);
    checkPositions(estimate, options.scale);
    const auto pairs = pairsOf(groundTruth, estimate, options);
    const auto n = static_cast<Eigen::Index>(pairs.size());
    Eigen::Matrix3Xd truth(3, n);
    Eigen::Matrix3Xd estimated(3, n);
    for (Eigen::Index k = 0; k < n; ++k)
    {
        const auto& [i, j] = pairs[static_cast<std::size_t>(k)];
        truth.col(k) = groundTruth.poses[i].translation();
        estimated.col(k) = options.scale * estimate.poses[j].translation();
    }

    AteResult result;
    result.coverage = coverageOf(groundTruth, estimate, options.offset);
    if (options.alignment == Alignment::Se3)
    {
        result.T_truth_estimate = alignPoints(truth, estimated);
    }
    else if (options.alignment == Alignment::FirstPose)
    {
        Eigen::Isometry3d first = estimate.poses[pairs.front().second];
        first.translation() *= options.scale;
        result.T_truth_estimate = groundTruth.poses[pairs.front().first] * first.inverse();
    }
    std::vector<double> errors;
    for (Eigen::Index k = 0; k < n; ++k)
    {
        const auto& [i, j] = pairs[static_cast<std::size_t>(k)];
        const Eigen::Vector3d difference =
            result.T_truth_estimate * estimated.col(k) - truth.col(k);
        errors.push_back(difference.norm());
        result.errors.push_back({i, j, errors.back(), difference});
    }
    result.translation = statisticsOf(errors);
    return result;
}

std::string describe(const AteOptions& options, const AteResult& result, std::size_t estimatePoses)
{
    const std::string alignment = options.alignment == Alignment::Se3         ? "SE(3) aligned"
                                  : options.alignment == Alignment::FirstPose ? "first pose aligned"
                                                                              : "not aligned";
    return "TUM protocol (evaluate_ate), " + alignment + ", association " +
           shortNumber(options.maxDifference) + " s" +
           describeChanges(options.offset, options.scale) + ", " +
           std::to_string(result.errors.size()) + " of " + std::to_string(estimatePoses) + " poses";
}
}  // namespace pointplane
