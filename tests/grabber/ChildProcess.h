// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <csignal>
#include <map>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "TempDir.h"
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pointplane::test
{
/** A program that runs beside the test. */
class ChildProcess
{
 public:
    using Environment = std::map<std::string, std::string>;

    ChildProcess(
        const std::string& program, const std::vector<std::string>& args, const Environment& extra)
    {
        std::vector<std::string> environment;
        for (char** entry = environ; *entry != nullptr; ++entry)
        {
            const std::string text = *entry;
            if (extra.count(text.substr(0, text.find('='))) == 0)
            {
                environment.push_back(text);
            }
        }
        for (const auto& [key, value] : extra)
        {
            environment.push_back(key + "=" + value);
        }
        std::vector<std::string> words{program};
        words.insert(words.end(), args.begin(), args.end());

        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
        posix_spawn_file_actions_addopen(&files, 0, "/dev/null", O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&files, 1, outPath_.c_str(), kFlags, 0644);
        posix_spawn_file_actions_addopen(&files, 2, errPath_.c_str(), kFlags, 0644);
        const int error = posix_spawn(
            &pid_,
            program.c_str(),
            &files,
            nullptr,
            pointers(words).data(),
            pointers(environment).data());
        posix_spawn_file_actions_destroy(&files);
        if (error != 0)
        {
            throw std::runtime_error("cannot start " + program);
        }
    }

    ~ChildProcess()
    {
        if (pid_ > 0)
        {
            ::kill(pid_, SIGKILL);
            ::waitpid(pid_, nullptr, 0);
        }
    }
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    [[nodiscard]] pid_t pid() const { return pid_; }

    void signal(int number) const { ::kill(pid_, number); }

    /** \return exit code; 128 + signal number when killed; -1 when it does not end in time */
    [[nodiscard]] int wait(std::chrono::milliseconds limit = std::chrono::seconds(60))
    {
        const auto deadline = std::chrono::steady_clock::now() + limit;
        while (std::chrono::steady_clock::now() < deadline)
        {
            int status = 0;
            if (::waitpid(pid_, &status, WNOHANG) == pid_)
            {
                pid_ = -1;
                return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return -1;
    }

    [[nodiscard]] std::string out() const { return readBytes(outPath_); }
    [[nodiscard]] std::string err() const { return readBytes(errPath_); }

 private:
    static std::vector<char*> pointers(std::vector<std::string>& words)
    {
        std::vector<char*> result;
        for (auto& word : words)
        {
            result.push_back(word.data());
        }
        result.push_back(nullptr);
        return result;
    }

    TempDir dir_;
    std::string outPath_{dir_ / "out"}, errPath_{dir_ / "err"};
    pid_t pid_{-1};
};
}  // namespace pointplane::test
