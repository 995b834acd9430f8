// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/rpe.h>

#include <string>

#include <CLI/CLI.hpp>

namespace pointplane
{
/** The options of evaluate_rpe.py on a command line; rpe, compare, sweep and nees share them. */
struct RpeCommandOptions
{
    RpeOptions rpe;
    std::string unit{"s"};
    std::int64_t maxPairs{-1};  //!< -1: not given
    bool evo{false};
    bool interpolate{false};

    /** \param choosesPairs whether --fixed-delta is to be chosen; else pairs always are --delta
     * apart, and it is understood, but not in the help */
    void addTo(CLI::App& command, bool choosesPairs = false);
    /** The options as the evaluation takes them; throws std::invalid_argument. */
    [[nodiscard]] RpeOptions resolved() const;

 private:
    void addDeltaTo(CLI::App& command, bool choosesPairs);
};
}  // namespace pointplane
