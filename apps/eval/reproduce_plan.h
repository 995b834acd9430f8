// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "OdometryRuns.h"

namespace pointplane
{
/** A TUM sequence found on disk. */
struct ReproducedSequence
{
    std::string folder;
    std::string name;    //!< as the paper calls it, e.g. "fr1/desk"
    bool isPart{false};  //!< only a part of it, by the folder's name: not comparable as it stands
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

/** One configuration that every sequence is run with. */
struct Variant
{
    std::string group;  //!< "tables", "paper", "default", "alpha"
    std::string name;   //!< "points, unweighted"
    std::string config;
    std::vector<std::string> settings;
};

/** The paper's tables and Fig. 3, and the ablations of both configurations; of the first those that
 * are not in the tables.
 * \param paperConfig config-paper.ini \param defaultConfig empty: the built-in one
 * \param alphas of Fig. 3 */
[[nodiscard]] std::vector<Variant> planVariants(
    const std::string& paperConfig,
    const std::string& defaultConfig,
    const std::vector<std::string>& alphas);
}  // namespace pointplane
