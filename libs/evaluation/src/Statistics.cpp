// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/Statistics.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace pointplane
{
namespace
{
constexpr int kMantissaBits = 8;  // bins are 0.4 % wide
constexpr int kShift = 52 - kMantissaBits;
constexpr std::size_t kNumBins = std::size_t{1} << (11 + kMantissaBits);

std::size_t binOf(double value)
{
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return static_cast<std::size_t>(bits >> kShift) & (kNumBins - 1);
}
}  // namespace

StatisticsAccumulator::StatisticsAccumulator() : bins_(kNumBins, 0) {}

void StatisticsAccumulator::add(double value)
{
    if (!std::isfinite(value) || value < 0)
    {
        throw std::runtime_error("an error value is not a finite non-negative number");
    }
    if (count_ == 0)
    {
        shift_ = min_ = max_ = value;
    }
    ++count_;
    sum_ += value;
    sumOfSquares_ += value * value;
    const double centred = value - shift_;  // keeps the variance exact for nearly equal values
    shiftedSquares_ += centred * centred;
    shiftedSum_ += centred;
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
    ++bins_[binOf(value)];
}

std::size_t StatisticsAccumulator::binOfRank(std::size_t rank, std::size_t& before) const
{
    before = 0;
    std::size_t bin = 0;
    while (before + bins_[bin] <= rank)
    {
        before += bins_[bin++];
    }
    return bin;
}

void StatisticsAccumulator::beginSecondPass()
{
    if (count_ == 0)
    {
        throw std::runtime_error("no values to compute statistics of");
    }
    std::size_t ignored = 0;
    lowBin_ = binOfRank((count_ - 1) / 2, beforeLow_);
    highBin_ = binOfRank(count_ / 2, ignored);
    middle_.clear();
    middle_.reserve(bins_[lowBin_] + (highBin_ != lowBin_ ? bins_[highBin_] : 0));
}

void StatisticsAccumulator::addAgain(double value)
{
    const std::size_t bin = binOf(value);
    if (bin == lowBin_ || bin == highBin_)
    {
        middle_.push_back(value);
    }
}

Statistics StatisticsAccumulator::result() const
{
    std::vector<double> middle = middle_;
    const auto valueOfRank = [&](std::size_t rank)
    {
        const auto nth = middle.begin() + static_cast<std::ptrdiff_t>(rank - beforeLow_);
        std::nth_element(middle.begin(), nth, middle.end());
        return *nth;
    };
    const double n = static_cast<double>(count_);
    Statistics out;
    out.count = count_;
    out.rmse = std::sqrt(sumOfSquares_ / n);
    out.mean = sum_ / n;
    out.median = 0.5 * (valueOfRank((count_ - 1) / 2) + valueOfRank(count_ / 2));
    const double shiftedMean = shiftedSum_ / n;
    out.std = std::sqrt(std::max(0.0, shiftedSquares_ / n - shiftedMean * shiftedMean));
    out.min = min_;
    out.max = max_;
    return out;
}

Statistics statisticsOf(const std::vector<double>& values)
{
    StatisticsAccumulator accumulator;
    std::for_each(values.begin(), values.end(), [&](double v) { accumulator.add(v); });
    accumulator.beginSecondPass();
    std::for_each(values.begin(), values.end(), [&](double v) { accumulator.addAgain(v); });
    return accumulator.result();
}

Statistics scaled(const Statistics& statistics, double factor)
{
    Statistics out = statistics;
    for (double* value : {&out.rmse, &out.mean, &out.median, &out.std, &out.min, &out.max})
    {
        *value *= factor;
    }
    return out;
}
}  // namespace pointplane
