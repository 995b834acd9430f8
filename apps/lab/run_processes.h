// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace pointplane
{
/** A program to run, its output going to a file. */
struct ProcessJob
{
    std::vector<std::string> command;  //!< program (searched in PATH if it has no slash), arguments
    std::string logPath;               //!< of standard output and error
};

/** Runs all jobs, at most `parallel` at a time, in their order.
 * \param onDone called with a job's index and exit code (128 + signal if killed, 127 if it could
 * not be started), one call at a time, from other threads, so it must not throw; may be empty
 * \throws EnvironmentError if a signal asked to stop; no job is left running then */
void runProcesses(
    const std::vector<ProcessJob>& jobs,
    std::size_t parallel,
    const std::function<void(std::size_t job, int exitCode)>& onDone);

/** Path of a program of this project: beside the running one, else by name for PATH. */
[[nodiscard]] std::string siblingProgram(const std::string& name);

/** The last line of a text file that is not empty; empty if there is none. */
[[nodiscard]] std::string lastLine(const std::string& path);
}  // namespace pointplane
