// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/FrameTable.h>

#include <string>

#include "ReportedRun.h"
#include "report_worst_frames.h"
#include <CLI/CLI.hpp>

namespace pointplane
{
struct CommandContext;
class OutputGuard;

/** What a report shows beside the two trajectories. */
struct ReportInputs
{
    FrameTable table;
    FramePictures pictures;
    std::string runConfig;
};

/** Options --report DIR and what goes into the report beside the two trajectories. */
struct ReportOptions
{
    std::string directory;    //!< empty: no report
    std::string diagnostics;  //!< table of pointplane-odometry --diagnostics, or empty
    std::string overlays;     //!< folder of pointplane-odometry --overlay, or empty
    std::string runConfig;    //!< configuration of the run, or empty
    void addTo(CLI::App& command);
    /** Tells the guard what will be read and written. */
    void guardedBy(OutputGuard& guard) const;
    /** Before the run is scored, so that bad input is told before there are results. A table of a
     * part of the run is told.
     * \throws std::runtime_error, InputError for files that cannot be read or are not of the run */
    [[nodiscard]] ReportInputs read(const Trajectory& estimate, CommandContext& context) const;
};

/** Writes the report and says where it is: DIR/index.html with the scores, the path with its
 * 3-sigma ellipses, poses, errors and NEES over time, features, status and times per frame, and the
 * pictures of the worst frames; each chart also as an SVG file. What cannot be scored is said
 * there. Nothing is written without --report. \throws EnvironmentError if it cannot be written */
void writeTrajectoryReport(
    const ReportedRun& run,
    const ReportOptions& options,
    const ReportInputs& inputs,
    CommandContext& context);
}  // namespace pointplane
