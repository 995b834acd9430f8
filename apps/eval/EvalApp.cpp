// SPDX-License-Identifier: BSD-3-Clause
#include "EvalApp.h"

#include <algorithm>
#include <ostream>

#include "command.h"
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
}  // namespace

int runEval(const std::vector<std::string>& args, std::ostream& out, std::ostream& err)
{
    CommandContext context{out, err};
    CLI::App app{
        "Scores trajectories and their covariances against ground truth.", "pointplane-eval"};
    app.set_version_flag("--version", POINTPLANE_VERSION);
    app.require_subcommand(1);
    addRpeCommand(app, context);
    addAteCommand(app, context);
    addNeesCommand(app, context);
    addCompareCommand(app, context);
    addSweepCommand(app, context);
    addReproduceCommand(app, context);

    std::vector<std::string> words;
    std::transform(args.begin(), args.end(), std::back_inserter(words), withHyphens);
    return runCommand(app, words, out, err, [&] { return context.exitCode; });
}
}  // namespace pointplane
