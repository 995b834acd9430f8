// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

namespace pointplane
{
enum ExitCode : int
{
    kExitOk = 0,
    kExitThresholdExceeded = 1,
    kExitBadInput = 2,
    kExitEnvironment = 3
};

/** An output that cannot be written (exit code 3). */
class OutputError : public std::runtime_error
{
 public:
    using std::runtime_error::runtime_error;
};

/** Where a command writes, and the exit code it leaves behind. */
struct CommandContext
{
    std::ostream& out;  //!< results
    std::ostream& err;  //!< warnings and progress
    int exitCode{kExitOk};
};

/** @name The subcommands: each adds itself to the command line and runs as its callback.
 * @{ */
void addRpeCommand(CLI::App& app, CommandContext& context);
void addAteCommand(CLI::App& app, CommandContext& context);
/** @} */
}  // namespace pointplane
