// SPDX-License-Identifier: BSD-3-Clause
#include "OdometryRuns.h"

#include <pointplane/evaluation/trajectory_text.h>
#include <pointplane/evaluation/units.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <thread>

#include "result_output.h"
#include "run_processes.h"

namespace pointplane
{
namespace
{
OdometryScore scoreOf(
    const OdometryRun& run,
    const std::string& trajectory,
    const std::string& log,
    int exitCode,
    const RpeOptions& rpe)
{
    // Exit code 1 is a damaged rawlog: the trajectory is there up to the damage, but a score of it
    // beside those of whole sequences would mislead.
    if (exitCode != kExitOk)
    {
        return {
            {},
            "pointplane-odometry: exit code " + std::to_string(exitCode) + ", " + lastLine(log)};
    }
    try
    {
        return {
            relativePoseError(
                readTrajectoryText(run.groundTruth), readTrajectoryText(trajectory), rpe),
            ""};
    }
    catch (const std::exception& e)
    {
        return {{}, oneLine(e)};
    }
}

/** A file name out of a run's name. */
std::string fileName(std::size_t index, const std::string& name)
{
    std::string out = format("%03zu_", index);
    for (const char c : name)
    {
        out += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '=' ? c : '_';
    }
    return out;
}
}  // namespace

WorkDirectory::WorkDirectory(const std::string& path) : path_(path), temporary_(path.empty())
{
    std::error_code error;
    if (temporary_)
    {
        path_ = (std::filesystem::temp_directory_path(error) / "pointplane-eval-XXXXXX").string();
        if (mkdtemp(path_.data()) == nullptr)
        {
            throw EnvironmentError("cannot create the temporary directory '" + path_ + "'");
        }
    }
    std::filesystem::create_directories(path_, error);
    if (!std::filesystem::is_directory(path_, error))
    {
        throw EnvironmentError("cannot create the directory '" + path_ + "'");
    }
}

WorkDirectory::~WorkDirectory()
{
    if (temporary_)
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
}

std::string scoreText(const OdometryScore& score)
{
    return score.rpe ? format(
                           "%.1f mm / %.2f deg",
                           1000 * score.rpe->translation.rmse,
                           kDegreesPerRadian * score.rpe->rotation.rmse)
                     : "failed";
}

void OdometryRunner::addTo(CLI::App& command)
{
    command
        .add_option("--odometry", odometry, "The pointplane-odometry to run [beside this program]")
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

std::vector<OdometryScore> OdometryRunner::run(
    const std::vector<OdometryRun>& runs, const RpeOptions& rpe, std::ostream& err) const
{
    const WorkDirectory work(directory);
    const std::string program = odometry.empty() ? siblingProgram("pointplane-odometry") : odometry;
    std::vector<ProcessJob> processes;
    std::vector<std::string> trajectories;
    for (std::size_t k = 0; k < runs.size(); ++k)
    {
        const OdometryRun& r = runs[k];
        const std::string base = work.path() + "/" + fileName(k, r.name);
        trajectories.push_back(base + ".txt");
        ProcessJob job;
        job.logPath = base + ".log";
        job.command = {
            program, r.rawlog, "--trajectory", trajectories.back(), "--quiet", "--jobs", "1"};
        if (!r.config.empty())
        {
            job.command.insert(job.command.end(), {"-c", r.config});
        }
        for (const std::string& setting : r.settings)
        {
            job.command.insert(job.command.end(), {"--set", setting});
        }
        processes.push_back(std::move(job));
    }

    std::vector<OdometryScore> scores(runs.size());
    std::size_t done = 0;
    bool missing = false;
    const auto start = std::chrono::steady_clock::now();
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    runProcesses(
        processes,
        jobs > 0 ? jobs : cores,
        [&](std::size_t k, int exitCode)
        {
            missing = missing || exitCode == 127;
            scores[k] = scoreOf(runs[k], trajectories[k], processes[k].logPath, exitCode, rpe);
            ++done;
            const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
            const double left = elapsed.count() / static_cast<double>(done) *
                                static_cast<double>(runs.size() - done);
            err << format(
                       "[%zu/%zu, %.0f s left] %s: ", done, runs.size(), left, runs[k].name.c_str())
                << scoreText(scores[k]) << (scores[k].rpe ? "" : " (" + scores[k].failure + ")")
                << std::endl;
        });
    if (missing)
    {
        throw InputError("cannot run '" + program + "'; name the program by --odometry");
    }
    return scores;
}
}  // namespace pointplane
