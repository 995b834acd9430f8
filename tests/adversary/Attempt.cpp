// SPDX-License-Identifier: BSD-3-Clause
#include "Attempt.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <future>
#include <sstream>
#include <system_error>

#include "SmallDisk.h"
#include "run_program.h"
#include <fcntl.h>
#include <sys/resource.h>

namespace pointplane::adversary
{
namespace
{
constexpr unsigned kProcessorSeconds = 60;  // of one that is busy
constexpr unsigned kSeconds = 600;          // of one that waits; the machine may be busy otherwise

/** What a process writes to a stream, read while it runs: it may write more than a pipe holds, and
 * a limit on the size of files is none on this. */
class Stream
{
 public:
    Stream()
    {
        if (::pipe2(ends_, O_CLOEXEC) != 0)
        {
            throw std::system_error(errno, std::generic_category(), "no pipe");
        }
        text_ = std::async(std::launch::async, [this] { return read(); });
    }
    [[nodiscard]] int writeEnd() const { return ends_[1]; }
    /** When the process has ended. */
    [[nodiscard]] std::string text()
    {
        ::close(ends_[1]);
        std::string out = text_.get();
        ::close(ends_[0]);
        return out;
    }

 private:
    [[nodiscard]] std::string read() const
    {
        std::string out;
        char buffer[4096];
        for (ssize_t n = 0; (n = ::read(ends_[0], buffer, sizeof(buffer))) > 0;)
        {
            out.append(buffer, static_cast<std::size_t>(n));
        }
        return out;
    }

    int ends_[2]{-1, -1};
    std::future<std::string> text_;
};

void limit(decltype(RLIMIT_AS) what, std::uint64_t bytes)
{
    const rlimit value{bytes, bytes};
    ::setrlimit(what, &value);
}

/** In the new process. */
void enter(const Surroundings& s)
{
    ::alarm(kSeconds);
    for (const auto& [key, value] : s.environment)
    {
        ::setenv(key.c_str(), value.c_str(), 1);
    }
    if (!s.folder.empty() && ::chdir(s.folder.c_str()) != 0)
    {
        ::_exit(1);
    }
    limit(RLIMIT_CPU, kProcessorSeconds);
    limit(RLIMIT_AS, s.memory);
    if (s.stack)
    {
        limit(RLIMIT_STACK, *s.stack);
    }
    if (s.fileSize)
    {
        limit(RLIMIT_FSIZE, *s.fileSize);
    }
}

/** \return the exit code, or 128 + the signal that ended it */
[[nodiscard]] int inProcess(const std::function<int()>& body)
{
    const pid_t child = ::fork();
    if (child == 0)
    {
        ::_exit(body());
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/** The same where the surroundings say. \return nothing: this user may not mount a disk */
[[nodiscard]] std::optional<int> inProcess(const Surroundings& s, const std::function<int()>& body)
{
    if (s.disk.empty())
    {
        return inProcess(body);
    }
    const auto onDisk = [&]
    {
        const int code = inProcess(body);
        if (!s.leaves.empty())
        {
            std::filesystem::copy(s.disk, s.leaves, std::filesystem::copy_options::recursive);
        }
        return code;
    };
    return test::onSmallDisk(s.disk, s.kilobytes, onDisk);
}

/** \param start takes the place of the process, or returns its exit code */
[[nodiscard]] Attempt attemptBy(
    const std::function<int(int argc, char** argv)>& start,
    std::vector<std::string> args,
    const Surroundings& surroundings)
{
    args.insert(args.begin(), "pointplane");
    std::vector<char*> argv;
    for (std::string& arg : args)
    {
        argv.push_back(arg.data());
    }
    argv.push_back(nullptr);
    Stream out, err;
    const auto code = inProcess(
        surroundings,
        [&]
        {
            ::dup2(out.writeEnd(), STDOUT_FILENO);
            ::dup2(err.writeEnd(), STDERR_FILENO);
            enter(surroundings);
            return start(static_cast<int>(args.size()), argv.data());
        });
    Attempt result;
    result.code = code.value_or(-1);
    result.signal = std::max(0, result.code - 128);
    result.out = out.text();
    result.err = err.text();
    return result;
}
}  // namespace

Attempt attempt(App app, const std::vector<std::string>& args, const Surroundings& surroundings)
{
    return attemptBy(
        [app](int argc, char** argv) { return runProgram("pointplane", app, argc, argv); },
        args,
        surroundings);
}

Attempt attemptOf(
    const std::string& program,
    const std::vector<std::string>& args,
    const Surroundings& surroundings)
{
    const std::string path = std::string(PROGRAMS) + "/pointplane-" + program;
    return attemptBy(
        [&path](int, char** argv)
        {
            ::execv(path.c_str(), argv);
            return 126;
        },
        args,
        surroundings);
}

std::string unless(bool good, const std::string& problem) { return good ? "" : problem; }

std::string wrongWith(const Attempt& a)
{
    if (a.signal != 0)
    {
        return "signal " + std::to_string(a.signal);
    }
    if (a.code < 0 || a.code > 3)
    {
        return "exit code " + std::to_string(a.code);
    }
    const auto lines = std::count(a.err.begin(), a.err.end(), '\n');
    return unless(a.code == 0 || lines == 1, std::to_string(lines) + " lines: " + a.err);
}

std::string wrongWithOwnLines(const Attempt& a)
{
    Attempt told = a;
    told.err.clear();
    std::istringstream lines(a.err);
    for (std::string line; std::getline(lines, line);)
    {
        told.err += line.rfind("pointplane", 0) == 0 ? line + "\n" : "";
    }
    return wrongWith(told.err.empty() ? a : told);
}

void Tally::add(const Attempt& attempt, const std::string& wrong, const std::string& name)
{
    ++tried_;
    const std::string problem = wrong.empty() && attempt.signal != 0 ? wrongWith(attempt) : wrong;
    if (!problem.empty())
    {
        failures_.push_back(what_ + ": " + name + ": " + problem);
    }
}

std::string Tally::header() { return "| tried | number | wrong |\n|---|---|---|\n"; }

std::string Tally::row() const
{
    return "| " + what_ + " | " + std::to_string(tried_) + " | " +
           std::to_string(failures_.size()) + " |\n";
}
std::vector<std::string> recorder(int frames, const std::vector<std::string>& more)
{
    std::vector<std::string> out{
        "--driver",
        "openni2",
        "--mode",
        "64x48@30",
        "--warm-up",
        "0.2",
        "--quiet",
        "--frames",
        std::to_string(frames)};
    out.insert(out.end(), more.begin(), more.end());
    return out;
}
}  // namespace pointplane::adversary
