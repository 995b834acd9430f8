// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/ate.h>
#include <pointplane/evaluation/nees.h>
#include <pointplane/evaluation/rpe.h>

#include <string>
#include <vector>

namespace pointplane
{
/** One run to report on. */
struct ReportedRun
{
    Trajectory groundTruth;  //!< as its file gives it
    Trajectory estimate;
    RpeOptions rpe;  //!< of the score; charts need listed pairs and take a fixed delta
    AteOptions ate;
    NeesOptions nees;  //!< T_truth_body applies to all metrics
    std::vector<NeesInterval> intervals;
    std::string hint;      //!< to the reader, or empty
    bool isOfNees{false};  //!< that is what it is about, and comes first
};
}  // namespace pointplane
