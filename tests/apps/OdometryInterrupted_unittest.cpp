// SPDX-License-Identifier: BSD-3-Clause
// What a run leaves behind that could not finish.
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "OdometryApp.h"
#include "SmallDisk.h"
#include "TempDir.h"
#include "rawlog_samples.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
using test::readBytes;
using test::TempDir;
using test::writeBytes;

struct Ending
{
    int code{-1};
    std::string err;
};

class OdometryInterrupted : public testing::Test
{
 protected:
    [[nodiscard]] static Ending run(std::vector<std::string> args)
    {
        args.emplace_back("--quiet");
        std::ostringstream out, err;
        const int code = runOdometry(args, out, err);
        return {code, err.str()};
    }

    TempDir dir_;
    std::string in_{dir_ / "in.rawlog"};
    std::string out_{dir_ / "out.rawlog"};
};

TEST_F(OdometryInterrupted, aFullDiskIsExitCode3AndLeavesNothingThatLooksComplete)
{
    test::writeObservations(in_, 40);
    const std::string disk = dir_ / "disk";
    for (const char* option : {"-o", "--trajectory", "--diagnostics", "--simplemap", "--graph"})
    {
        int numFull = 0;
        for (const int kilobytes : {4, 16, 40, 4096})
        {
            const auto code = test::onSmallDisk(
                disk,
                kilobytes,
                [&]
                {
                    const std::string path = disk + "/out";
                    const Ending outcome = run({in_, option, path});
                    const bool complete = std::filesystem::exists(path);
                    const bool told =
                        outcome.err.find("No space left on device") != std::string::npos;
                    return complete ? outcome.code : told ? outcome.code : 99;
                });
            if (!code)
            {
                GTEST_SKIP() << "this user may not mount a disk";
            }
            EXPECT_TRUE(*code == kExitOk || *code == kExitEnvironment)
                << option << " with " << kilobytes << " kB: " << *code;
            EXPECT_TRUE(*code == kExitOk || kilobytes < 4096) << option;
            numFull += *code == kExitEnvironment ? 1 : 0;
        }
        const bool large = std::string(option) == "-o" || std::string(option) == "--simplemap";
        EXPECT_TRUE(numFull > 0 || !large) << option;
    }
}

/** The outputs of a run that is killed at some moment. */
class KilledOdometry : public OdometryInterrupted
{
 protected:
    [[nodiscard]] pid_t start()
    {
        const pid_t child = fork();
        if (child == 0)
        {
            (void)run({in_, "-o", out_, "--trajectory", trajectory_, "--jobs", "1"});
            ::_exit(0);
        }
        return child;
    }

    void expectOldOrComplete(const std::string& path, const std::string& complete)
    {
        const std::string bytes = readBytes(path);
        EXPECT_TRUE(bytes == kOld || bytes == complete) << path << ": " << bytes.size() << " bytes";
        writeBytes(path, kOld);
    }

    /** A partial rawlog says that it is one, unless it only waits for its name. */
    void expectReadablePartial(const std::string& complete)
    {
        const std::string path = out_ + ".partial";
        if (!std::filesystem::exists(path) || readBytes(path) == complete)
        {
            return;
        }
        try
        {
            const auto contents = test::readAll(path);
            EXPECT_EQ(contents.ending.kind, RawlogEnd::Truncated);
            numPartial_ += contents.objects.empty() ? 0 : 1;
        }
        catch (const InputError& error)  // killed before its first flush
        {
            EXPECT_THAT(
                error.what(),
                testing::AnyOf(
                    testing::HasSubstr("is empty"), testing::HasSubstr("truncated at byte")));
        }
    }

    static constexpr const char* kOld = "the previous file";
    std::string trajectory_{dir_ / "trajectory.txt"};
    int numPartial_{0};
};

TEST_F(KilledOdometry, aHundredMomentsLeaveNothingThatLooksCompleteAndIsNot)
{
    using Clock = std::chrono::steady_clock;
    test::writeObservations(in_, 150);
    const auto begin = Clock::now();
    int status = 0;
    ASSERT_EQ(waitpid(start(), &status, 0) > 0 && WIFEXITED(status), true);
    std::chrono::duration<double, std::micro> whole = Clock::now() - begin;
    const std::string rawlog = readBytes(out_), text = readBytes(trajectory_);
    ASSERT_GE(test::readAll(out_).objects.size(), 300U);  // a scan and a pose each
    writeBytes(out_, kOld);
    writeBytes(trajectory_, kOld);

    std::mt19937 rng(11);
    int numKilled = 0;
    for (int i = 0; numKilled < 100 && i < 1000; ++i)
    {
        const pid_t child = start();
        ASSERT_GE(child, 0);
        ::usleep(static_cast<useconds_t>(rng() % static_cast<unsigned>(whole.count())));
        ::kill(child, SIGKILL);
        ASSERT_EQ(waitpid(child, &status, 0), child);
        numKilled += WIFSIGNALED(status) ? 1 : 0;
        whole *= WIFSIGNALED(status) ? 1 : 0.95;  // the machine is faster than it was before
        expectReadablePartial(rawlog);
        expectOldOrComplete(out_, rawlog);
        expectOldOrComplete(trajectory_, text);
        std::filesystem::remove(out_ + ".partial");
        std::filesystem::remove(trajectory_ + ".partial");
    }
    EXPECT_EQ(numKilled, 100);
    EXPECT_GT(numPartial_, 20);
}
}  // namespace
}  // namespace pointplane
