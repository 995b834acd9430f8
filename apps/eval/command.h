// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/errors.h>

#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace pointplane
{
/** Where a command writes, and the exit code it leaves behind. */
struct CommandContext
{
    std::ostream& out;        //!< results
    std::ostream& err;        //!< warnings and progress
    std::string program;      //!< its name, for messages
    std::string commandLine;  //!< as a shell would take it, for reports
    int exitCode{kExitOk};    //!< kExitIncomplete: gate exceeded, or damaged input

    /** A line to the user, whatever the names in it hold. \param kind "warning", "note", ... */
    void tell(const std::string& kind, const std::string& text) const;

    /** A line to the user, unless it is empty. */
    void hint(const std::string& text) const;
};

/** Adds a subcommand whose options have addTo() and run(). */
template <class Options>
void addCommand(
    CLI::App& app, CommandContext& context, const std::string& name, const std::string& description)
{
    CLI::App& command = *app.add_subcommand(name, description);
    const auto options = std::make_shared<Options>();
    options->addTo(command);
    command.callback([options, &context] { options->run(context); });
}

/** @name The subcommands: each adds itself to the command line and runs as its callback.
 * @{ */
void addRpeCommand(CLI::App& app, CommandContext& context);
void addAteCommand(CLI::App& app, CommandContext& context);
void addNeesCommand(CLI::App& app, CommandContext& context);
void addCompareCommand(CLI::App& app, CommandContext& context);
/** @} */

/** Runs a program that consists of such commands. \param addCommands adds them \param args without
 * the program's name \return exit code */
[[nodiscard]] int runCommandsOf(
    const std::string& program,
    const std::string& description,
    const std::function<void(CLI::App&, CommandContext&)>& addCommands,
    const std::vector<std::string>& args,
    std::ostream& out,
    std::ostream& err);
}  // namespace pointplane
