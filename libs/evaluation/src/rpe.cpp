// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/rpe.h>
#include <pointplane/evaluation/scored_trajectories.h>
#include <pointplane/evaluation/units.h>

#include <cstdio>
#include <future>
#include <numeric>
#include <random>
#include <stdexcept>

#include "PairError.h"

namespace pointplane
{
namespace
{
/** The estimate's poses in the unit of delta. */
std::vector<double> indexOf(const Trajectory& estimate, DeltaUnit unit)
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

using IndexPairs = std::vector<std::pair<std::size_t, std::size_t>>;

/** The drift per second of [P17, section Experiments], if delta is one second.
 * \param index the poses in the unit of delta */
IndexPairs fixedDeltaPairs(const std::vector<double>& index, const RpeOptions& options)
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
    return pairs;
}

/** Modulo instead of std::uniform_int_distribution, whose values differ between libraries. */
std::size_t draw(std::mt19937_64& random, std::size_t n)
{
    return static_cast<std::size_t>(random() % n);
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

[[noreturn]] void failTooFewPairs(
    std::size_t used, std::size_t candidates, const SampledTruth& truth)
{
    throw std::runtime_error(
        "only " + std::to_string(used) + " of " + std::to_string(candidates) +
        " pairs have ground truth within " + std::to_string(truth.maxTimeDifference) +
        " s of both ends; at least two are needed (are these files of the same sequence?)");
}

/** \param index the poses in the unit of delta */
void checkLength(
    const Trajectory& estimate,
    const std::vector<double>& index,
    const IndexPairs& pairs,
    const RpeOptions& options)
{
    if (pairs.size() < 2)
    {
        char length[32];
        std::snprintf(length, sizeof length, "%.3g ", index.back() - index.front());
        throw std::runtime_error(
            "'" + estimate.name + "' covers " + length + nameOf(options.unit) +
            ": fewer than two pairs of poses are " + nameOfDelta(options) +
            " apart; choose a smaller delta");
    }
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

/** Their error is 0, whatever the estimate. */
[[nodiscard]] std::size_t numWithThemselves(const RpeResult& result)
{
    const auto isOfOnePose = [](const RpePair& pair) { return pair.i == pair.j; };
    return static_cast<std::size_t>(
        std::count_if(result.pairs.begin(), result.pairs.end(), isOfOnePose));
}
}  // namespace

DeltaUnit deltaUnitFromName(const std::string& name)
{
    for (const DeltaUnit unit :
         {DeltaUnit::Seconds,
          DeltaUnit::Metres,
          DeltaUnit::Radians,
          DeltaUnit::Degrees,
          DeltaUnit::Frames})
    {
        if (nameOf(unit) == name)
        {
            return unit;
        }
    }
    throw std::invalid_argument("unknown delta unit '" + name + "'; one of s, m, rad, deg, f");
}

std::string nameOf(DeltaUnit unit)
{
    switch (unit)
    {
        case DeltaUnit::Metres:
            return "m";
        case DeltaUnit::Radians:
            return "rad";
        case DeltaUnit::Degrees:
            return "deg";
        case DeltaUnit::Frames:
            return "f";
        case DeltaUnit::Seconds:
            break;
    }
    return "s";
}

RpeResult relativePoseError(
    const Trajectory& groundTruth, const Trajectory& estimate, const RpeOptions& options)
{
    checkOverlap(groundTruth, estimate, options.offset);
    checkPositions(groundTruth);
    checkPositions(estimate, options.scale);
    const SampledTruth truth =
        sampleTruth(groundTruth, estimate.stamps, options.offset, options.truthAt);
    const PairError error(truth.poses, estimate.poses, options.scale, options.formula);

    RpeResult result;
    result.coverage = coverageOf(groundTruth, estimate, options.offset);
    const auto maxPairs = static_cast<std::size_t>(std::max<std::int64_t>(0, options.maxPairs));
    if (options.fixedDelta)
    {
        const std::vector<double> index = indexOf(estimate, options.unit);
        IndexPairs pairs = fixedDeltaPairs(index, options);
        checkLength(estimate, index, pairs, options);
        result.randomPairs = maxPairs > 0 && pairs.size() > maxPairs;
        if (result.randomPairs)
        {
            keepRandom(pairs, maxPairs, options.seed);
        }
        evaluateListed(pairs, truth, error, result);
        const auto isOff = [&](const RpePair& pair)
        { return std::abs(index[pair.j] - index[pair.i] - options.delta) > 0.5 * options.delta; };
        result.pairsOffDelta = static_cast<std::size_t>(
            std::count_if(result.pairs.begin(), result.pairs.end(), isOff));
        if (numWithThemselves(result) == result.pairs.size())
        {
            throw std::runtime_error(
                "delta " + nameOfDelta(options) +
                " is shorter than half the distance between poses, so each would be compared with "
                "itself");
        }
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

std::string nameOfDelta(const RpeOptions& options)
{
    char text[64];
    std::snprintf(text, sizeof text, "%g %s", options.delta, nameOf(options.unit).c_str());
    return text;
}

std::string describe(const RpeOptions& options)
{
    const std::string delta =
        options.fixedDelta ? "fixed delta " + nameOfDelta(options) : "all ordered pairs";
    const bool script = options.formula == RpeFormula::TumScript;
    const bool nearest = options.truthAt == TruthAt::NearestStamp;
    return std::string(script ? "TUM protocol (evaluate_rpe), " : "evo's formula, ") + delta +
           ", ground truth " + (nearest ? "at the nearest stamp" : "interpolated") +
           describeChanges(options.offset, options.scale);
}

std::string describe(const RpeOptions& options, const RpeResult& result)
{
    char counts[160];
    std::snprintf(
        counts,
        sizeof counts,
        ", %zu of %zu pairs%s, ",
        result.translation.count,
        result.candidatePairs,
        result.randomPairs ? (" drawn with seed " + std::to_string(options.seed)).c_str() : "");
    const std::size_t alone = options.fixedDelta ? numWithThemselves(result) : 0;
    const std::size_t off = result.pairsOffDelta - std::min(alone, result.pairsOffDelta);
    return describe(options) + counts +
           (alone > 0
                ? std::to_string(alone) + " of a pose with itself, as nothing is at its delta, "
                : "") +
           (off > 0 ? std::to_string(off) + " off by more than half of delta, " : "") +
           (result.pairsOfOtherTime > 0 ? std::to_string(result.pairsOfOtherTime) +
                                              " with ground truth an interval or more away, "
                                        : "") +
           describe(result.coverage);
}
}  // namespace pointplane
