// SPDX-License-Identifier: BSD-3-Clause
// A program and the streams that it is given.
#include <pointplane/mrpt_io/errors.h>

#include <filesystem>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "OdometryApp.h"
#include "TempDir.h"
#include "rawlog_samples.h"
#include "run_program.h"
#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
using test::readBytes;

class RunProgram : public testing::Test
{
 protected:
    void SetUp() override { test::writeObservations(in_, 3); }

    /** pointplane-odometry in a process of its own. \param prepare its streams */
    [[nodiscard]] int run(std::vector<std::string> args, const std::function<void()>& prepare)
    {
        args.insert(args.begin(), {"pointplane-odometry", in_});
        std::vector<char*> words;
        for (std::string& arg : args)
        {
            words.push_back(arg.data());
        }
        const pid_t child = ::fork();
        if (child == 0)
        {
            prepare();
            const int argc = static_cast<int>(words.size());
            ::_exit(runProgram("pointplane-odometry", runOdometry, argc, words.data()));
        }
        int status = 0;
        ::waitpid(child, &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }

    test::TempDir dir_;
    std::string in_{dir_ / "in.rawlog"};
    std::string rawlog_{dir_ / "out.rawlog"}, text_{dir_ / "out.txt"};
    std::vector<std::string> outputs_{"-o", rawlog_, "--trajectory", text_};
};

TEST_F(RunProgram, closedStreamsAreNotWrittenIntoFiles)
{
    ASSERT_EQ(run(outputs_, [] {}), kExitOk);
    const std::string rawlog = readBytes(rawlog_), text = readBytes(text_);
    ASSERT_FALSE(text.empty());
    for (const std::vector<int>& closed : {std::vector<int>{1}, {2}, {0, 1, 2}})
    {
        const auto close = [&closed]
        {
            for (const int fd : closed)
            {
                ::close(fd);
            }
        };
        EXPECT_EQ(run(outputs_, close), kExitOk);
        EXPECT_EQ(readBytes(rawlog_), rawlog);
        EXPECT_EQ(readBytes(text_), text);
    }
}

/** As `--trajectory /dev/stdout > file`: what is told goes to the standard error then. */
TEST_F(RunProgram, anOutputToTheStandardOutputIsAloneThere)
{
    const std::string link = dir_ / "stdout", file = dir_ / "file", told = dir_ / "told";
    std::filesystem::create_symlink("/proc/self/fd/1", link);
    const auto redirected = [&](int errorsTo)
    {
        ::dup2(::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO);
        ::dup2(errorsTo >= 0 ? errorsTo : ::open(told.c_str(), O_WRONLY | O_CREAT, 0600), 2);
    };
    ASSERT_EQ(run({"--trajectory", text_, "--quiet"}, [] {}), kExitOk);
    ASSERT_EQ(run({"--trajectory", link, "--quiet"}, [&] { redirected(-1); }), kExitOk);
    EXPECT_EQ(readBytes(file), readBytes(text_));
    EXPECT_NE(readBytes(told).find("3 frames"), std::string::npos);
    // Both streams into one file: the summary comes after, and over nothing.
    ASSERT_EQ(run({"--trajectory", link, "--quiet"}, [&] { redirected(1); }), kExitOk);
    EXPECT_EQ(readBytes(file).rfind(readBytes(text_), 0), 0U);
    EXPECT_NE(readBytes(file).find("3 frames"), std::string::npos);
}

TEST(RunCommand, whatTheSystemRefusesIsExitCode3)
{
    const auto codeOf = [](const std::string& problem)
    {
        CLI::App app;
        std::ostringstream out, err;
        return runCommand(app, {}, out, err, [&]() -> int { throw std::runtime_error(problem); });
    };
    EXPECT_EQ(
        codeOf("pthread_create has failed: Resource temporarily unavailable"), kExitEnvironment);
    EXPECT_EQ(codeOf("something else"), kExitBadInput);
}

TEST_F(RunProgram, aReaderThatLeavesEndsNoRun)
{
    ASSERT_EQ(run(outputs_, [] {}), kExitOk);
    const std::string rawlog = readBytes(rawlog_), text = readBytes(text_);
    test::writeBytes(rawlog_, "old");
    test::writeBytes(text_, "old");
    const auto intoNowhere = []
    {
        int ends[2] = {-1, -1};
        (void)!::pipe(ends);
        ::dup2(ends[1], STDOUT_FILENO);
        ::dup2(ends[1], STDERR_FILENO);
        ::close(ends[0]);
        ::close(ends[1]);
    };
    EXPECT_EQ(run(outputs_, intoNowhere), kExitEnvironment);
    EXPECT_EQ(readBytes(rawlog_), rawlog);
    EXPECT_EQ(readBytes(text_), text);
}
}  // namespace
}  // namespace pointplane
