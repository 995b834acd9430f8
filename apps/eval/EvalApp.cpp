// SPDX-License-Identifier: BSD-3-Clause
#include "EvalApp.h"

#include <algorithm>
#include <ostream>

#include "command.h"

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

    std::vector<std::string> reversed;
    std::transform(args.rbegin(), args.rend(), std::back_inserter(reversed), withHyphens);
    try
    {
        app.parse(reversed);  // CLI11 takes the arguments last first
        return context.exitCode;
    }
    catch (const CLI::ParseError& e)
    {
        return app.exit(e, out, err) == 0 ? kExitOk : kExitBadInput;
    }
    catch (const EnvironmentError& e)
    {
        err << "pointplane-eval: " << e.what() << "\n";
        return kExitEnvironment;
    }
    catch (const std::exception& e)
    {
        err << "pointplane-eval: " << oneLine(e) << "\n";
        return kExitBadInput;
    }
}
}  // namespace pointplane
