// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "ReportedRun.h"
#include <CLI/CLI.hpp>

namespace pointplane
{
struct CommandContext;
class OutputGuard;

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
};

/** Writes the report and says where it is: DIR/index.html with the scores, the path with its
 * 3-sigma ellipses, poses, errors and NEES over time, features, status and times per frame, and the
 * pictures of the worst frames; each chart also as an SVG file. What cannot be scored is said
 * there. \throws EnvironmentError if it cannot be written, std::runtime_error for input that cannot
 * be read */
void writeTrajectoryReport(
    const ReportedRun& run, const ReportOptions& options, CommandContext& context);
}  // namespace pointplane
