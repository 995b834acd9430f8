// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lab_runs.h"

namespace pointplane
{
/** A TUM sequence found on disk, or the simulated corner. */
struct ReproducedSequence
{
    std::string folder;  //!< empty: simulated
    std::string name;    //!< as the paper calls it, e.g. "fr1/desk"
    bool isPart{false};  //!< only a part of it, by the folder's name: not comparable as it stands
    std::string firstStamp, lastStamp;  //!< of its colour images, as they are written [s]
    std::size_t numFrames{0};           //!< of them
    std::string rawlog, groundTruth;
};

/** Folders with rgb.txt, depth.txt and groundtruth.txt: `directory` itself or those in it, sorted.
 */
[[nodiscard]] std::vector<ReproducedSequence> findSequences(const std::string& directory);

/** "rgbd_dataset_freiburg1_desk" or "tum_fr1_desk_part" -> "fr1/desk"; others unchanged. */
[[nodiscard]] std::string sequenceName(const std::string& folderName, bool& isPart);

/** Figures of the paper (and the best it names) for its four sequences; empty if it has none. */
struct PublishedFigures
{
    std::string sequence;
    std::string deterministic, points, pointsAndPlanes, stateOfTheArt;
};
/** [P17] Tables 1 and 2, "mm / deg". */
[[nodiscard]] const std::vector<PublishedFigures>& publishedFigures();

/** Which choices of config-paper.ini a part of the sequence took part in; "nothing" for most.
 * docs/paper_figures.md has the table. */
[[nodiscard]] std::string chosenOn(const std::string& sequence);

/** What `reproduce` makes, and by what name --only chooses it. */
constexpr const char* kReproducedGroups[] = {
    "tables", "tukey", "alpha", "corner", "paper", "detectors"};

/** One configuration that every sequence is run with; the corner's only the corner. */
struct Variant
{
    std::string group;  //!< one of kReproducedGroups
    std::string name;   //!< "points, unweighted"
    std::string config;
    std::vector<std::string> settings;
};

/** The paper's tables, Fig. 3 and Fig. 5, Tukey's constants, and the ablations.
 * \param paper config-paper.ini \param alphas of Fig. 3 */
[[nodiscard]] std::vector<Variant> planVariants(
    const std::string& paper, const std::vector<std::string>& alphas);
}  // namespace pointplane
