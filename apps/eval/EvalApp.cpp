// SPDX-License-Identifier: BSD-3-Clause
#include "EvalApp.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <ostream>

#include "command.h"
#include "result_output.h"
#include "run_program.h"

namespace pointplane
{
namespace
{
/** The TUM scripts spell --fixed_delta what is --fixed-delta elsewhere; both are understood. */
std::string withHyphens(std::string arg)
{
    if (arg.rfind("--", 0) == 0)
    {
        std::replace(arg.begin(), std::find(arg.begin(), arg.end(), '='), '_', '-');
    }
    return arg;
}

/** Quoted for a shell where that is needed. */
std::string quoted(const std::string& arg)
{
    const auto isPlain = [](char c)
    { return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::strchr("_-+=./,:@%", c); };
    if (!arg.empty() && std::all_of(arg.begin(), arg.end(), isPlain))
    {
        return arg;
    }
    std::string out = "'";
    for (const char c : arg)
    {
        out += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return out + "'";
}
}  // namespace

void CommandContext::tell(const std::string& kind, const std::string& text) const
{
    err << program << ": " << kind << ": " << inOneLine(text) << "\n";
}

void CommandContext::hint(const std::string& text) const
{
    if (!text.empty())
    {
        tell("hint", text);
    }
}

int runCommandsOf(
    const std::string& program,
    const std::string& description,
    const std::function<void(CLI::App&, CommandContext&)>& addCommands,
    const std::vector<std::string>& args,
    std::ostream& out,
    std::ostream& err)
{
    CommandContext context{out, err, program, program};
    for (const std::string& arg : args)
    {
        context.commandLine += " " + quoted(arg);
    }
    CLI::App app{description, program};
    app.set_version_flag("--version", POINTPLANE_VERSION);
    app.require_subcommand(1);
    addCommands(app, context);
    std::vector<std::string> words;
    std::transform(args.begin(), args.end(), std::back_inserter(words), withHyphens);
    return runCommand(app, words, out, err, [&] { return context.exitCode; });
}

int runEval(const std::vector<std::string>& args, std::ostream& out, std::ostream& err)
{
    const auto addCommands = [](CLI::App& app, CommandContext& context)
    {
        addRpeCommand(app, context);
        addAteCommand(app, context);
        addNeesCommand(app, context);
        addCompareCommand(app, context);
    };
    return runCommandsOf(
        "pointplane-eval",
        "Scores trajectories and their covariances against ground truth.",
        addCommands,
        args,
        out,
        err);
}
}  // namespace pointplane
