// SPDX-License-Identifier: BSD-3-Clause
#include "LabApp.h"

#include "StopSignals.h"

namespace pointplane
{
int runLab(const std::vector<std::string>& args, std::ostream& out, std::ostream& err)
{
    installStopSignals();
    const auto addCommands = [](CLI::App& app, CommandContext& context)
    {
        addSweepCommand(app, context);
        addReproduceCommand(app, context);
    };
    return runCommandsOf(
        "pointplane-lab",
        "Runs the programs many times and scores them.",
        addCommands,
        args,
        out,
        err);
}
}  // namespace pointplane
