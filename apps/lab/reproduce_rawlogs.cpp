// SPDX-License-Identifier: BSD-3-Clause
#include "reproduce_rawlogs.h"

#include <pointplane/mrpt_io/errors.h>

#include <filesystem>
#include <ostream>

#include "OutputGuard.h"
#include "number_checks.h"
#include "result_output.h"

namespace pointplane
{
namespace
{
std::string programOr(const std::string& given, const char* usual)
{
    return given.empty() ? siblingProgram(usual) : given;
}
}  // namespace

void RawlogMaker::addTo(CLI::App& command)
{
    command
        .add_option(
            "--corner-duration", cornerDuration, "Length of the simulated corner sequence [s]")
        ->capture_default_str()
        ->check(isPositive())
        ->group("Runs");
    command
        .add_option(
            "--convert", convert, "The pointplane-convert to run (default: beside this program)")
        ->type_name("PROGRAM")
        ->group("Runs");
    command
        .add_option(
            "--simulate", simulate, "The pointplane-simulate to run (default: beside this program)")
        ->type_name("PROGRAM")
        ->group("Runs");
}

void RawlogMaker::guardedBy(OutputGuard& guard) const
{
    guard.addInput(convert);
    guard.addInput(simulate);
}

RawlogJob RawlogMaker::corner(const WorkDirectory& work) const
{
    const std::string rawlog = work.fileAt("corner.rawlog");
    return {
        rawlog,
        {{programOr(simulate, "pointplane-simulate"),
          "corner",
          "-o",
          rawlog,
          "--duration",
          format("%g", cornerDuration),
          "--quiet"},
         work.fileAt("corner.log")}};
}

RawlogJob RawlogMaker::of(const ReproducedSequence& sequence, const WorkDirectory& work) const
{
    const auto name = std::filesystem::path(sequence.folder).filename().string();
    const std::string rawlog = work.fileAt(name + ".rawlog");
    return {
        rawlog,
        {{programOr(convert, "pointplane-convert"),
          "tum",
          sequence.folder,
          "-o",
          rawlog,
          "--quiet"},
         work.fileAt(name + ".rawlog.log")}};
}

void makeRawlogs(const std::vector<RawlogJob>& jobs, std::size_t parallel, std::ostream& progress)
{
    std::vector<ProcessJob> processes;
    for (const RawlogJob& job : jobs)
    {
        processes.push_back(job.process);
    }
    std::string failure;  // the callback runs in another thread and must not throw
    runProcesses(
        processes,
        parallel,
        [&](std::size_t k, int exitCode)
        {
            if (exitCode == kExitOk)
            {
                progress << "made " << jobs[k].rawlog << std::endl;
                return;
            }
            failure = "cannot make '" + jobs[k].rawlog + "': " + processes[k].command.front() +
                      ", exit code " + std::to_string(exitCode) + ", " +
                      lastLine(processes[k].logPath);
        });
    if (!failure.empty())
    {
        throw InputError(failure);
    }
}
}  // namespace pointplane
