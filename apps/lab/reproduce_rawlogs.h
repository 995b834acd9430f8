// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <iosfwd>
#include <string>
#include <vector>

#include "lab_runs.h"
#include "reproduce_plan.h"
#include "run_processes.h"

namespace pointplane
{
/** A rawlog to be made, with its ground truth, and how. */
struct RawlogJob
{
    std::string rawlog;
    ProcessJob process;
};

/** How the rawlogs that `reproduce` runs on are made: its options for that. */
struct RawlogMaker
{
    std::string convert, simulate;  //!< the programs; empty: those beside this one
    double cornerDuration{18};      //!< [s]

    void addTo(CLI::App& command);
    void guardedBy(OutputGuard& guard) const;

    /** The simulated corner. */
    [[nodiscard]] RawlogJob corner(const WorkDirectory& work) const;
    /** A sequence, of its folder. */
    [[nodiscard]] RawlogJob of(const ReproducedSequence& sequence, const WorkDirectory& work) const;
};

/** Does all jobs, at most `parallel` at a time; a line for each goes to `progress`.
 * \throws InputError that tells why a rawlog could not be made */
void makeRawlogs(const std::vector<RawlogJob>& jobs, std::size_t parallel, std::ostream& progress);
}  // namespace pointplane
