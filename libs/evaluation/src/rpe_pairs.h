// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/rpe.h>

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace pointplane
{
/** @name Which poses of the estimate are compared with each other
 * @{ */

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/** The estimate's poses in the unit of delta. */
[[nodiscard]] std::vector<double> indexAlong(const Trajectory& estimate, DeltaUnit unit);

/** The drift per second of [P17, section Experiments], if delta is one second.
 * \param index of indexAlong() \throws std::runtime_error if there are fewer than two pairs */
[[nodiscard]] IndexPairs fixedDeltaPairs(
    const Trajectory& estimate, const std::vector<double>& index, const RpeOptions& options);

/** Any two of n poses. \param count of pairs */
[[nodiscard]] IndexPairs randomPairs(std::size_t n, std::int64_t count, std::uint64_t seed);

/** Leaves a random draw of so many, in their order. */
void keepRandom(IndexPairs& pairs, std::size_t keep, std::uint64_t seed);

/** Pairs of a pose with itself: their error is 0, whatever the estimate. */
[[nodiscard]] std::size_t numWithThemselves(const RpeResult& result);
/** @} */
}  // namespace pointplane
