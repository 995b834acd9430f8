// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/evaluation/compare.h>
#include <pointplane/evaluation/stamp_intervals.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

namespace pointplane
{
namespace
{
std::vector<double> errorsOf(const RpeResult& result, double RpePair::*error)
{
    std::vector<double> out;
    for (const RpePair& pair : result.pairs)
    {
        out.push_back(pair.*error);
    }
    return out;
}

/** Pairs whose errors are alike because they overlap: as many as start within one of them. If they
 * were drawn, these are fewer than the frames between its ends. */
std::size_t blockLengthOf(const RpeResult& result)
{
    const std::vector<RpePair>& pairs = result.pairs;
    const auto firstFrom = [&](std::size_t frame)
    {
        const auto isBefore = [](const RpePair& pair, std::size_t f) { return pair.i < f; };
        return std::lower_bound(pairs.begin(), pairs.end(), frame, isBefore);
    };
    std::vector<double> frames;
    std::vector<double> starts;
    for (const RpePair& pair : pairs)
    {
        const std::size_t end = std::max(pair.i, pair.j);
        frames.push_back(static_cast<double>(end - pair.i));
        if (end <= pairs.back().i)  // else not all that would start within it are there
        {
            starts.push_back(static_cast<double>(firstFrom(end) - firstFrom(pair.i)));
        }
    }
    const double median = statisticsOf(starts.empty() ? frames : starts).median;
    return std::max<std::size_t>(1, static_cast<std::size_t>(median));
}

using Stamps = std::vector<double>;

/** Stamps by which frames of different runs are told to be the same: for those that differ as
 * rounding to four digits makes them, the earliest of them. One list per run. */
std::vector<Stamps> frameStampsOf(const std::vector<Trajectory>& estimates)
{
    double tolerance = 1e-4;
    Stamps all;
    for (const Trajectory& estimate : estimates)
    {
        tolerance = std::min(tolerance, 0.1 * medianInterval(estimate.stamps));
        all.insert(all.end(), estimate.stamps.begin(), estimate.stamps.end());
    }
    std::sort(all.begin(), all.end());
    Stamps first;
    for (const double stamp : all)
    {
        if (first.empty() || stamp - first.back() > tolerance)
        {
            first.push_back(stamp);
        }
    }
    std::vector<Stamps> out;
    for (const Trajectory& estimate : estimates)
    {
        out.emplace_back();
        for (const double stamp : estimate.stamps)
        {
            out.back().push_back(*std::prev(std::upper_bound(first.begin(), first.end(), stamp)));
        }
    }
    return out;
}

struct CommonErrors
{
    std::vector<double> a, b;
};

/** Errors of the pairs of stamps that both runs have, in time order. */
CommonErrors commonErrors(
    const Stamps& stampsA,
    const RpeResult& a,
    const Stamps& stampsB,
    const RpeResult& b,
    double RpePair::*error)
{
    std::map<std::pair<double, double>, double> byStamps;
    for (const RpePair& pair : b.pairs)
    {
        byStamps[{stampsB[pair.i], stampsB[pair.j]}] = pair.*error;
    }
    CommonErrors out;
    for (const RpePair& pair : a.pairs)
    {
        const auto found = byStamps.find({stampsA[pair.i], stampsA[pair.j]});
        if (found != byStamps.end())
        {
            out.a.push_back(pair.*error);
            out.b.push_back(found->second);
        }
    }
    return out;
}

using StampPair = std::pair<double, double>;

std::set<StampPair> stampPairsOf(const Stamps& stamps, const RpeResult& result)
{
    std::set<StampPair> out;
    for (const RpePair& pair : result.pairs)
    {
        out.emplace(stamps[pair.i], stamps[pair.j]);
    }
    return out;
}

/** Pairs of stamps that all runs have. */
std::set<StampPair> commonPairs(
    const std::vector<Stamps>& stamps, const std::vector<ComparedRun>& runs)
{
    std::set<StampPair> out = stampPairsOf(stamps[0], runs[0].rpe);
    for (std::size_t k = 1; k < runs.size(); ++k)
    {
        const std::set<StampPair> own = stampPairsOf(stamps[k], runs[k].rpe);
        std::set<StampPair> both;
        std::set_intersection(
            out.begin(), out.end(), own.begin(), own.end(), std::inserter(both, both.end()));
        out = std::move(both);
    }
    return out;
}

/** The result without all other pairs. */
RpeResult ofPairs(const std::set<StampPair>& pairs, const Stamps& stamps, RpeResult result)
{
    const auto isOther = [&](const RpePair& pair) {
        return pairs.count({stamps[pair.i], stamps[pair.j]}) == 0;
    };
    result.pairs.erase(
        std::remove_if(result.pairs.begin(), result.pairs.end(), isOther), result.pairs.end());
    return result;
}

/** Stamps of the poses whose error ATE is. */
Stamps ateStamps(const Stamps& stamps, const AteResult& result)
{
    Stamps out;
    for (const AteError& error : result.errors)
    {
        out.push_back(stamps[error.estimate]);
    }
    std::sort(out.begin(), out.end());
    return out;
}

bool haveSameAteFrames(const std::vector<Stamps>& stamps, const std::vector<ComparedRun>& runs)
{
    for (std::size_t k = 1; k < runs.size(); ++k)
    {
        if (ateStamps(stamps[k], runs[k].ate) != ateStamps(stamps[0], runs[0].ate))
        {
            return false;
        }
    }
    return true;
}

std::vector<ComparedRun> scoredAlone(
    const Trajectory& groundTruth,
    const std::vector<Trajectory>& estimates,
    const RpeOptions& rpe,
    const AteOptions& ate)
{
    std::vector<ComparedRun> out;
    for (const Trajectory& estimate : estimates)
    {
        ComparedRun run;
        run.name = estimate.name;
        run.rpe = relativePoseError(groundTruth, estimate, rpe);
        run.ate = absoluteTrajectoryError(groundTruth, estimate, ate);
        out.push_back(std::move(run));
    }
    return out;
}

bool haveSameBody(const std::vector<Trajectory>& estimates)
{
    const auto isOfOne = [&](Body body)
    {
        return std::any_of(
            estimates.begin(),
            estimates.end(),
            [body](const Trajectory& estimate) { return estimate.body == body; });
    };
    return !isOfOne(Body::Camera) || !isOfOne(Body::Robot);
}

template <class Value>
std::size_t smallest(const std::vector<ComparedRun>& runs, Value value)
{
    const auto best = std::min_element(
        runs.begin(),
        runs.end(),
        [&](const ComparedRun& a, const ComparedRun& b) { return value(a) < value(b); });
    return static_cast<std::size_t>(best - runs.begin());
}

void chooseBest(const std::vector<Stamps>& stamps, Comparison& out)
{
    out.bestTranslation = smallest(out.runs, [](const auto& r) { return r.translation.value; });
    out.bestRotation = smallest(out.runs, [](const auto& r) { return r.rotation.value; });
    if (out.runs.size() > 1 && out.sameBodies && haveSameAteFrames(stamps, out.runs))
    {
        out.bestAte = smallest(out.runs, [](const auto& r) { return r.ate.translation.rmse; });
    }
}
}  // namespace

Comparison compareRuns(
    const Trajectory& groundTruth,
    const std::vector<Trajectory>& estimates,
    const RpeOptions& rpe,
    const AteOptions& ate,
    BootstrapOptions options)
{
    POINTPLANE_CHECK(rpe.fixedDelta, "runs are compared over pairs a fixed delta apart");
    POINTPLANE_CHECK(!estimates.empty(), "no runs to compare");
    Comparison out;
    out.runs = scoredAlone(groundTruth, estimates, rpe, ate);
    out.sameBodies = haveSameBody(estimates);
    const std::vector<Stamps> stamps = frameStampsOf(estimates);
    const std::set<StampPair> common = commonPairs(stamps, out.runs);
    out.numCommonPairs = common.size();
    std::vector<RpeResult> scored;
    for (std::size_t k = 0; k < estimates.size(); ++k)
    {
        ComparedRun& run = out.runs[k];
        out.sameFrames = out.sameFrames && run.rpe.pairs.size() == common.size();
        scored.push_back(common.size() >= 2 ? ofPairs(common, stamps[k], run.rpe) : run.rpe);
        options.blockLength = blockLengthOf(scored[k]);
        run.translation = bootstrapRmse(errorsOf(scored[k], &RpePair::translation), options);
        run.rotation = bootstrapRmse(errorsOf(scored[k], &RpePair::rotation), options);
    }
    chooseBest(stamps, out);
    const auto behind = [&](std::size_t k,
                            std::size_t best,
                            double RpePair::*error) -> std::optional<BootstrapInterval>
    {
        if (k == best || !out.isComparable())
        {
            return std::nullopt;
        }
        const CommonErrors both =
            commonErrors(stamps[k], scored[k], stamps[best], scored[best], error);
        options.blockLength = blockLengthOf(scored[k]);
        return bootstrapRmseDifference(both.a, both.b, options);
    };
    for (std::size_t k = 0; k < out.runs.size(); ++k)
    {
        out.runs[k].rotationBehindBest = behind(k, out.bestRotation, &RpePair::rotation);
        out.runs[k].translationBehindBest = behind(k, out.bestTranslation, &RpePair::translation);
    }
    return out;
}
}  // namespace pointplane
