// SPDX-License-Identifier: BSD-3-Clause
#include "rpe_pairs.h"

#include <pointplane/evaluation/association.h>
#include <pointplane/evaluation/units.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <stdexcept>

#include "short_number.h"

namespace pointplane
{
namespace
{
/** Modulo instead of std::uniform_int_distribution, whose values differ between libraries. */
std::size_t draw(std::mt19937_64& random, std::size_t n)
{
    return static_cast<std::size_t>(random() % n);
}

void requireTwo(
    const Trajectory& estimate,
    const std::vector<double>& index,
    const IndexPairs& pairs,
    const RpeOptions& options)
{
    if (pairs.size() < 2)
    {
        throw std::runtime_error(
            "'" + estimate.name + "' covers " + shortNumber(index.back() - index.front(), 3) + " " +
            nameOf(options.unit) + ": fewer than two pairs of poses are " + nameOfDelta(options) +
            " apart (those with the last pose do not count); choose a smaller delta");
    }
}
}  // namespace

std::vector<double> indexAlong(const Trajectory& estimate, DeltaUnit unit)
{
    switch (unit)
    {
        case DeltaUnit::Metres:
            return pathLengths(estimate);
        case DeltaUnit::Radians:
            return accumulatedAngles(estimate);
        case DeltaUnit::Degrees:
        {
            std::vector<double> angles = accumulatedAngles(estimate);
            for (double& angle : angles)
            {
                angle *= kDegreesPerRadian;
            }
            return angles;
        }
        case DeltaUnit::Frames:
        {
            std::vector<double> frames(estimate.size());
            std::iota(frames.begin(), frames.end(), 0.0);
            return frames;
        }
        case DeltaUnit::Seconds:
            break;
    }
    return estimate.stamps;
}

IndexPairs fixedDeltaPairs(
    const Trajectory& estimate, const std::vector<double>& index, const RpeOptions& options)
{
    IndexPairs pairs;
    for (std::size_t i = 0; i < index.size(); ++i)
    {
        const std::size_t j = nearestIndex(index, index[i] + options.delta);
        if (j != index.size() - 1)  // may be i itself, over gaps: so does the script
        {
            pairs.emplace_back(i, j);
        }
    }
    requireTwo(estimate, index, pairs, options);
    return pairs;
}

void keepRandom(IndexPairs& pairs, std::size_t keep, std::uint64_t seed)
{
    std::mt19937_64 random(seed);
    for (std::size_t k = 0; k < keep; ++k)
    {
        std::swap(pairs[k], pairs[k + draw(random, pairs.size() - k)]);
    }
    pairs.resize(keep);
    std::sort(pairs.begin(), pairs.end());
}

IndexPairs randomPairs(std::size_t n, std::int64_t count, std::uint64_t seed)
{
    std::mt19937_64 random(seed);
    IndexPairs pairs;
    for (std::int64_t k = 0; k < count; ++k)
    {
        const std::size_t i = draw(random, n);
        pairs.emplace_back(i, draw(random, n));
    }
    return pairs;
}

std::size_t numWithThemselves(const RpeResult& result)
{
    const auto isOfOnePose = [](const RpePair& pair) { return pair.i == pair.j; };
    return static_cast<std::size_t>(
        std::count_if(result.pairs.begin(), result.pairs.end(), isOfOnePose));
}
}  // namespace pointplane
