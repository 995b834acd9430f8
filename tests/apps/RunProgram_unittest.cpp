// SPDX-License-Identifier: BSD-3-Clause
// A program and the streams that it is given.
#include <pointplane/mrpt_io/errors.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "EvalApp.h"
#include "HelpFormatter.h"
#include "OdometryApp.h"
#include "ProgressBar.h"
#include "SimulateApp.h"
#include "TempDir.h"
#include "number_checks.h"
#include "rawlog_samples.h"
#include "run_program.h"
#include "standard_streams.h"
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
        args.insert(args.begin(), in_);
        return run(runOdometry, args, prepare);
    }

    [[nodiscard]] static int run(
        Program program, std::vector<std::string> args, const std::function<void()>& prepare)
    {
        args.insert(args.begin(), "pointplane");
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
            ::_exit(runProgram("pointplane", program, argc, words.data()));
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

/** As `>&-`: what was asked for did not arrive. */
TEST_F(RunProgram, aClosedStandardOutputTakesNoResult)
{
    ASSERT_EQ(run(outputs_, [] {}), kExitOk);
    const std::string link = dir_ / "stdout", told = dir_ / "told", json = dir_ / "out.json";
    std::filesystem::create_symlink("/proc/self/fd/1", link);
    const auto codeOf = [&](Program program, const std::vector<std::string>& args)
    {
        return run(
            program,
            args,
            [&]
            {
                ::dup2(::open(told.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
                ::close(STDOUT_FILENO);
            });
    };
    const std::vector<std::string> ate{"ate", text_, text_};
    const auto with = [&](std::vector<std::string> more)
    {
        more.insert(more.begin(), ate.begin(), ate.end());
        return more;
    };
    const std::vector<std::pair<Program, std::vector<std::string>>> lost{
        {runEval, ate},
        {runEval, with({"--json", "-"})},
        {runEval, with({"--csv", json, "--save", link})},
        {runEval, with({"--verbose", "--json", json})},
        {runOdometry, {"--dump-config"}},
        {runOdometry, {in_, "--trajectory", link}},
        {runSimulate, {"--list-settings"}}};
    for (const auto& [program, args] : lost)
    {
        EXPECT_EQ(codeOf(program, args), kExitEnvironment) << args.back();
        EXPECT_EQ(
            readBytes(told),
            "pointplane" +
                std::string(
                    program == runEval       ? "-eval"
                    : program == runOdometry ? "-odometry"
                                             : "-simulate") +
                ": cannot write to the standard output: it is closed\n")
            << args.back();
    }
    EXPECT_FALSE(std::filesystem::exists(json));
    // What was asked for goes elsewhere.
    EXPECT_EQ(codeOf(runEval, with({"--json", json})), kExitOk) << readBytes(told);
    EXPECT_TRUE(std::filesystem::exists(json));
    EXPECT_EQ(codeOf(runOdometry, {in_, "--trajectory", "/dev/null"}), kExitOk) << readBytes(told);
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
    const auto codeOf = [](const auto& problem)
    {
        CLI::App app;
        std::ostringstream out, err;
        return runCommand(app, {}, out, err, [&]() -> int { throw problem; });
    };
    EXPECT_EQ(codeOf(std::system_error(EAGAIN, std::generic_category())), kExitEnvironment);
    EXPECT_EQ(codeOf(std::runtime_error("something else")), kExitBadInput);
    EXPECT_EQ(codeOf(std::invalid_argument("an option")), kExitBadInput);
}

/** The user did nothing wrong, and is told so. */
TEST(RunCommand, wordsThatAreNotExpectedAreToldInTheirOrder)
{
    const auto errorOf = [](auto app, const std::vector<std::string>& args)
    {
        std::ostringstream out, err;
        EXPECT_EQ(app(args, out, err), kExitBadInput);
        return err.str();
    };
    EXPECT_EQ(
        errorOf(runEval, {"rpe", "a.txt", "b.txt", "c.txt", "d.txt"}),
        "pointplane-eval: not expected: c.txt d.txt (see --help)\n");
    EXPECT_EQ(
        errorOf(runSimulate, {"desk", "-o", "a.rawlog", "-delta", "x"}),
        "pointplane-simulate: not expected: -delta x (see --help)\n");
    const std::string before =
        " stands before the command; options of a command come after its name (see --help)\n";
    EXPECT_EQ(
        errorOf(runEval, {"--delta", "1", "rpe", "--fixed-delta", "a.txt", "b.txt"}),
        "pointplane-eval: --delta" + before);
    EXPECT_EQ(
        errorOf(runEval, {"--json", "a", "rpe", "b.txt"}), "pointplane-eval: --json" + before);
}

TEST(RunCommand, aBugIsNotTheUsersMistake)
{
    CLI::App app{"", "pointplane"};
    std::ostringstream out, err;
    const int code =
        runCommand(app, {}, out, err, []() -> int { throw std::out_of_range("map::at"); });
    EXPECT_EQ(code, kExitEnvironment);
    EXPECT_EQ(err.str(), "pointplane: internal error: map::at\n");
}

TEST(RunCommand, wholeNumbersAreThoseThatWereGiven)
{
    struct Numbers
    {
        std::uint64_t seed{7};
        std::int64_t shift{0};
        std::size_t first{0};
        int jobs{0};
    };
    std::string told;
    const auto parsed = [&told](const std::vector<std::string>& args) -> std::optional<Numbers>
    {
        CLI::App app;
        Numbers out;
        app.add_option("--seed", out.seed);
        app.add_option("--shift", out.shift)->capture_default_str();
        app.add_option("--first", out.first)->check(isNotNegative());
        app.add_option("--jobs", out.jobs)->check(CLI::Range(-64, 64));
        std::ostringstream none, err;
        const int code = runCommand(app, args, none, err, [] { return kExitOk; });
        told = err.str();
        EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), code == kExitOk ? 0 : 1) << told;
        EXPECT_TRUE(code == kExitOk || code == kExitBadInput);
        return code == kExitOk ? std::optional(out) : std::nullopt;
    };
    for (const char* option : {"--seed", "--shift", "--first", "--jobs"})
    {
        for (const char* value :
             {"100000000000000000000", "1e3", "0.5", "0x10", "abc", "", "-", "1 2", "1,0"})
        {
            EXPECT_FALSE(parsed({option, value})) << option << " " << value;
        }
    }
    for (const char* option : {"--seed", "--first"})
    {
        EXPECT_FALSE(parsed({option, "-1"})) << option;
        EXPECT_NE(told.find("'-1' is not zero or a positive number"), std::string::npos) << told;
    }
    EXPECT_FALSE(parsed({"--shift", "9223372036854775808"}));
    EXPECT_NE(told.find("'9223372036854775808' is too large a number"), std::string::npos) << told;
    EXPECT_EQ(parsed({"--seed", "18446744073709551615"})->seed, 18446744073709551615U);
    EXPECT_EQ(parsed({"--shift", "-9223372036854775808"})->shift, INT64_MIN);
    EXPECT_EQ(parsed({"--first", "010"})->first, 10U);
    EXPECT_EQ(parsed({"--first", "-0"})->first, 0U);
    EXPECT_EQ(parsed({"--jobs", "+08"})->jobs, 8);
    EXPECT_EQ(parsed({"--jobs=-3"})->jobs, -3);
    EXPECT_FALSE(parsed({"--jobs", "2", "--jobs", "3"}));
    EXPECT_NE(told.find(": --jobs is given more than once (see --help)"), std::string::npos)
        << told;
}

TEST(RunCommand, helpFitsTheTerminal)
{
    const std::string help =
        "  --mask FILE                 Image that is black where the camera sees the robot: left "
        "out\n"
        "                                corner: a room corner, three planes with a little "
        "texture\n";
    EXPECT_EQ(
        wrappedHelp(help, 80, 30),
        "  --mask FILE                 Image that is black where the camera sees the\n"
        "                              robot: left out\n"
        "                                corner: a room corner, three planes with a\n"
        "                                little texture\n");
    EXPECT_EQ(wrappedHelp(help, 0, 30), help) << "no terminal";
    EXPECT_EQ(wrappedHelp(help, 40, 30), help) << "too narrow to be of use";
    const std::string path = "  --x " + std::string(90, 'x') + "\n";
    EXPECT_EQ(wrappedHelp(path, 80, 30), path);
}

TEST(RunCommand, helpFitsTheColumnsThatAreAskedFor)
{
    ::setenv("COLUMNS", "72", 1);
    EXPECT_EQ(helpColumns(), 72U);
    ::setenv("COLUMNS", "0", 1);
    EXPECT_EQ(helpColumns(), 0U);
    ::unsetenv("COLUMNS");
}

TEST(RunCommand, linesThatAreRedrawnFitTheTerminal)
{
    const std::string rest = ": 50 %  10 frames";
    EXPECT_EQ(lineOf("in.rawlog", rest, 80), "in.rawlog" + rest);
    EXPECT_EQ(lineOf("/a/long/way/to/in.rawlog", rest, 31), ".../in.rawlog: 50 %  10 frames");
    EXPECT_EQ(lineOf("/a/long/way/to/in.rawlog", rest, 0).size(), 24 + rest.size());
    EXPECT_EQ(lineOf("/a/long/way/to/in.rawlog", rest, 20), "...n.rawlog: 50 %  ");
}

TEST(RunCommand, numbersAreThoseOfFilesToo)
{
    for (const char* value : {"0x10", "+-5", "1e999", "nan", "inf", "0,5", "5 ", "1'000", ""})
    {
        EXPECT_FALSE(isFinite()(std::string(value)).empty()) << value;
    }
    for (const char* value : {"5", "+5", "-5", ".5", "5.", "1e-3", "08"})
    {
        EXPECT_TRUE(isFinite()(std::string(value)).empty()) << value;
    }
    EXPECT_EQ(isPositive()(std::string("0")), "'0' is not a positive number");
    EXPECT_EQ(isBetween(0, 1)(std::string("1.5")), "'1.5' is not a number from 0 to 1");
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
