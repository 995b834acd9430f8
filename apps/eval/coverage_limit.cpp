// SPDX-License-Identifier: BSD-3-Clause
#include "coverage_limit.h"

#include <ostream>

#include "command.h"
#include "number_checks.h"
#include "result_output.h"

namespace pointplane
{
namespace
{
constexpr double kLeastPercent = 50;  // for a threshold, if no limit is given
constexpr double kRounding = 1e-9;
}  // namespace

void CoverageLimit::addTo(CLI::App& command)
{
    command.add_option("--min-coverage", percent, "Exit with 1 if less was scored [percent]")
        ->check(isBetween(0, 100))
        ->group("Limits");
}

void CoverageLimit::check(
    const std::string& estimate,
    const Coverage& coverage,
    ScoreIs score,
    CommandContext& context) const
{
    const double scored = 100 * coverage.share + kRounding;
    const bool isGiven = percent >= 0;
    const bool isJudged = score == ScoreIs::Judged && coverage.ofRecording;
    const double limit = isGiven ? percent : isJudged ? kLeastPercent : 0;
    if (!(scored >= limit))
    {
        context.err << context.program << ": " << inOneLine(estimate)
                    << format(": coverage %.1f %% is below %g %%", scored, limit)
                    << (isGiven ? ""
                                : ", too little for a threshold to be passed; --min-coverage sets "
                                  "another limit")
                    << "\n";
        context.exitCode = kExitIncomplete;
    }
    else if (score != ScoreIs::OfAllFrames && scored < kLeastPercent)
    {
        context.tell(
            "warning",
            estimate + format(": only %.1f %% of the ", scored) +
                (coverage.ofRecording ? "recording" : "ground truth's time") + " was scored");
    }
}
}  // namespace pointplane
