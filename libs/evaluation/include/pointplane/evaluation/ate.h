// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Statistics.h>
#include <pointplane/evaluation/Trajectory.h>
#include <pointplane/evaluation/coverage.h>

namespace pointplane
{
/** How the estimate is brought into the ground truth's frame before positions are compared. */
enum class Alignment
{
    Se3,        //!< least squares over all associated positions (Horn), as evaluate_ate.py
    FirstPose,  //!< the first associated pose of both coincide
    None
};

/** Defaults are those of evaluate_ate.py. */
struct AteOptions
{
    double offset{0};            //!< added to the estimate's stamps [s]
    double scale{1};             //!< multiplies the estimate's translations
    double maxDifference{0.02};  //!< of associated stamps [s]
    Alignment alignment{Alignment::Se3};
};

/** Position error of one associated pose. */
struct AteError
{
    std::size_t truth{0}, estimate{0};  //!< indices into the trajectories
    double translation{0};              //!< [m]
    /** Estimate minus truth in the ground truth's world [m]. */
    Eigen::Vector3d difference{Eigen::Vector3d::Zero()};
};

struct AteResult
{
    Statistics translation;  //!< [m]
    Coverage coverage;
    Eigen::Isometry3d T_truth_estimate{Eigen::Isometry3d::Identity()};  //!< of the world frames
    std::vector<AteError> errors;
};

/** Absolute trajectory error by the protocol of the TUM benchmark's evaluate_ate.py.
 * \throws std::runtime_error if the trajectories do not overlap, or fewer than two stamps can be
 * associated */
[[nodiscard]] AteResult absoluteTrajectoryError(
    const Trajectory& groundTruth, const Trajectory& estimate, const AteOptions& options);

/** Rigid T_a_b that minimises the sum of |a_k - T b_k|^2 [Horn 1987, by SVD]; the columns of both
 * are corresponding points. */
[[nodiscard]] Eigen::Isometry3d alignPoints(
    const Eigen::Matrix3Xd& points_a, const Eigen::Matrix3Xd& points_b);

/** The protocol in one line: association, alignment, poses used. */
[[nodiscard]] std::string describe(
    const AteOptions& options, const AteResult& result, std::size_t estimatePoses);
}  // namespace pointplane
