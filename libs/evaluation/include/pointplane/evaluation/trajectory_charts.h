// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/FrameTable.h>
#include <pointplane/evaluation/HtmlReport.h>
#include <pointplane/evaluation/ate.h>
#include <pointplane/evaluation/nees.h>
#include <pointplane/evaluation/rpe.h>

#include <vector>

namespace pointplane
{
/** @name The charts of a trajectory report. Times are seconds since the estimate's first pose.
 * @{ */

/** The path from above (x, y) and from the side (x, z of the ground truth's world), the estimate
 * moved by `ate.T_truth_estimate`. If it has covariances, a dozen of its positions get the ellipse
 * of three standard deviations; these mean something only if the first poses were aligned. */
[[nodiscard]] std::vector<Chart> pathCharts(
    const Trajectory& groundTruth, const Trajectory& estimate, const AteResult& ate);

/** Relative errors over time: one point per pair, at its start. \param result with listed pairs */
[[nodiscard]] Chart relativeErrorChart(
    const Trajectory& estimate, const RpeOptions& options, const RpeResult& result);

/** Position error over time. */
[[nodiscard]] Chart positionErrorChart(const Trajectory& estimate, const AteResult& result);

/** NEES per degree of freedom of each increment over time, with the bounds that 95 % of them have
 * to lie in and those of their mean. */
[[nodiscard]] Chart neesChart(
    const Trajectory& estimate,
    const std::vector<NeesIncrement>& increments,
    const NeesResult& result);

/** Error of each degree of freedom against three standard deviations: translation and rotation. */
[[nodiscard]] std::vector<Chart> errorAgainstSigmaCharts(
    const Trajectory& estimate, const std::vector<NeesIncrement>& increments);

/** Features, tracking status and times per stage; only those the table has columns for. */
[[nodiscard]] std::vector<Chart> frameCharts(const FrameTable& table);

/** @} */

/** 3-sigma contour of a position's uncertainty in the plane of two world axes, in `points` steps.
 * \param cov 6x6 left-perturbation covariance of T_world_body */
[[nodiscard]] std::vector<Eigen::Vector2d> positionEllipse(
    const Eigen::Isometry3d& T_world_body,
    const Matrix6d& cov,
    int horizontalAxis,
    int verticalAxis,
    int points = 33);
}  // namespace pointplane
