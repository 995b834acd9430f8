// SPDX-License-Identifier: BSD-3-Clause
#include "compare_output.h"

#include <pointplane/core/counted.h>
#include <pointplane/evaluation/trajectory_charts.h>
#include <pointplane/evaluation/units.h>

#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "result_output.h"

namespace pointplane
{
namespace
{
/** \param decimals those of the value beside it */
std::string behindText(
    const Comparison& c,
    const std::optional<BootstrapInterval>& behind,
    bool best,
    double unit,
    int decimals)
{
    if (best)
    {
        return "best";
    }
    if (!behind)
    {
        return c.runs.size() == 1 || !c.sameBodies ? "-" : "no common pairs";
    }
    if (!behind->isKnown())
    {
        return format("%+.*f too short", decimals, behind->value * unit);
    }
    return format(
        "%+.*f [%+.*f, %+.*f]%s",
        decimals,
        behind->value * unit,
        decimals,
        behind->lower * unit,
        decimals,
        behind->upper * unit,
        behind->excludesZero() ? "" : " ns");
}

std::string titleOf(const Comparison& c)
{
    return format("Comparison of %zu run%s", c.runs.size(), c.runs.size() == 1 ? "" : "s");
}

bool isBest(const Comparison& c, std::size_t run, std::size_t best)
{
    return c.isComparable() && run == best;
}

/** Its name, or null if the runs cannot be compared. */
nlohmann::ordered_json nameOfBest(const Comparison& c, std::size_t best)
{
    return c.isComparable() ? nlohmann::ordered_json(c.runs[best].name) : nullptr;
}

/** What a reader must know of runs that have different frames or bodies; empty otherwise. */
std::string noteOnRuns(const Comparison& c)
{
    if (c.runs.size() == 1)
    {
        return "this is one run; give others to compare it with";
    }
    if (!c.sameBodies)
    {
        return "some poses are of the camera, others of the robot: their errors cannot be compared";
    }
    const std::string ofAte =
        c.bestAte ? "" : "; ATE is each run's own, so none is marked as the best in ATE";
    if (c.sameFrames)
    {
        return c.bestAte ? "" : "the runs have different frames" + ofAte;
    }
    return c.isComparable()
               ? format(
                     "the runs have different frames: mm and deg are those of the %zu pairs that "
                     "all of them have; the rest is each run's own",
                     c.numCommonPairs) +
                     ofAte
               : "the runs have different frames and fewer than two pairs in common: their errors "
                 "cannot be compared";
}

/** Why differences have no interval; empty if they have one. */
std::string noteOnLength(const Comparison& c)
{
    for (const ComparedRun& run : c.runs)
    {
        for (const auto& behind : {run.translationBehindBest, run.rotationBehindBest})
        {
            if (behind && !behind->isKnown())
            {
                return format(
                    "too short for an interval: %s without overlap, at least %zu are "
                    "needed (--delta sets their length)",
                    counted(behind->independent, "pair").c_str(),
                    BootstrapInterval::kLeastIndependent);
            }
        }
    }
    return "";
}

std::string noteOf(const Comparison& c)
{
    const std::string runs = noteOnRuns(c);
    const std::string length = noteOnLength(c);
    return runs + (runs.empty() || length.empty() ? "" : "; ") + length;
}

/** Ends are null if there is no interval. */
nlohmann::ordered_json intervalJson(const BootstrapInterval& interval, double unit)
{
    return {
        {"value", interval.value * unit},
        {"lower95", interval.lower * unit},
        {"upper95", interval.upper * unit},
        {"independent", interval.independent}};
}

/** A number of frames, or `unknown` if the estimate does not mark its frames. */
std::string framesText(const Coverage& coverage, std::size_t frames, const char* unknown)
{
    return coverage.ofRecording ? std::to_string(frames) : unknown;
}

/** A value with the ends of its interval, which are empty if there is none. */
std::string intervalFields(const BootstrapInterval& interval, double unit)
{
    return format(",%.9g", interval.value * unit) +
           (interval.isKnown() ? format(",%.9g,%.9g", interval.lower * unit, interval.upper * unit)
                               : ",,");
}
}  // namespace

namespace
{
[[nodiscard]] std::vector<std::string> runNames(const Comparison& c)
{
    std::vector<std::string> names;
    for (const ComparedRun& run : c.runs)
    {
        names.push_back(run.name);
    }
    return shownNames(std::move(names), 30);
}

/** Of translation or rotation, in no more columns than a terminal has. */
struct ErrorBlock
{
    const char* header;
    double unit;
    int decimals;
    std::size_t best;
    BootstrapInterval ComparedRun::*value;
    std::optional<BootstrapInterval> ComparedRun::*behind;
};

void printErrors(const Comparison& c, const ErrorBlock& block, std::ostream& out)
{
    out << format("\n%-32s%12s  %s\n", "run", block.header, "behind the best");
    const std::vector<std::string> names = runNames(c);
    for (std::size_t k = 0; k < c.runs.size(); ++k)
    {
        const ComparedRun& r = c.runs[k];
        const bool best = isBest(c, k, block.best);
        out << format(
            "%s  %12.*f%s %s\n",
            names[k].c_str(),
            block.decimals,
            block.unit * (r.*block.value).value,
            best ? "*" : " ",
            behindText(c, r.*block.behind, best, block.unit, block.decimals).c_str());
    }
}
}  // namespace

void printTable(const Comparison& c, const std::string& protocol, std::ostream& out)
{
    out << titleOf(c) << "\n"
        << protocol << "\n"
        << "RMSE; distance to the best with the bootstrap's 95 % interval (ns: not significant)\n";
    printErrors(
        c,
        {"RPE [mm]",
         1000,
         3,
         c.bestTranslation,
         &ComparedRun::translation,
         &ComparedRun::translationBehindBest},
        out);
    printErrors(
        c,
        {"RPE [deg]",
         kDegreesPerRadian,
         4,
         c.bestRotation,
         &ComparedRun::rotation,
         &ComparedRun::rotationBehindBest},
        out);
    out << format(
        "\n%-32s%10s  %7s  %8s  %9s  %5s\n",
        "run",
        "ATE [mm]",
        "pairs",
        "coverage",
        "predicted",
        "lost");
    const std::vector<std::string> names = runNames(c);
    for (std::size_t k = 0; k < c.runs.size(); ++k)
    {
        const ComparedRun& r = c.runs[k];
        out << format(
            "%s  %10.3f%s %7zu  %6.1f %%  %9s  %5s\n",
            names[k].c_str(),
            1000 * r.ate.translation.rmse,
            c.bestAte == k ? "*" : " ",
            r.rpe.translation.count,
            100 * r.rpe.coverage.share,
            framesText(r.rpe.coverage, r.rpe.coverage.predicted, "-").c_str(),
            framesText(r.rpe.coverage, r.rpe.coverage.lost, "-").c_str());
    }
    if (!noteOf(c).empty())
    {
        out << "\n" << noteOf(c) << "\n";
    }
}

nlohmann::ordered_json toJson(const Comparison& c, const std::string& protocol)
{
    nlohmann::ordered_json json;
    json["title"] = "Comparison";
    json["protocol"] = protocol;
    json["units"] = {{"translation", "m"}, {"rotation", "deg"}};
    json["bestTranslation"] = nameOfBest(c, c.bestTranslation);
    json["bestRotation"] = nameOfBest(c, c.bestRotation);
    json["bestAte"] =
        c.bestAte ? nlohmann::ordered_json(c.runs[*c.bestAte].name) : nlohmann::ordered_json();
    json["pairsInCommon"] = c.numCommonPairs;
    if (!noteOf(c).empty())
    {
        json["note"] = noteOf(c);
    }
    for (const ComparedRun& r : c.runs)
    {
        nlohmann::ordered_json run;
        run["name"] = r.name;
        run["pairs"] = r.rpe.translation.count;
        run["coverage"] = toJson(r.rpe.coverage);
        run["rpeTranslation"] = intervalJson(r.translation, 1);
        run["rpeRotation"] = intervalJson(r.rotation, kDegreesPerRadian);
        run["ate"] = r.ate.translation.rmse;
        if (r.translationBehindBest)
        {
            run["translationBehindBest"] = intervalJson(*r.translationBehindBest, 1);
        }
        if (r.rotationBehindBest)
        {
            run["rotationBehindBest"] = intervalJson(*r.rotationBehindBest, kDegreesPerRadian);
        }
        json["runs"].push_back(run);
    }
    return json;
}

std::string toCsv(const Comparison& c)
{
    std::string out =
        "run,pairs,coverage,rpe_m,rpe_lower95,rpe_upper95,rpe_deg,rpe_deg_lower95,"
        "rpe_deg_upper95,ate_m,predicted,lost\n";
    for (const ComparedRun& r : c.runs)
    {
        out += csvField(r.name) +
               format(",%zu,%.6g", r.rpe.translation.count, r.rpe.coverage.share) +
               intervalFields(r.translation, 1) + intervalFields(r.rotation, kDegreesPerRadian) +
               format(",%.9g,", r.ate.translation.rmse) +
               framesText(r.rpe.coverage, r.rpe.coverage.predicted, "") + "," +
               framesText(r.rpe.coverage, r.rpe.coverage.lost, "") + "\n";
    }
    return out;
}

namespace
{
// The report's table.
const std::vector<std::string> kColumns{
    "run",
    "RPE [mm]",
    "behind the best [mm]",
    "RPE [deg]",
    "behind the best [deg]",
    "ATE [mm]",
    "coverage",
    "predicted",
    "lost"};

std::vector<std::string> rowOf(const Comparison& c, std::size_t run)
{
    const ComparedRun& r = c.runs[run];
    return {
        r.name,
        format("%.3f", 1000 * r.translation.value),
        behindText(c, r.translationBehindBest, isBest(c, run, c.bestTranslation), 1000, 3),
        format("%.4f", kDegreesPerRadian * r.rotation.value),
        behindText(c, r.rotationBehindBest, isBest(c, run, c.bestRotation), kDegreesPerRadian, 4),
        format("%.3f", 1000 * r.ate.translation.rmse),
        format("%.1f %%", 100 * r.rpe.coverage.share),
        framesText(r.rpe.coverage, r.rpe.coverage.predicted, "-"),
        framesText(r.rpe.coverage, r.rpe.coverage.lost, "-")};
}
}  // namespace

HtmlReport reportOf(
    const Comparison& c,
    const std::string& protocol,
    const RpeOptions& rpe,
    const Trajectory& truth,
    const std::vector<Trajectory>& estimates,
    const std::vector<std::string>& hints)
{
    HtmlReport report(titleOf(c), protocol + (noteOf(c).empty() ? "" : "; " + noteOf(c)));
    std::vector<std::vector<std::string>> rows;
    std::vector<DrawnPath> paths;
    std::vector<Chart> errors;
    for (std::size_t k = 0; k < c.runs.size(); ++k)
    {
        const ComparedRun& r = c.runs[k];
        rows.push_back(rowOf(c, k));
        paths.push_back({r.name, estimates[k], r.ate, rpe.scale});
        const std::vector<Chart> ofRun = relativeErrorCharts(estimates[k], rpe, r.rpe);
        for (std::size_t n = 0; n < ofRun.size(); ++n)
        {
            if (k == 0)
            {
                errors.push_back(ofRun[n]);
                errors[n].series.clear();
            }
            errors[n].series.push_back(ofRun[n].series.front());
            errors[n].series.back().name = r.name;
        }
    }
    report.addTable("RPE and ATE RMSE", kColumns, rows);
    for (const std::string& hint : hints)
    {
        report.addParagraph("Hint: " + hint);
    }
    for (const Chart& chart : pathCharts(truth, paths))
    {
        report.addChart(chart);
    }
    for (const Chart& chart : errors)
    {
        report.addChart(chart);
    }
    return report;
}
}  // namespace pointplane
