// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/rpe.h>

#include <algorithm>
#include <stdexcept>

#include "rpe_pairs.h"
#include "short_number.h"

namespace pointplane
{
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

std::string nameOfDelta(const RpeOptions& options)
{
    return shortNumber(options.delta) + " " + nameOf(options.unit);
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
    const std::string counts =
        ", " + std::to_string(result.translation.count) + " of " +
        std::to_string(result.candidatePairs) + " pairs" +
        (result.randomPairs ? " drawn with seed " + std::to_string(options.seed) : "");
    const std::size_t alone = options.fixedDelta ? numWithThemselves(result) : 0;
    const std::size_t off = result.pairsOffDelta - std::min(alone, result.pairsOffDelta);
    return describe(options) + counts +
           (alone > 0 ? ", " + std::to_string(alone) +
                            " of a pose with itself, as nothing is at its delta"
                      : "") +
           (off > 0 ? ", " + std::to_string(off) + " off by more than half of delta" : "") +
           (result.pairsOfOtherTime > 0 ? ", " + std::to_string(result.pairsOfOtherTime) +
                                              " with ground truth an interval or more away"
                                        : "");
}
}  // namespace pointplane
