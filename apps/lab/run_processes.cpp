// SPDX-License-Identifier: BSD-3-Clause
#include "run_processes.h"

#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <future>
#include <mutex>
#include <thread>

#include "StopSignals.h"
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
constexpr int kNotStarted = 127;  // as a shell
constexpr std::chrono::milliseconds kBetweenLooks{5};

/** Its exit code; a request to stop ends it. */
int waitFor(pid_t pid)
{
    int status = 0;
    bool isAsked = false;
    for (pid_t ended = 0; ended != pid; ended = ::waitpid(pid, &status, WNOHANG))
    {
        if (ended < 0 && errno != EINTR)
        {
            return kNotStarted;
        }
        if (stopRequested() && !isAsked)
        {
            ::kill(pid, SIGTERM);
            isAsked = true;
        }
        std::this_thread::sleep_for(kBetweenLooks);
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int runOne(const ProcessJob& job)
{
    std::vector<char*> argv;
    for (const std::string& arg : job.command)
    {
        argv.push_back(const_cast<char*>(arg.c_str()));  // posix_spawn does not write to them
    }
    argv.push_back(nullptr);

    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(
        &actions, STDOUT_FILENO, job.logPath.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    pid_t pid = 0;
    const int error = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0)
    {
        return kNotStarted;
    }
    return waitFor(pid);
}
}  // namespace

void runProcesses(
    const std::vector<ProcessJob>& jobs,
    std::size_t parallel,
    const std::function<void(std::size_t job, int exitCode)>& onDone)
{
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    const auto work = [&]
    {
        for (std::size_t k = next++; k < jobs.size(); k = next++)
        {
            const int exitCode = runOne(jobs[k]);
            if (stopRequested())
            {
                return;
            }
            const std::lock_guard<std::mutex> lock(mutex);
            try
            {
                if (onDone)
                {
                    onDone(k, exitCode);
                }
            }
            catch (...)
            {
                next = jobs.size();
                throw;
            }
        }
    };
    std::vector<std::future<void>> workers;
    for (std::size_t k = 0; k < std::min(std::max<std::size_t>(parallel, 1), jobs.size()); ++k)
    {
        workers.push_back(std::async(std::launch::async, work));
    }
    std::for_each(workers.begin(), workers.end(), [](auto& worker) { worker.get(); });
    if (stopRequested())
    {
        throw EnvironmentError("stopped by a signal; results of the runs are not written");
    }
}

std::string siblingProgram(const std::string& name)
{
    std::error_code error;
    const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
    const std::filesystem::path beside = self.parent_path() / name;
    return !error && std::filesystem::exists(beside, error) ? beside.string() : name;
}

std::string lastLine(const std::string& path)
{
    std::ifstream file(path);
    std::string last;
    for (std::string line; std::getline(file, line);)
    {
        last = line.empty() ? last : line;
    }
    return last;
}
}  // namespace pointplane
