// SPDX-License-Identifier: BSD-3-Clause
#include "lab_runs.h"

#include <pointplane/evaluation/trajectory_text.h>
#include <pointplane/evaluation/units.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/params_ini.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <ostream>
#include <thread>

#include "OutputGuard.h"
#include "mostly_predicted.h"
#include "result_output.h"
#include "run_processes.h"

namespace pointplane
{
namespace
{
LabScore scoreOf(
    const LabRun& run,
    const std::string& trajectory,
    const std::string& log,
    int exitCode,
    const RpeOptions& rpe)
{
    // Exit code 1 is a damaged rawlog: the trajectory is there up to the damage, but a score of it
    // beside those of whole sequences would mislead. A run of predicted frames is whole, and its
    // score says so.
    const std::string said = exitCode == kExitOk ? "" : lastLine(log);
    if (exitCode != kExitOk && said.rfind(kMostlyPredicted, 0) != 0)
    {
        return {{}, "pointplane-odometry: exit code " + std::to_string(exitCode) + ", " + said};
    }
    try
    {
        const Trajectory truth = readTrajectoryText(run.groundTruth);
        const Trajectory estimate = readTrajectoryText(trajectory);
        return {relativePoseError(truth, estimate, rpe), "", estimate};
    }
    catch (const std::exception& e)
    {
        return {{}, oneLine(e)};
    }
}

/** A file name out of a run's name. */
std::string fileName(std::size_t index, const std::string& name)
{
    constexpr std::size_t kLongest = 200;
    std::string out = format("%03zu_", index);
    for (const char c : name.substr(name.size() - std::min(name.size(), kLongest)))
    {
        out += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '=' ? c : '_';
    }
    return out;
}

std::vector<std::string> odometryCommand(
    const std::string& program, const LabRun& run, const std::string& trajectory)
{
    std::vector<std::string> out{
        program, run.rawlog, "--trajectory", trajectory, "--quiet", "--jobs", "1"};
    if (!run.config.empty())
    {
        out.insert(out.end(), {"-c", run.config});
    }
    for (const std::string& setting : run.settings)
    {
        out.insert(out.end(), {"--set", setting});
    }
    return out;
}

/** For each run the first one with the same rawlog and the same parameters: itself, or an earlier
 * one. What cannot be read is like nothing else; the odometry will say what is wrong with it. */
std::vector<std::size_t> firstAlike(const std::vector<LabRun>& runs)
{
    std::vector<std::size_t> out;
    std::map<std::string, std::size_t> known;
    for (std::size_t k = 0; k < runs.size(); ++k)
    {
        std::string key = std::to_string(k);
        try
        {
            OdometryParams params = loadOdometryParams(runs[k].config, runs[k].settings);
            key = runs[k].rawlog + "\n" + iniText(parametersOf(params));
        }
        catch (const std::exception&)
        {
        }
        out.push_back(known.emplace(key, k).first->second);
    }
    return out;
}

/** Of a rawlog: what the time of a run grows with. */
double sizeOf(const std::string& path)
{
    std::error_code error;
    const auto bytes = std::filesystem::file_size(path, error);
    return error ? 1.0 : 1.0 + static_cast<double>(bytes);
}

/** The runs that no earlier one is like, as processes. */
struct LabJobs
{
    std::vector<std::size_t> runs;
    std::vector<std::string> trajectories;  //!< that they write
    std::vector<ProcessJob> processes;
    double bytes{0};  //!< sizeOf() all
};

/** \param sameAs firstAlike() of the runs */
LabJobs jobsOf(
    const std::vector<LabRun>& runs,
    const std::vector<std::size_t>& sameAs,
    const std::string& program,
    const WorkDirectory& work)
{
    LabJobs out;
    for (std::size_t k = 0; k < runs.size(); ++k)
    {
        if (sameAs[k] == k)
        {
            const std::string base = fileName(k, runs[k].name);
            out.runs.push_back(k);
            out.trajectories.push_back(work.fileAt(base + ".txt"));
            out.processes.push_back(
                {odometryCommand(program, runs[k], out.trajectories.back()),
                 work.fileAt(base + ".log")});
            out.bytes += sizeOf(runs[k].rawlog);
        }
    }
    return out;
}

std::string temporaryFolder()
{
    std::error_code error;
    std::string path =
        (std::filesystem::temp_directory_path(error) / "pointplane-lab-XXXXXX").string();
    if (mkdtemp(path.data()) == nullptr)
    {
        throw EnvironmentError("cannot create the temporary directory '" + path + "'");
    }
    return path;
}
}  // namespace

WorkDirectory::WorkDirectory(const std::string& path)
    // Absolute, as its files are arguments of programs: "-x" is no option then.
    : folder_(path.empty() ? temporaryFolder() : std::filesystem::absolute(path).string()),
      temporary_(path.empty())
{
}

WorkDirectory::~WorkDirectory()
{
    if (temporary_)
    {
        std::error_code ignored;
        std::filesystem::remove_all(folder_.path(), ignored);
    }
}

void addScore(const LabScore& score, nlohmann::ordered_json& run)
{
    if (!score.rpe)
    {
        run["failure"] = score.failure;
        return;
    }
    run["translation"] = score.rpe->translation.rmse;
    run["rotationDeg"] = score.rpe->rotation.rmse * kDegreesPerRadian;
    run["pairs"] = score.rpe->translation.count;
    run["coverage"] = toJson(score.rpe->coverage);
}

std::string scoreFields(const LabScore& score)
{
    return score.rpe ? format(
                           "%zu,%.6g,%zu,%zu,%.9g,%.9g,\n",
                           score.rpe->translation.count,
                           score.rpe->coverage.share,
                           score.rpe->coverage.predicted,
                           score.rpe->coverage.lost,
                           score.rpe->translation.rmse,
                           score.rpe->rotation.rmse * kDegreesPerRadian)
                     : ",,,,,," + csvField(score.failure) + "\n";
}

std::string unmeasuredText(const LabScore& score, const ScoreWords& words)
{
    if (!score.rpe)
    {
        return "";
    }
    const Coverage& coverage = score.rpe->coverage;
    std::string out = coverage.lost > 0 ? format("%zu %s", coverage.lost, words.lost) : "";
    if (coverage.predicted > 0)
    {
        out += (out.empty() ? "" : ", ") + format("%zu %s", coverage.predicted, words.predicted);
    }
    return out.empty() ? "" : " (" + out + ")";
}

std::string scoreText(const LabScore& score, const ScoreWords& words)
{
    return score.rpe ? format(
                           "%.1f%s / %.2f%s",
                           1000 * score.rpe->translation.rmse,
                           words.mm,
                           kDegreesPerRadian * score.rpe->rotation.rmse,
                           words.deg) +
                           unmeasuredText(score, words)
                     : "failed";
}

void LabRunner::addTo(CLI::App& command)
{
    command
        .add_option(
            "--odometry", odometry, "The pointplane-odometry to run (default: beside this program)")
        ->type_name("PROGRAM")
        ->group("Runs");
    command.add_option("--jobs", jobs, "Runs at a time; 0: one per core")
        ->capture_default_str()
        ->group("Runs");
    command
        .add_option("--keep", directory, "Keep trajectories and logs of all runs in this folder")
        ->type_name("DIR")
        ->group("Runs");
}

void LabRunner::guardedBy(OutputGuard& guard) const
{
    guard.addInput(odometry);
    for (const char* extension : {".txt", ".log", ".rawlog"})
    {
        guard.addOutputFolder("--keep", directory, extension);
    }
}

std::size_t LabRunner::parallel() const
{
    return jobs > 0 ? jobs : std::max(1U, std::thread::hardware_concurrency());
}

std::string LabRunner::program() const
{
    return odometry.empty() ? siblingProgram("pointplane-odometry") : odometry;
}

void LabRunner::requireProgram() const
{
    constexpr int kNotStarted = 127;
    bool isThere = false;
    runProcesses(
        {{{program(), "--version"}, "/dev/null"}},
        1,
        [&](std::size_t, int exitCode) { isThere = exitCode != kNotStarted; });
    if (!isThere)
    {
        throw InputError("cannot run '" + program() + "'; name the program by --odometry");
    }
}

std::vector<LabScore> LabRunner::run(
    const std::vector<LabRun>& runs,
    const RpeOptions& rpe,
    const WorkDirectory& work,
    std::ostream& err) const
{
    const std::vector<std::size_t> sameAs = firstAlike(runs);
    const LabJobs made = jobsOf(runs, sameAs, program(), work);
    std::vector<LabScore> scores(runs.size());
    double bytesLeft = made.bytes;
    std::size_t done = 0;
    const auto start = std::chrono::steady_clock::now();
    runProcesses(
        made.processes,
        parallel(),
        [&](std::size_t job, int exitCode)
        {
            const LabRun& run = runs[made.runs[job]];
            LabScore& score = scores[made.runs[job]];
            score =
                scoreOf(run, made.trajectories[job], made.processes[job].logPath, exitCode, rpe);
            ++done;
            bytesLeft -= sizeOf(run.rawlog);
            const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
            const double left = elapsed.count() * bytesLeft / std::max(1.0, made.bytes - bytesLeft);
            err << format(
                       "[%zu/%zu, %.0f s left] %s: ",
                       done,
                       made.runs.size(),
                       left,
                       run.name.c_str())
                << scoreText(score) << (score.rpe ? "" : " (" + score.failure + ")") << std::endl;
        });
    for (std::size_t k = 0; k < runs.size(); ++k)
    {
        scores[k] = scores[sameAs[k]];
    }
    return scores;
}

std::string failuresOf(const std::vector<LabRun>& runs, const std::vector<LabScore>& scores)
{
    const auto isFailed = [](const LabScore& score) { return !score.rpe; };
    const auto first = std::find_if(scores.begin(), scores.end(), isFailed);
    return first == scores.end()
               ? ""
               : std::to_string(std::count_if(first, scores.end(), isFailed)) + " of " +
                     std::to_string(scores.size()) + " runs failed, first " +
                     runs[static_cast<std::size_t>(first - scores.begin())].name + ": " +
                     first->failure;
}
}  // namespace pointplane
