// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace pointplane
{
/** The statistics that the TUM scripts print, in the unit of the values. */
struct Statistics
{
    std::size_t count{0};
    double rmse{0};
    double mean{0};
    double median{0};  //!< mean of the two middle values for an even count
    double std{0};     //!< population standard deviation (divides by n), as numpy
    double min{0};
    double max{0};
};

/** Exact statistics of values that are not stored: they are given twice, in any order. It needs 8
 * MB whatever their number, so the 10^8 pairs of 10,000 poses fit in any memory.
 *
 * The median is found by radix selection. The bits of non-negative doubles are ordered as the
 * doubles are. So the first pass counts values by their leading bits, and the second collects only
 * those of the one or two bins that hold the middle. */
class StatisticsAccumulator
{
 public:
    StatisticsAccumulator();
    /** First pass. \param value non-negative \throws std::runtime_error for NaN and infinity */
    void add(double value);
    /** Ends the first pass. \throws std::runtime_error if there was no value */
    void beginSecondPass();
    /** Second pass: the same values again. */
    void addAgain(double value);
    [[nodiscard]] Statistics result() const;

 private:
    std::size_t binOfRank(std::size_t rank, std::size_t& before) const;

    std::vector<std::uint64_t> bins_;
    std::vector<double> middle_;
    std::size_t lowBin_{0}, highBin_{0}, beforeLow_{0};
    std::size_t count_{0};
    double sum_{0}, sumOfSquares_{0}, shiftedSum_{0}, shiftedSquares_{0}, shift_{0};
    double min_{0}, max_{0};
};

/** Statistics of non-negative values. \throws std::runtime_error if there is none, or one that is
 * not finite */
[[nodiscard]] Statistics statisticsOf(const std::vector<double>& values);

/** Statistics with every value multiplied by `factor` (e.g. rad to deg). */
[[nodiscard]] Statistics scaled(const Statistics& statistics, double factor);
}  // namespace pointplane
