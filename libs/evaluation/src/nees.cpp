// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/number_text.h>
#include <pointplane/core/se3.h>
#include <pointplane/evaluation/nees.h>
#include <pointplane/evaluation/scored_trajectories.h>
#include <pointplane/evaluation/stamp_intervals.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace pointplane
{
namespace
{
/** End of the increment that starts at i, if the estimate has one of about that length. */
std::optional<std::size_t> endOf(
    const Trajectory& estimate, std::size_t i, const NeesInterval& interval, double tolerance)
{
    if (interval.unit == DeltaUnit::Frames)
    {
        const auto j = i + static_cast<std::size_t>(interval.delta);
        return j < estimate.size() ? std::optional(j) : std::nullopt;
    }
    const double target = estimate.stamps[i] + interval.delta;
    const std::size_t j = nearestIndex(estimate.stamps, target);
    const bool fits = j > i && std::abs(estimate.stamps[j] - target) <= tolerance;
    return fits ? std::optional(j) : std::nullopt;
}

/** Ends of the increments, of the given length or all from the first pose. */
std::vector<std::pair<std::size_t, std::size_t>> endsOf(
    const Trajectory& estimate, const NeesInterval& interval)
{
    std::vector<std::pair<std::size_t, std::size_t>> out;
    const double tolerance = 0.5 * medianInterval(estimate.stamps) + 1e-6;
    for (std::size_t i = 0; i < estimate.size(); ++i)
    {
        if (interval.sinceStart && i > 0)
        {
            out.emplace_back(0, i);
        }
        else if (!interval.sinceStart)
        {
            if (const auto j = endOf(estimate, i, interval, tolerance))
            {
                out.emplace_back(i, *j);
            }
        }
    }
    return out;
}

const std::string kMapTellsNone =
    "A .simplemap cannot: test the rawlog of pointplane-odometry --since";

bool isMap(const Trajectory& estimate)
{
    return estimate.name.find(".simplemap") != std::string::npos;
}

/** Poses of the file from one to a later one, with those that are left out here; 0 if it is not
 * later in the file. */
std::size_t posesBetween(const Trajectory& estimate, std::size_t i, std::size_t j)
{
    const std::vector<std::size_t>& numbers = estimate.numbers;
    return numbers.empty() ? j - i : std::max(numbers[i], numbers[j]) - numbers[i];
}

bool isTold(const Trajectory& estimate, std::size_t i, std::size_t j)
{
    const std::size_t n = posesBetween(estimate, i, j);
    return n > 0 && j < estimate.sinceCovs.size() && n <= estimate.sinceCovs[j].size();
}

/** Empty if the covariances of all these increments are in the file, or those of poses since one
 * that is certain; else a note that they are right only if increments are independent. */
std::string noteOnUntold(const Trajectory& estimate, const std::vector<NeesIncrement>& increments)
{
    const bool all = std::all_of(
        increments.begin(),
        increments.end(),
        [&](const NeesIncrement& increment) {
            return isTold(estimate, increment.i, increment.j) ||
                   estimate.covs[increment.i].isZero(0);
        });
    if (all)
    {
        return "";
    }
    return "'" + estimate.name + "' does not tell the covariances of all these increments (" +
           (isMap(estimate) ? kMapTellsNone : "pointplane-odometry --since") +
           "); they are taken for the growth of the poses', which is right if increments are "
           "independent";
}
}  // namespace

Matrix6d incrementCovariance(const Trajectory& estimate, std::size_t i, std::size_t j)
{
    if (isTold(estimate, i, j))
    {
        return estimate.sinceCovs[j][posesBetween(estimate, i, j) - 1];
    }
    const Matrix6d Ad = adjoint(estimate.poses[i].inverse());
    return propagate(Ad, (estimate.covs[j] - estimate.covs[i]).eval());
}

namespace
{
/** \throws UntoldCovariance if that of the increment is not positive definite */
Matrix6d definiteCovariance(const Trajectory& estimate, std::size_t i, std::size_t j)
{
    const Matrix6d cov = incrementCovariance(estimate, i, j);
    if (!isPositiveDefinite(cov))
    {
        throw UntoldCovariance(
            "'" + estimate.name + "': the covariance of the increment from " +
            numberText(estimate.stamps[i], 6) + " to " + numberText(estimate.stamps[j], 6) +
            " s is not positive definite");
    }
    return cov;
}

/** Covariance of a pose of the ground truth (left perturbation in the body's frame). */
Matrix6d truthCovariance(const NeesOptions& options)
{
    Vector6d variances;
    variances.head<3>().setConstant(std::pow(options.truthSigmaTranslation, 2));
    variances.tail<3>() = options.truthSigmaRotation.cwiseAbs2();
    return propagate(adjoint(options.T_truth_body.inverse()), Matrix6d(variances.asDiagonal()));
}
}  // namespace

std::vector<NeesIncrement> neesIncrements(
    const Trajectory& groundTruth,
    const Trajectory& estimate,
    const NeesInterval& interval,
    const NeesOptions& options)
{
    if (estimate.covs.size() != estimate.size())
    {
        throw std::runtime_error(
            "'" + estimate.name +
            "' has no covariances: give a rawlog or .simplemap with pose PDFs");
    }
    checkOverlap(groundTruth, estimate, options.offset);
    checkPositions(groundTruth);
    checkPositions(estimate);
    const SampledTruth truth =
        sampleTruth(groundTruth, estimate.stamps, options.offset, options.truthAt);

    const Eigen::Isometry3d& T_truth_body = options.T_truth_body;
    const Matrix6d N = truthCovariance(options);
    std::vector<NeesIncrement> out;
    for (const auto& [i, j] : endsOf(estimate, interval))
    {
        if (truth.valid[i] == 0 || truth.valid[j] == 0)
        {
            continue;
        }
        NeesIncrement increment;
        increment.i = i;
        increment.j = j;
        const Eigen::Isometry3d T_estimate = estimate.poses[i].inverse() * estimate.poses[j];
        const Eigen::Isometry3d T_truth =
            (truth.poses[i] * T_truth_body).inverse() * (truth.poses[j] * T_truth_body);
        increment.error = se3Log(T_truth * T_estimate.inverse());
        increment.cov = definiteCovariance(estimate, i, j) + N + propagate(adjoint(T_truth), N);
        increment.nees = increment.error.dot(increment.cov.llt().solve(increment.error));
        out.push_back(increment);
    }
    return out;
}

NeesRun neesRun(
    const Trajectory& groundTruth,
    const Trajectory& estimate,
    const std::vector<NeesInterval>& intervals,
    const NeesOptions& options)
{
    NeesRun out;
    std::string names;
    std::size_t longest = 1;
    for (const NeesInterval& interval : intervals)
    {
        try
        {
            out.tested.push_back(
                {interval, neesIncrements(groundTruth, estimate, interval, options)});
            out.note =
                out.note.empty() ? noteOnUntold(estimate, out.tested.back().increments) : out.note;
        }
        catch (const UntoldCovariance&)
        {
            out.untold.push_back(interval);
            names += (names.empty() ? "" : ", ") + nameOf(interval);
            for (const auto& [i, j] : endsOf(estimate, interval))
            {
                longest = std::max(longest, interval.sinceStart ? 1 : posesBetween(estimate, i, j));
            }
        }
    }
    if (!out.untold.empty())
    {
        const std::string since = "pointplane-odometry --since " + std::to_string(longest);
        NeesInterval start;
        start.sinceStart = true;
        out.tested.push_back({start, neesIncrements(groundTruth, estimate, start, options)});
        out.note = "increments of " + names + " are not tested: '" + estimate.name +
                   "' does not tell their covariances, and the poses' covariances do not grow by "
                   "them. " +
                   (isMap(estimate) ? kMapTellsNone : "Write them by " + since) +
                   ". The poses are tested instead, each as the motion since the first one";
    }
    return out;
}
}  // namespace pointplane
