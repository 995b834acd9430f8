// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/consistency.h>
#include <pointplane/evaluation/nees.h>

#include <string>
#include <vector>

#include "command.h"
#include <CLI/CLI.hpp>

namespace pointplane
{
/** What nees tests, and which results are good enough. */
struct NeesCommandOptions
{
    std::vector<std::string> intervals{"1f", "10f", "1s"};
    bool areChosen{false};  //!< the intervals, by the user
    NeesOptions nees;
    std::string sigmaRotationDeg{"0"};  //!< s or x,y,z
    bool nearest{false};
    double minNees{-1};
    double maxNees{-1};

    void addTo(CLI::App& command);

    /** Whether a range of NEES is asked for. */
    [[nodiscard]] bool isLimited() const { return minNees >= 0 || maxNees >= 0; }

    /** The options as the evaluation takes them, but for the ground truth's body. \throws
     * std::invalid_argument */
    [[nodiscard]] NeesOptions resolved() const;
    /** \throws std::invalid_argument */
    [[nodiscard]] std::vector<NeesInterval> resolvedIntervals() const;

    /** Says which results are outside the stated range, and sets the exit code.
     * \param untold why not all that was asked for could be tested, or empty */
    void checkRange(
        const std::vector<NeesResult>& results,
        const std::string& untold,
        CommandContext& context) const;

 private:
    void addProtocolTo(CLI::App& command);
};
}  // namespace pointplane
