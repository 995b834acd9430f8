// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/rawlog_names.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <ostream>

#include "OdometryRuns.h"
#include "OutputGuard.h"
#include "command.h"
#include "reproduce_output.h"
#include "reproduce_plan.h"
#include "result_output.h"
#include "rpe_options.h"
#include "run_processes.h"
#include "trajectory_report.h"

namespace pointplane
{
namespace
{
struct ReproduceCommand
{
    std::string directory, config, paperConfig, report, convert;
    std::vector<std::string> alphas{"0", "0.1", "0.3", "1", "3", "10", "30", "100"};
    std::vector<std::string> parts{"tables", "paper", "default", "alpha"};
    OdometryRunner runner;
    OutputFiles files;

    void addTo(CLI::App& command);
    void run(CommandContext& context) const;
    void convertAll(
        std::vector<ReproducedSequence>& sequences,
        const std::string& folder,
        CommandContext& context) const;
};

void ReproduceCommand::addTo(CLI::App& command)
{
    command.add_option("directory", directory, "Folder of TUM sequences, or one sequence")
        ->required();
    command.add_option("-c,--config", config, "The default configuration [built in]")
        ->group("Runs");
    command
        .add_option("--paper-config", paperConfig, "config-paper.ini [here or with the program]")
        ->group("Runs");
    command.add_option("--alphas", alphas, "Weights of the planes, for Fig. 3")
        ->delimiter(',')
        ->capture_default_str()
        ->group("Runs");
    command
        .add_option(
            "--only",
            parts,
            "tables (1 and 2, the quickest), paper (ablations of its configuration), default "
            "(ablations of ours), alpha (Fig. 3) [all]")
        ->delimiter(',')
        ->check(CLI::IsMember({"tables", "paper", "default", "alpha"}))
        ->group("Runs");
    command.add_option("--convert", convert, "The pointplane-convert to run [beside this program]")
        ->type_name("PROGRAM")
        ->group("Runs");
    runner.addTo(command);
    files.addTo(command, "");
    command.add_option("--report", report, "Write DIR/index.html: one file, with the curves")
        ->type_name("DIR")
        ->group("Output");
}

/** config-paper.ini: here, installed, or of the source tree the program was built in. */
std::string findPaperConfig()
{
    const auto self = std::filesystem::path(siblingProgram("pointplane-eval")).parent_path();
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

void ReproduceCommand::convertAll(
    std::vector<ReproducedSequence>& sequences,
    const std::string& folder,
    CommandContext& context) const
{
    std::vector<ProcessJob> jobs;
    for (ReproducedSequence& s : sequences)
    {
        const auto folderName = std::filesystem::path(s.folder).filename().string();
        s.rawlog = folder + "/" + folderName + ".rawlog";
        s.groundTruth = groundTruthOf(s.rawlog);
        const std::string program =
            convert.empty() ? siblingProgram("pointplane-convert") : convert;
        jobs.push_back({{program, "tum", s.folder, "-o", s.rawlog, "--quiet"}, s.rawlog + ".log"});
    }
    std::string failure;  // the callback runs in another thread and must not throw
    runProcesses(
        jobs,
        runner.parallel(),
        [&](std::size_t k, int exitCode)
        {
            if (exitCode == kExitOk)
            {
                context.err << "converted " << sequences[k].folder << std::endl;
                return;
            }
            failure = "cannot convert '" + sequences[k].folder + "': " + jobs[k].command.front() +
                      ", exit code " + std::to_string(exitCode) + ", " + lastLine(jobs[k].logPath);
        });
    if (!failure.empty())
    {
        throw InputError(failure);
    }
}

void ReproduceCommand::run(CommandContext& context) const
{
    OutputGuard guard;
    guard.addInput(config);
    guard.addInput(paperConfig);
    files.guardedBy(guard);
    guardReport(guard, report);
    Reproduction result;
    result.sequences = findSequences(directory);
    if (result.sequences.empty())
    {
        throw InputError(
            "no TUM sequence in '" + directory +
            "': a folder with rgb.txt, depth.txt and groundtruth.txt");
    }
    const std::string paper = paperConfig.empty() ? findPaperConfig() : paperConfig;
    for (const Variant& variant : planVariants(paper, config, alphas))
    {
        // The ablations of the paper's configuration are read beside its tables.
        const auto chosen = [&](const char* part)
        { return std::find(parts.begin(), parts.end(), part) != parts.end(); };
        if (chosen(variant.group.c_str()) || (variant.group == "tables" && chosen("paper")))
        {
            result.variants.push_back(variant);
        }
    }
    const WorkDirectory work(runner.directory);
    convertAll(result.sequences, work.path(), context);

    std::vector<OdometryRun> runs;
    for (const ReproducedSequence& s : result.sequences)
    {
        for (const Variant& v : result.variants)
        {
            runs.push_back(
                {s.name + " " + v.group + ": " + v.name,
                 s.rawlog,
                 s.groundTruth,
                 v.config,
                 v.settings});
        }
    }
    RpeOptions rpe;
    rpe.fixedDelta = true;
    result.protocol = describe(rpe);
    result.scores = runner.run(runs, rpe, context.err);

    if (!files.replaceTable())
    {
        context.out << toMarkdown(result);
    }
    files.write(toJson(result), toCsv(result), "", context.out);
    if (!report.empty())
    {
        writeReportFile(reportOf(result), report, context);
    }
    for (const OdometryScore& score : result.scores)
    {
        context.exitCode = score.rpe ? context.exitCode : kExitIncomplete;
    }
}
}  // namespace

void addReproduceCommand(CLI::App& app, CommandContext& context)
{
    CLI::App& command = *app.add_subcommand(
        "reproduce", "The paper's Tables 1 and 2 and Fig. 3 on the TUM sequences of a folder");
    const auto options = std::make_shared<ReproduceCommand>();
    options->addTo(command);
    command.callback([options, &context] { options->run(context); });
}
}  // namespace pointplane
