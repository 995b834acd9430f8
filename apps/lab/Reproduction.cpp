// SPDX-License-Identifier: BSD-3-Clause
#include "Reproduction.h"

#include "PosesFromStart.h"
#include "result_output.h"

namespace pointplane
{
std::string displayName(const ReproducedSequence& s)
{
    return s.name + (s.isPart ? " (part)" : "");
}

const LabScore* Reproduction::score(
    std::size_t sequence, const std::string& group, const std::string& name) const
{
    for (std::size_t v = 0; v < variants.size(); ++v)
    {
        const LabScore& score = scores[sequence * variants.size() + v];
        if (variants[v].group == group && variants[v].name == name && score.rpe)
        {
            return &score;
        }
    }
    return nullptr;
}

std::string Reproduction::text(
    std::size_t sequence, const std::string& group, const std::string& name) const
{
    for (std::size_t v = 0; v < variants.size(); ++v)
    {
        if (variants[v].group == group && variants[v].name == name)
        {
            return scoreText(scores[sequence * variants.size() + v], kShortWords);
        }
    }
    return "-";
}

double finalError(const Reproduction& result, std::size_t corner)
{
    return PosesFromStart(result.cornerTruth, result.cornerScores[corner].estimate).finalError();
}
}  // namespace pointplane
