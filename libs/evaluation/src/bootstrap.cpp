// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/evaluation/bootstrap.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace pointplane
{
namespace
{
double rmse(const std::vector<double>& errors)
{
    double squares = 0;
    for (const double e : errors)
    {
        squares += e * e;
    }
    return std::sqrt(squares / static_cast<double>(errors.size()));
}

/** Sums of squares of the blocks that start at each error, by one running sum. */
class BlockSums
{
 public:
    BlockSums(const std::vector<double>& errors, std::size_t length) : length_(length), sums_{0}
    {
        for (std::size_t k = 0; k < errors.size() + length; ++k)
        {
            const double e = errors[k % errors.size()];
            sums_.push_back(sums_.back() + e * e);
        }
    }
    [[nodiscard]] double operator()(std::size_t start) const
    {
        return sums_[start + length_] - sums_[start];
    }

 private:
    std::size_t length_;
    std::vector<double> sums_;
};

/** How much wider an interval of so many blocks is than their spread tells: they are few to tell
 * it, and resampled they spread less. Student's t for 95 % over the normal distribution's
 * (Abramowitz and Stegun 26.7.5), and Bessel's correction. */
double widening(std::size_t numBlocks)
{
    const double dof = static_cast<double>(numBlocks) - 1;
    const double t = 1 + (1.21 + (1.44 + 1.30 / dof) / dof) / dof;
    return t * std::sqrt((dof + 1) / dof);
}

/** Percentile interval of statistic(starts of the drawn blocks). */
template <class Statistic>
BootstrapInterval interval(
    std::size_t n, const BootstrapOptions& options, double value, Statistic statistic)
{
    POINTPLANE_CHECK(n >= 2, "a bootstrap of " << n << " values");
    POINTPLANE_CHECK(options.resamples >= 2, "a bootstrap of " << options.resamples << " samples");
    const std::size_t length = std::clamp<std::size_t>(options.blockLength, 1, n);
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    BootstrapInterval out{value, kNaN, kNaN, n / length};
    if (!out.isKnown())
    {
        return out;
    }
    const std::size_t blocks = (n + length - 1) / length;
    std::mt19937_64 random(options.seed);
    std::vector<double> samples;
    std::vector<std::size_t> starts(blocks);
    for (std::size_t k = 0; k < options.resamples; ++k)
    {
        for (std::size_t& start : starts)
        {
            start = static_cast<std::size_t>(random() % n);
        }
        samples.push_back(statistic(starts));
    }
    std::sort(samples.begin(), samples.end());
    const double tail = 0.5 * (1 - options.confidence);
    const auto last = static_cast<double>(samples.size() - 1);
    const double lower = samples[static_cast<std::size_t>(std::floor(tail * last))];
    const double upper = samples[static_cast<std::size_t>(std::ceil((1 - tail) * last))];
    out.lower = value + widening(out.independent) * (lower - value);
    out.upper = value + widening(out.independent) * (upper - value);
    return out;
}

double rmseOfBlocks(
    const BlockSums& sums, const std::vector<std::size_t>& starts, std::size_t length)
{
    double squares = 0;
    for (const std::size_t start : starts)
    {
        squares += sums(start);
    }
    return std::sqrt(std::max(0.0, squares) / static_cast<double>(starts.size() * length));
}
}  // namespace

BootstrapInterval bootstrapRmse(const std::vector<double>& errors, const BootstrapOptions& options)
{
    POINTPLANE_CHECK(errors.size() >= 2, "a bootstrap of " << errors.size() << " values");
    const std::size_t length = std::clamp<std::size_t>(options.blockLength, 1, errors.size());
    const BlockSums sums(errors, length);
    BootstrapInterval out = interval(
        errors.size(),
        options,
        rmse(errors),
        [&](const auto& starts) { return rmseOfBlocks(sums, starts, length); });
    out.lower = out.lower < 0 ? 0 : out.lower;  // NaN stays
    return out;
}

BootstrapInterval bootstrapRmseDifference(
    const std::vector<double>& a, const std::vector<double>& b, const BootstrapOptions& options)
{
    POINTPLANE_CHECK(a.size() == b.size(), a.size() << " errors against " << b.size());
    POINTPLANE_CHECK(a.size() >= 2, "a bootstrap of " << a.size() << " values");
    const std::size_t length = std::clamp<std::size_t>(options.blockLength, 1, a.size());
    const BlockSums sumsA(a, length);
    const BlockSums sumsB(b, length);
    return interval(
        a.size(),
        options,
        rmse(a) - rmse(b),
        [&](const auto& starts)
        { return rmseOfBlocks(sumsA, starts, length) - rmseOfBlocks(sumsB, starts, length); });
}
}  // namespace pointplane
