// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/ate.h>
#include <pointplane/evaluation/bootstrap.h>
#include <pointplane/evaluation/rpe.h>

#include <optional>
#include <string>
#include <vector>

namespace pointplane
{
/** How one run does, alone and beside the best. */
struct ComparedRun
{
    std::string name;
    RpeResult rpe;
    AteResult ate;
    /** RPE RMSE [m], of the pairs of frames that all runs have, if these are at least two. */
    BootstrapInterval translation;
    BootstrapInterval rotation;  //!< RPE RMSE [rad], likewise
    /** RPE RMSE minus that of the best run, over the same pairs; none for the best itself and where
     * these are fewer than two. Without an interval, if these are too short. */
    std::optional<BootstrapInterval> translationBehindBest, rotationBehindBest;
};

struct Comparison
{
    std::vector<ComparedRun> runs;                    //!< in the order given
    std::size_t bestTranslation{0}, bestRotation{0};  //!< indices of the smallest RMSE
    std::optional<std::size_t>
        bestAte;  //!< none where ATE is not of the same frames or bodies, or of one run
    std::size_t numCommonPairs{0};  //!< that all runs have
    bool sameFrames{true};          //!< no run has other pairs
    bool sameBodies{true};          //!< not camera and robot, as far as the files tell

    /** Otherwise the smallest RMSE does not make a run the best one. */
    [[nodiscard]] bool isComparable() const
    {
        return runs.size() > 1 && numCommonPairs >= 2 && sameBodies;
    }
};

/** Scores several estimates of the same ground truth. `rpe` must list its pairs (fixed delta), or
 * std::invalid_argument is thrown. The bootstrap's blocks are as long as a pair: that far, errors
 * share measurements. Errors of other frames, or of another body, say nothing about which run is
 * better, so only the pairs count that all runs have. ATE is of each run's own frames. \param
 * options its block length is ignored */
[[nodiscard]] Comparison compareRuns(
    const Trajectory& groundTruth,
    const std::vector<Trajectory>& estimates,
    const RpeOptions& rpe,
    const AteOptions& ate,
    BootstrapOptions options);
}  // namespace pointplane
