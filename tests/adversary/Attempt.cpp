// SPDX-License-Identifier: BSD-3-Clause
#include "Attempt.h"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <sstream>

#include "SmallDisk.h"
#include "TempDir.h"
#include <sys/resource.h>

namespace pointplane::adversary
{
namespace
{
constexpr unsigned kSeconds = 60;
constexpr rlim_t kBytes = 4ULL << 30U;

int runLimited(App app, const std::vector<std::string>& args, const std::string& report)
{
    ::alarm(kSeconds);
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit memory{kBytes, kBytes};
    ::setrlimit(RLIMIT_AS, &memory);
    std::ostringstream out, err;
    const int code = app(args, out, err);
    test::writeBytes(report + ".out", out.str());
    test::writeBytes(report + ".err", err.str());
    return code;
}
}  // namespace

Attempt attempt(
    App app, const std::vector<std::string>& args, const std::string& smallDisk, int kilobytes)
{
    static const test::TempDir dir;
    const std::string report = dir / "report";
    std::filesystem::remove(report + ".out");
    std::filesystem::remove(report + ".err");
    Attempt result;
    if (!smallDisk.empty())
    {
        const auto code =
            test::onSmallDisk(smallDisk, kilobytes, [&] { return runLimited(app, args, report); });
        result.code = code.value_or(-1);
        result.signal = std::max(0, result.code - 128);
    }
    else
    {
        const pid_t child = ::fork();
        if (child == 0)
        {
            ::_exit(runLimited(app, args, report));
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        result.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    }
    result.out = test::readBytes(report + ".out");
    result.err = test::readBytes(report + ".err");
    return result;
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

void Tally::add(const Attempt& attempt, const std::string& wrong, const std::string& name)
{
    ++tried_;
    crashes_ += attempt.signal != 0 ? 1 : 0;
    ++codes_[attempt.code];
    if (!wrong.empty())
    {
        failures_.push_back(what_ + ": " + name + ": " + wrong);
    }
}

std::string Tally::header()
{
    return "| tried | number | exit code 0 | 1 | 2 | 3 | crashed or hung | wrong code, text or "
           "files |\n"
           "|---|---|---|---|---|---|---|---|\n";
}

std::string Tally::row() const
{
    std::string out = "| " + what_ + " | " + std::to_string(tried_);
    for (const int code : {0, 1, 2, 3})
    {
        const auto it = codes_.find(code);
        out += " | " + std::to_string(it == codes_.end() ? 0 : it->second);
    }
    return out + " | " + std::to_string(crashes_) + " | " + std::to_string(failures_.size()) +
           " |\n";
}
}  // namespace pointplane::adversary
