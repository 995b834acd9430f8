// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/evaluation/rpe.h>
#include <pointplane/evaluation/scored_trajectories.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <stdexcept>

#include "PairError.h"
#include "rpe_pairs.h"

namespace pointplane
{
namespace
{
[[noreturn]] void failTooFewPairs(
    std::size_t used, std::size_t candidates, const SampledTruth& truth)
{
    throw std::runtime_error(
        "only " + std::to_string(used) + " of " + std::to_string(candidates) +
        " pairs have ground truth within " + std::to_string(truth.maxTimeDifference) +
        " s of both ends; at least two are needed (are these files of the same sequence?)");
}

void evaluateListed(
    const IndexPairs& pairs, const SampledTruth& truth, const PairError& error, RpeResult& result)
{
    result.candidatePairs = pairs.size();
    std::vector<double> translations;
    std::vector<double> rotations;
    for (const auto& [i, j] : pairs)
    {
        if (truth.valid[i] != 0 && truth.valid[j] != 0)
        {
            result.pairs.push_back({i, j, error.translation(i, j), error.rotation(i, j)});
            translations.push_back(result.pairs.back().translation);
            rotations.push_back(result.pairs.back().rotation);
            result.pairsOfOtherTime +=
                truth.isOfOtherTime[i] != 0 || truth.isOfOtherTime[j] != 0 ? 1 : 0;
        }
    }
    if (result.pairs.size() < 2)
    {
        failTooFewPairs(result.pairs.size(), pairs.size(), truth);
    }
    result.translation = statisticsOf(translations);
    result.rotation = statisticsOf(rotations);
}

/** Statistics of errorOf(i, j) over all ordered pairs of these poses, each with itself too. The
 * errors are computed twice and never stored, see StatisticsAccumulator. */
template <class ErrorOf>
Statistics statisticsOfAll(const std::vector<std::size_t>& poses, const ErrorOf& errorOf)
{
    StatisticsAccumulator accumulator;
    const auto forEachPair = [&](auto&& f)
    {
        for (const std::size_t i : poses)
        {
            for (const std::size_t j : poses)
            {
                f(errorOf(i, j));
            }
        }
    };
    forEachPair([&](double value) { accumulator.add(value); });
    accumulator.beginSecondPass();
    forEachPair([&](double value) { accumulator.addAgain(value); });
    return accumulator.result();
}

/** All pairs, as the script. */
void evaluateAll(const SampledTruth& truth, const PairError& error, RpeResult& result)
{
    std::vector<std::size_t> valid;
    std::size_t ofTheirTime = 0;
    for (std::size_t i = 0; i < truth.valid.size(); ++i)
    {
        if (truth.valid[i] != 0)
        {
            valid.push_back(i);
            ofTheirTime += truth.isOfOtherTime[i] == 0 ? 1 : 0;
        }
    }
    result.pairsOfOtherTime = valid.size() * valid.size() - ofTheirTime * ofTheirTime;
    result.candidatePairs = truth.valid.size() * truth.valid.size();
    if (valid.size() < 2)
    {
        failTooFewPairs(valid.size() * valid.size(), result.candidatePairs, truth);
    }
    constexpr std::size_t kKept = 1000;  // poses, whose pairs are a million
    if (valid.size() <= kKept)
    {
        for (const std::size_t i : valid)
        {
            for (const std::size_t j : valid)
            {
                result.pairs.push_back({i, j, error.translation(i, j), error.rotation(i, j)});
            }
        }
    }
    auto rotation = std::async(
        std::launch::async,
        [&]
        {
            return statisticsOfAll(
                valid, [&](std::size_t i, std::size_t j) { return error.rotation(i, j); });
        });
    result.translation = statisticsOfAll(
        valid, [&](std::size_t i, std::size_t j) { return error.translation(i, j); });
    result.rotation = rotation.get();
}

void evaluateFixedDelta(
    const Trajectory& estimate,
    const SampledTruth& truth,
    const PairError& error,
    const RpeOptions& options,
    std::size_t maxPairs,
    RpeResult& result)
{
    const std::vector<double> index = indexAlong(estimate, options.unit);
    IndexPairs pairs = fixedDeltaPairs(estimate, index, options);
    result.randomPairs = maxPairs > 0 && pairs.size() > maxPairs;
    if (result.randomPairs)
    {
        keepRandom(pairs, maxPairs, options.seed);
    }
    evaluateListed(pairs, truth, error, result);
    const auto isOff = [&](const RpePair& pair)
    { return std::abs(index[pair.j] - index[pair.i] - options.delta) > 0.5 * options.delta; };
    result.pairsOffDelta =
        static_cast<std::size_t>(std::count_if(result.pairs.begin(), result.pairs.end(), isOff));
    if (numWithThemselves(result) == result.pairs.size())
    {
        throw std::runtime_error(
            "delta " + nameOfDelta(options) +
            " is shorter than half the distance between poses, so each would be compared with "
            "itself");
    }
}
}  // namespace

RpeResult relativePoseError(
    const Trajectory& groundTruth, const Trajectory& estimate, const RpeOptions& options)
{
    POINTPLANE_CHECK(!std::isnan(options.delta), "delta is no number");
    checkOverlap(groundTruth, estimate, options.offset);
    checkPositions(groundTruth);
    checkPositions(estimate, options.scale);
    const SampledTruth truth =
        sampleTruth(groundTruth, estimate.stamps, options.offset, options.truthAt);
    const PairError error(truth.poses, estimate.poses, options.scale, options.formula);

    if (options.maxPairs == 1)
    {
        throw std::runtime_error(
            "only one pair was drawn (--max-pairs 1); at least two are needed");
    }
    RpeResult result;
    result.coverage = coverageOf(groundTruth, estimate, options.offset);
    const auto maxPairs = static_cast<std::size_t>(std::max<std::int64_t>(0, options.maxPairs));
    if (options.fixedDelta)
    {
        evaluateFixedDelta(estimate, truth, error, options, maxPairs, result);
    }
    else if (maxPairs == 0 || static_cast<double>(estimate.size()) < std::sqrt(maxPairs))
    {
        evaluateAll(truth, error, result);
    }
    else
    {
        result.randomPairs = true;
        evaluateListed(
            randomPairs(estimate.size(), options.maxPairs, options.seed), truth, error, result);
    }
    return result;
}
}  // namespace pointplane
