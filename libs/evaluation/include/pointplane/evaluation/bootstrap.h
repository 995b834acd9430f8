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
    /** Neighbouring errors of a trajectory are alike, so whole blocks of so many are drawn (moving
     * block bootstrap, Kuensch 1989); 1 would give intervals that are far too narrow. */
    std::size_t blockLength{1};
    double confidence{0.95};
    std::uint64_t seed{1};
};

/** A value and its percentile bootstrap interval. */
struct BootstrapInterval
{
    double value{0};
    double lower{0}, upper{0};
    [[nodiscard]] bool excludesZero() const { return lower > 0 || upper < 0; }
};

/** RMSE of `errors` (in time order) with its interval. Needs at least two errors. */
[[nodiscard]] BootstrapInterval bootstrapRmse(
    const std::vector<double>& errors, const BootstrapOptions& options);

/** RMSE(a) - RMSE(b) of two runs whose errors belong together one by one (the same pairs of stamps,
 * in time order): both are resampled alike, so what both have in common cancels. */
[[nodiscard]] BootstrapInterval bootstrapRmseDifference(
    const std::vector<double>& a, const std::vector<double>& b, const BootstrapOptions& options);
}  // namespace pointplane
