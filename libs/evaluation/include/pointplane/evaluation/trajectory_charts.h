// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/FrameTable.h>
#include <pointplane/evaluation/HtmlReport.h>
#include <pointplane/evaluation/ate.h>
#include <pointplane/evaluation/consistency.h>
#include <pointplane/evaluation/nees.h>
#include <pointplane/evaluation/rpe.h>

#include <vector>

namespace pointplane
{
/** @name The charts of a trajectory report. Times are seconds since the estimate's first pose.
 * Lines of the estimate end at holesBefore() poses. The ground truth is drawn at its own stamps.
 * @{ */

/** An estimate as it is drawn, moved by `ate.T_truth_estimate`. */
struct DrawnPath
{
    std::string name;
    const Trajectory& estimate;
    const AteResult& ate;
    double scale{1};  //!< of its translations
};

/** The paths from above (x, y) and from the side (x, z of the ground truth's world), the ground
 * truth on top, its start and end marked. A single path is coloured by its position error and, if
 * it has covariances, a dozen of its positions get the ellipse of three standard deviations; these
 * mean something only if the first poses were aligned. \param paths at least one */
[[nodiscard]] std::vector<Chart> pathCharts(
    const Trajectory& groundTruth, const std::vector<DrawnPath>& paths);

/** Relative errors over time, translation and rotation: one point per pair, at its start.
 * \param result with listed pairs */
[[nodiscard]] std::vector<Chart> relativeErrorCharts(
    const Trajectory& estimate, const RpeOptions& options, const RpeResult& result);

/** Histogram of the errors with the share of smaller ones: translation and rotation.
 * \param result with listed pairs */
[[nodiscard]] std::vector<Chart> errorHistograms(
    const RpeOptions& options, const RpeResult& result);

/** RMSE of the relative error over intervals from 0.1 s to 5 s, as far as the estimate has them:
 * translation and rotation. Empty if it has fewer than two. */
[[nodiscard]] std::vector<Chart> errorOverInterval(
    const Trajectory& groundTruth, const Trajectory& estimate, const RpeOptions& options);

/** x, y, z and roll, pitch, yaw over time beside the ground truth, and their errors, each with the
 * band of three standard deviations if the estimate has covariances: twelve small charts in the
 * ground truth's world, the first poses aligned.
 * \param aligned brings the estimate's first pose onto the ground truth's
 * \throws std::runtime_error if no pose has ground truth */
[[nodiscard]] std::vector<Chart> poseCharts(
    const Trajectory& groundTruth,
    const Trajectory& estimate,
    const AteOptions& options,
    const AteResult& aligned);

/** Position error over time. */
[[nodiscard]] Chart positionErrorChart(const Trajectory& estimate, const AteResult& result);

/** Histogram of the position errors, with the share of smaller ones. */
[[nodiscard]] Chart positionErrorHistogram(const AteResult& result);

/** NEES per degree of freedom of each increment over time, with the 95 % bounds of single
 * increments and of their mean. */
[[nodiscard]] Chart neesChart(
    const Trajectory& estimate,
    const std::vector<NeesIncrement>& increments,
    const NeesResult& result);

/** Error of each degree of freedom against three standard deviations: translation and rotation. */
[[nodiscard]] std::vector<Chart> errorAgainstSigmaCharts(
    const Trajectory& estimate,
    const std::vector<NeesIncrement>& increments,
    const NeesInterval& interval);

/** Features, tracking status and times per stage; only those the table has columns for. The table
 * may begin before the estimate, or be of a part. \param start stamp of the first pose [s] */
[[nodiscard]] std::vector<Chart> frameCharts(const FrameTable& table, double start);

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
