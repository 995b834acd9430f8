// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Statistics.h>
#include <pointplane/evaluation/association.h>
#include <pointplane/evaluation/coverage.h>

#include <cstdint>
#include <string>

namespace pointplane
{
/** What the distance between the two ends of a pair is measured in, along the estimate. */
enum class DeltaUnit
{
    Seconds,
    Metres,   //!< path length
    Radians,  //!< accumulated rotation
    Degrees,  //!< accumulated rotation
    Frames
};

/** From `s`, `m`, `rad`, `deg` or `f`. \throws std::invalid_argument for anything else */
[[nodiscard]] DeltaUnit deltaUnitFromName(const std::string& name);
[[nodiscard]] std::string nameOf(DeltaUnit unit);

/** The relative pose error of a pair (i, j), G ground truth and P estimate. */
enum class RpeFormula
{
    TumScript,  //!< inv(S(inv(P_j) P_i)) inv(G_j) G_i: what evaluate_rpe.py computes
    Evo         //!< inv(inv(G_i) G_j) S(inv(P_i) P_j): the TUM paper's formula, and evo's
};

/** Defaults are those of evaluate_rpe.py. */
struct RpeOptions
{
    bool fixedDelta{false};  //!< pairs a fixed delta apart, instead of all pairs
    double delta{1};
    DeltaUnit unit{DeltaUnit::Seconds};
    double offset{0};  //!< added to the estimate's stamps [s]
    double scale{1};   //!< S: multiplies the estimate's translations
    /** At most so many pairs, drawn at random; 0 = all. Applies to fixedDelta only if positive. */
    std::int64_t maxPairs{0};
    RpeFormula formula{RpeFormula::TumScript};
    TruthAt truthAt{TruthAt::NearestStamp};
    std::uint64_t seed{1};  //!< of the random draw
};

/** One evaluated pair of poses of the estimate. */
struct RpePair
{
    std::size_t i{0}, j{0};  //!< indices into the estimate
    double translation{0};   //!< [m]
    double rotation{0};      //!< [rad]
};

struct RpeResult
{
    Statistics translation;         //!< [m]
    Statistics rotation;            //!< [rad]
    std::size_t candidatePairs{0};  //!< before pairs without ground truth were dropped
    bool randomPairs{false};        //!< a random draw, not all of them
    /** Of a fixed delta: pairs whose distance differs from it by more than its half. */
    std::size_t pairsOffDelta{0};
    /** With ground truth that is a median interval or more away, as beyond its end. */
    std::size_t pairsOfOtherTime{0};
    Coverage coverage;
    std::vector<RpePair> pairs;  //!< empty when they were more than a million
};

/** Relative pose error by the protocol of the TUM benchmark's evaluate_rpe.py, whose figures it
 * reproduces (docs/evaluation.md says what it leaves to chance).
 * \throws std::runtime_error if the trajectories do not overlap, or fewer than two pairs have
 * ground truth at both ends \throws std::invalid_argument as checkOverlap(), and for a delta that
 * is no number */
[[nodiscard]] RpeResult relativePoseError(
    const Trajectory& groundTruth, const Trajectory& estimate, const RpeOptions& options);

/** "1 s": the distance between the poses of a pair. */
[[nodiscard]] std::string nameOfDelta(const RpeOptions& options);

/** The protocol as far as options tell it: formula, delta, ground truth. */
[[nodiscard]] std::string describe(const RpeOptions& options);

/** The protocol in one line, e.g. for a title: formula, delta, ground truth, pairs used. */
[[nodiscard]] std::string describe(const RpeOptions& options, const RpeResult& result);
}  // namespace pointplane
