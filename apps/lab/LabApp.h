// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "command.h"

namespace pointplane
{
/** pointplane-lab without the process around it: many runs of the programs, scored.
 * \param args the command line without the program's name
 * \return the exit code: 0 ok; 1 a run failed; 2 bad usage or input; 3 output cannot be written */
int runLab(const std::vector<std::string>& args, std::ostream& out, std::ostream& err);

/** @name Its subcommands
 * @{ */
void addSweepCommand(CLI::App& app, CommandContext& context);
void addReproduceCommand(CLI::App& app, CommandContext& context);
/** @} */
}  // namespace pointplane
