// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/nees.h>
#include <pointplane/evaluation/rpe.h>

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pointplane
{
/** Options --report DIR and what goes into the report beside the two trajectories. */
struct ReportOptions
{
    std::string directory;    //!< empty: no report
    std::string diagnostics;  //!< table of pointplane-odometry --diagnostics, or empty
    std::string overlays;     //!< folder of pointplane-odometry --overlay, or empty
    void addTo(CLI::App& command);
};

/** One run to report on. */
struct ReportedRun
{
    Trajectory groundTruth;  //!< as its file gives it
    Trajectory estimate;
    RpeOptions rpe;    //!< fixedDelta is set
    NeesOptions nees;  //!< T_truth_body applies to all metrics
    std::vector<NeesInterval> intervals;
};

/** Writes DIR/index.html: the scores, the path with its 3-sigma ellipses, errors and NEES over
 * time, features, status and times per frame, and the pictures of the worst frames. \return the
 * file's path \throws EnvironmentError if it cannot be written, std::runtime_error for input that
 * cannot be read or scored */
std::string writeTrajectoryReport(const ReportedRun& run, const ReportOptions& options);

/** Writes `html` to `directory`/index.html, which is created. \throws EnvironmentError */
std::string writeReportFile(const std::string& html, const std::string& directory);
}  // namespace pointplane
