// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/evaluation/svg_chart.h>
#include <pointplane/evaluation/trajectory_text.h>
#include <pointplane/mrpt_io/params_ini.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <map>
#include <ostream>
#include <string>

#include "LabApp.h"
#include "OutputGuard.h"
#include "lab_runs.h"
#include "report_file.h"
#include "reproduce_output.h"
#include "reproduce_plan.h"
#include "reproduce_rawlogs.h"
#include "result_output.h"
#include "rpe_options.h"
#include "run_processes.h"
#include "word_check.h"

namespace pointplane
{
namespace
{
struct ReproduceCommand
{
    std::vector<std::string> directories;
    std::string paperConfig, report, figure;
    std::vector<std::string> alphas{"0", "1", "10", "100", "1e3", "1e7"};
    std::vector<std::string> parts{std::begin(kReproducedGroups), std::end(kReproducedGroups)};
    RawlogMaker rawlogs;
    LabRunner runner;
    OutputFiles files;

    void addTo(CLI::App& command);
    void run(CommandContext& context) const;

 private:
    [[nodiscard]] bool makes(const std::string& group) const;
    [[nodiscard]] std::vector<ReproducedSequence> foundSequences() const;
    void plan(const std::string& paper, Reproduction& result) const;
    [[nodiscard]] std::vector<RawlogJob> planRawlogs(
        Reproduction& result, const WorkDirectory& work) const;
    [[nodiscard]] std::string score(Reproduction& result, CommandContext& context) const;
    void write(const Reproduction& result, CommandContext& context) const;
};

void ReproduceCommand::addTo(CLI::App& command)
{
    command.add_option("directories", directories, "Folders of TUM sequences, or single sequences")
        ->type_name("DIR")
        ->required();
    command
        .add_option(
            "--paper-config",
            paperConfig,
            "The paper's configuration (default: config-paper.ini here or with the program)")
        ->type_name("FILE")
        ->group("Runs");
    command.add_option("--alphas", alphas, "Weights of the planes, for Fig. 3")
        ->delimiter(',')
        ->capture_default_str()
        ->group("Runs");
    command
        .add_option(
            "--only",
            parts,
            "tables (1 and 2, the quickest), tukey (Table 1 by the M-estimator's constant), alpha "
            "(Fig. 3), corner (Fig. 5), paper (ablations of its configuration), detectors "
            "(default: all)")
        ->delimiter(',')
        ->check(isOneOf(parts))
        ->group("Runs");
    rawlogs.addTo(command);
    runner.addTo(command);
    files.addTo(command, "");
    command.add_option("--report", report, "Write DIR/index.html: one file, with the curves")
        ->type_name("DIR")
        ->group("Output");
    command.add_option("--figure", figure, "Write Fig. 3 and Fig. 5 as DIR/paper_fig*.svg")
        ->type_name("DIR")
        ->group("Output");
}

bool ReproduceCommand::makes(const std::string& group) const
{
    return std::find(parts.begin(), parts.end(), group) != parts.end();
}

/** config-paper.ini: here, installed, or of the source tree the program was built in. */
std::string findPaperConfig()
{
    const auto self = std::filesystem::path(siblingProgram("pointplane-lab")).parent_path();
    for (const std::filesystem::path& folder :
         {std::filesystem::path("."), self / "../share/pointplane", self / "../../.."})
    {
        const auto path = folder / "config-paper.ini";
        if (std::filesystem::exists(path))
        {
            return path.lexically_normal().string();
        }
    }
    throw InputError("config-paper.ini not found; name it by --paper-config");
}

/** Rawlogs are named after the folders, as are the rows of the tables.
 * \throws InputError if two are named alike */
void requireOwnNames(const std::vector<ReproducedSequence>& sequences)
{
    std::map<std::string, std::string> folders;
    for (const ReproducedSequence& sequence : sequences)
    {
        const std::string name = std::filesystem::path(sequence.folder).filename().string();
        const auto [it, isNew] = folders.emplace(name, sequence.folder);
        if (!isNew)
        {
            throw InputError(
                "'" + it->second + "' and '" + sequence.folder +
                "' have the same name; give each folder once, or rename one");
        }
    }
}

/** \throws InputError if a folder has none, or two have one name */
std::vector<ReproducedSequence> ReproduceCommand::foundSequences() const
{
    std::vector<ReproducedSequence> out;
    for (const std::string& directory : directories)
    {
        const auto found = findSequences(directory);
        if (found.empty())
        {
            throw InputError(
                "no TUM sequence in '" + directory +
                "': a folder with rgb.txt, depth.txt and groundtruth.txt");
        }
        out.insert(out.end(), found.begin(), found.end());
    }
    requireOwnNames(out);
    return out;
}

/** Sets the variants that are asked for. */
void ReproduceCommand::plan(const std::string& paper, Reproduction& result) const
{
    for (const Variant& variant : planVariants(paper, alphas))
    {
        if (makes(variant.group))
        {
            (variant.group == "corner" ? result.cornerVariants : result.variants)
                .push_back(variant);
        }
    }
}

/** Tells each sequence its rawlog. */
std::vector<RawlogJob> ReproduceCommand::planRawlogs(
    Reproduction& result, const WorkDirectory& work) const
{
    std::vector<RawlogJob> out;
    if (makes("corner"))
    {
        out.push_back(rawlogs.corner(work));
    }
    for (ReproducedSequence& sequence : result.sequences)
    {
        out.push_back(rawlogs.of(sequence, work));
        sequence.rawlog = out.back().rawlog;
        sequence.groundTruth = groundTruthOf(sequence.rawlog);
    }
    return out;
}

/** Sequence by sequence, then the corner. */
std::vector<LabRun> runsOf(const Reproduction& result, const std::string& corner)
{
    std::vector<LabRun> out;
    for (const ReproducedSequence& s : result.sequences)
    {
        for (const Variant& v : result.variants)
        {
            const std::string name = s.name + " " + v.group + ": " + v.name;
            out.push_back({name, s.rawlog, s.groundTruth, v.config, v.settings});
        }
    }
    for (const Variant& v : result.cornerVariants)
    {
        out.push_back({"corner: " + v.name, corner, groundTruthOf(corner), v.config, v.settings});
    }
    return out;
}

/** Makes rawlogs, and runs all variants on them. \return which runs failed, or empty */
std::string ReproduceCommand::score(Reproduction& result, CommandContext& context) const
{
    const WorkDirectory work(runner.directory);
    makeRawlogs(planRawlogs(result, work), runner.parallel(), context.err);
    const std::string corner = rawlogs.corner(work).rawlog;
    const std::vector<LabRun> runs = runsOf(result, corner);
    result.rpe.fixedDelta = true;
    result.scores = runner.run(runs, result.rpe, work, context.err);
    const std::string failures = failuresOf(runs, result.scores);
    for (const ReproducedSequence& s : result.sequences)
    {
        result.truths.push_back(readTrajectoryText(s.groundTruth));
    }
    const auto firstOfCorner =
        result.scores.end() - static_cast<std::ptrdiff_t>(result.cornerVariants.size());
    result.cornerScores.assign(firstOfCorner, result.scores.end());
    result.scores.erase(firstOfCorner, result.scores.end());
    if (makes("corner"))
    {
        result.cornerTruth = readTrajectoryText(groundTruthOf(corner));
    }
    return failures;
}

void ReproduceCommand::write(const Reproduction& result, CommandContext& context) const
{
    if (!files.replaceTable())
    {
        context.out << toMarkdown(result);
    }
    files.write(toJson(result), toCsv(result), "", context.out);
    if (!report.empty())
    {
        writeReportFile(reportOf(result), report, context);
    }
    if (!figure.empty())
    {
        const OutputFolder folder(figure);
        for (const NamedChart& chart : figuresOf(result))
        {
            writeText(svgFileOf(chart.chart), folder.fileAt(chart.fileName), context.out);
        }
    }
}

void ReproduceCommand::run(CommandContext& context) const
{
    OutputGuard guard;
    const std::string paper = paperConfig.empty() ? findPaperConfig() : paperConfig;
    guard.addInput(paper);
    rawlogs.guardedBy(guard);
    runner.guardedBy(guard);
    files.guardedBy(guard);
    guardReport(guard, report);
    guard.addOutputFolder("--figure", figure, ".svg");
    Reproduction result;
    result.sequences = foundSequences();
    for (const ReproducedSequence& sequence : result.sequences)
    {
        guard.addInputFolder(sequence.folder);
    }
    plan(paper, result);
    (void)loadOdometryParams(paper, {});
    runner.requireProgram();
    const std::string failures = score(result, context);
    write(result, context);
    if (!failures.empty())
    {
        context.err << "pointplane-lab: " << failures << "\n";
        context.exitCode = kExitIncomplete;
    }
}
}  // namespace

void addReproduceCommand(CLI::App& app, CommandContext& context)
{
    addCommand<ReproduceCommand>(
        app,
        context,
        "reproduce",
        "The paper's Tables 1 and 2, Fig. 3 and Fig. 5, on the TUM sequences of a folder");
}
}  // namespace pointplane
