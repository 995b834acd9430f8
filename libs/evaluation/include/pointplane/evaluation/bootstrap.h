// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace pointplane
{
struct BootstrapOptions
{
    std::size_t resamples{2000};
    /** So many neighbouring errors are drawn together, because they are alike (circular block
     * bootstrap, Politis and Romano 1992: the last is followed by the first, so all are drawn alike
     * often). With 1, intervals of a trajectory would be far too narrow. */
    std::size_t blockLength{1};
    double confidence{0.95};
    std::uint64_t seed{1};
};

/** A value and its percentile bootstrap interval. */
struct BootstrapInterval
{
    double value{0};
    double lower{0}, upper{0};   //!< NaN if there is no interval
    std::size_t independent{0};  //!< blocks that the errors fill one after the other

    static constexpr std::size_t kLeastIndependent = 4;
    /** Fewer blocks hardly differ from sample to sample: their interval would be too narrow. */
    [[nodiscard]] bool isKnown() const { return independent >= kLeastIndependent; }
    [[nodiscard]] bool excludesZero() const { return lower > 0 || upper < 0; }
};

/** RMSE of `errors` (in time order) with its interval.
 * \throws std::invalid_argument for fewer than two errors */
[[nodiscard]] BootstrapInterval bootstrapRmse(
    const std::vector<double>& errors, const BootstrapOptions& options);

/** RMSE(a) - RMSE(b) of two runs with its interval. Both are resampled alike, so what they have in
 * common cancels.
 * \param a, b errors of the same pairs of stamps, in time order
 * \throws std::invalid_argument for fewer than two errors, or if their numbers differ */
[[nodiscard]] BootstrapInterval bootstrapRmseDifference(
    const std::vector<double>& a, const std::vector<double>& b, const BootstrapOptions& options);
}  // namespace pointplane
