// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/coverage.h>

#include <string>

#include <CLI/CLI.hpp>

namespace pointplane
{
struct CommandContext;

/** What is done with a score. */
enum class ScoreIs
{
    Judged,  //!< held against a threshold
    Shown,
    OfAllFrames  //!< lost ones too, as covariances are
};

/** Option --min-coverage: how much a score must speak for. A run that loses all but the easy frames
 * has the smallest errors, and would pass a threshold best. */
struct CoverageLimit
{
    double percent{-1};  //!< negative: not given
    void addTo(CLI::App& command);

    /** Sets exit code 1 and says so where less was scored. If a score is judged and no limit given,
     * half of a recording is needed. Where it is not known how long that was, there is a warning
     * only: a part may have been scored against the whole ground truth. */
    void check(
        const std::string& estimate,
        const Coverage& coverage,
        ScoreIs score,
        CommandContext& context) const;
};
}  // namespace pointplane
