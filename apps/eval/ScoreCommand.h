// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ReportedRun.h"
#include "coverage_limit.h"
#include "input_options.h"
#include "result_output.h"
#include "trajectory_report.h"

namespace pointplane
{
/** The two trajectories of a score. */
struct LoadedRun
{
    ReportedRun reported;  //!< as the files give them; offset and scale are set
    ReportInputs inputs;
    Trajectory truth;     //!< of the estimate's body
    Trajectory measured;  //!< the estimate without lost frames
};

/** What rpe and ate share: they score one estimate by one ground truth. */
struct ScoreCommand
{
    std::string groundTruth, estimate;
    InputOptions input;
    OutputFiles files;
    ReportOptions report;
    bool verbose{false};
    double maxRmse{-1};  //!< negative: not given
    CoverageLimit coverage;

    void addTrajectoriesTo(CLI::App& command);

    /** Checks the outputs, then reads; warns of trajectories that look exchanged.
     * \param offset added to the estimate's stamps [s]
     * \param scale multiplies the estimate's translations */
    [[nodiscard]] LoadedRun load(double offset, double scale, CommandContext& context) const;

    /** \return what is told of any score; rows, protocol, details and singles are the command's */
    [[nodiscard]] ScoredResult titled(const std::string& title) const;

    /** The table (if it was not --verbose), files and the report. */
    void write(const ScoredResult& result, const LoadedRun& run, CommandContext& context) const;
};
}  // namespace pointplane
