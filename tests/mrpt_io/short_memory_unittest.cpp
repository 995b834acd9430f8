// SPDX-License-Identifier: BSD-3-Clause
// Where memory is short, nothing is said about file or frame.
#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/image_file.h>

#include <opencv2/imgcodecs.hpp>

#include <cstdlib>
#include <functional>

#include "TempDir.h"
#include "rawlog_samples.h"
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
enum Outcome : int
{
    kDone,
    kToldTheMachine,
    kToldSomethingElse
};

/** In a process of its own that gets no more memory from the system. */
[[nodiscard]] int withoutMemory(const std::function<void()>& body)
{
    const pid_t child = ::fork();
    if (child == 0)
    {
        const rlimit none{1, 1};
        ::setrlimit(RLIMIT_AS, &none);
        Outcome outcome = kDone;
        try
        {
            body();
        }
        catch (const std::exception& e)
        {
            outcome = isOutOfMemory(e) ? kToldTheMachine : kToldSomethingElse;
        }
        ::_exit(outcome);
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(ShortMemory, isNoDamageOfARawlog)
{
    const test::TempDir dir;
    {
        RawlogWriter writer(dir / "in.rawlog");
        writer.write(*test::sampleScan(0));
        writer.write(*test::sampleScan(1, 2000, 1500));
        writer.close();
    }
    RawlogReader reader(dir / "in.rawlog");
    const auto readAll = [&]
    {
        while (reader.next())
        {
        }
    };
    EXPECT_EQ(withoutMemory(readAll), kToldTheMachine);
}

TEST(ShortMemory, isNoDamageOfAnImage)
{
    const test::TempDir dir;
    const std::string path = dir / "large.png";
    writeImageFile(path, cv::Mat(6000, 8000, CV_8UC1, cv::Scalar(7)));
    (void)readImageFile(path, cv::IMREAD_UNCHANGED);  // OpenCV's decoders start
    EXPECT_EQ(
        withoutMemory([&] { (void)readImageFile(path, cv::IMREAD_UNCHANGED); }), kToldTheMachine);
}

TEST(ShortMemory, isNoProblemOfAFrame)
{
    const auto scan = test::sampleScan(0, 2000, 1500);
    EXPECT_EQ(withoutMemory([&] { (void)ObservationConverter().convert(*scan); }), kToldTheMachine);
}
}  // namespace
}  // namespace pointplane
