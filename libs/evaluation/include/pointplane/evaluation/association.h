// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>

#include <utility>
#include <vector>

namespace pointplane
{
/** Index of the value nearest to `value` in a sorted list. It bisects as evaluate_rpe.py does, so
 * of two equally near values it returns the same one. \throws std::invalid_argument if the list is
 * empty */
[[nodiscard]] std::size_t nearestIndex(const std::vector<double>& sorted, double value);

/** One-to-one pairs of indices into two sorted lists of stamps, as associate.py: of all pairs with
 * |first - (second + offset)| < maxDifference the nearest are taken first. Ordered by the first. */
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> associate(
    const std::vector<double>& first,
    const std::vector<double>& second,
    double offset,
    double maxDifference);

/** How ground truth is taken at an estimate's stamp. */
enum class TruthAt
{
    NearestStamp,  //!< as evaluate_rpe.py
    Interpolated   //!< translation linearly, rotation by slerp; never extrapolated
};

/** Ground truth at the stamps of an estimate. */
struct SampledTruth
{
    std::vector<Eigen::Isometry3d> poses;  //!< one per stamp; identity where not valid
    std::vector<char> valid;               //!< 1 where ground truth is near enough
    std::vector<char> isOfOtherTime;       //!< 1 where it is a median interval or more away
    std::vector<double> stamps;            //!< of the ground truth used [s]
    double maxTimeDifference{0};           //!< the bound that decided [s]
};

/** Ground truth at stamps + offset. A stamp is valid when the nearest ground-truth stamp is not
 * farther than twice the median ground-truth interval (evaluate_rpe.py) and, for interpolation,
 * inside the ground truth's time range and in none of its holesBefore(). */
[[nodiscard]] SampledTruth sampleTruth(
    const Trajectory& groundTruth,
    const std::vector<double>& stamps,
    double offset,
    TruthAt at = TruthAt::NearestStamp);
}  // namespace pointplane
