// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "lab_runs.h"
#include "reproduce_plan.h"

namespace pointplane
{
/** All scores of `reproduce`. */
struct Reproduction
{
    RpeOptions rpe;
    std::vector<ReproducedSequence> sequences;
    std::vector<Trajectory> truths;  //!< one each
    std::vector<Variant> variants;
    std::vector<LabScore> scores;         //!< of sequence s, variant v: [s * variants.size() + v]
    std::vector<Variant> cornerVariants;  //!< of the simulated corner
    std::vector<LabScore> cornerScores;   //!< one each
    Trajectory cornerTruth;

    /** The score of a variant, or nullptr when there is no such variant or the run failed. */
    [[nodiscard]] const LabScore* score(
        std::size_t sequence, const std::string& group, const std::string& name) const;

    /** Score as text, or "-" when there is no such variant or sequence. */
    [[nodiscard]] std::string text(
        std::size_t sequence, const std::string& group, const std::string& name) const;
};

/** Of the last position in the corner [m]. \param corner number of a scored variant */
[[nodiscard]] double finalError(const Reproduction& result, std::size_t corner);

/** "fr1/desk", or "fr1/desk (part)". */
[[nodiscard]] std::string displayName(const ReproducedSequence& sequence);
}  // namespace pointplane
