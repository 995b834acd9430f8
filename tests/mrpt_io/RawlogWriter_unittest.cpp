// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/RawlogWriter.h>
#include <pointplane/mrpt_io/errors.h>

#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/serialization/CArchive.h>

#include <csignal>

#include "TempDir.h"
#include "rawlog_samples.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pointplane
{
namespace
{
using test::readAll;
using test::readBytes;
using test::TempDir;

TEST(RawlogWriter, theFileAppearsWhenItIsComplete)
{
    const TempDir dir;
    const std::string path = dir / "a.rawlog";
    RawlogWriter writer(path);
    writer.write(*test::sampleScan(0));
    EXPECT_FALSE(std::filesystem::exists(path));
    EXPECT_TRUE(std::filesystem::exists(writer.partialPath()));
    writer.close();
    EXPECT_TRUE(std::filesystem::exists(path));
    EXPECT_FALSE(std::filesystem::exists(writer.partialPath()));
    EXPECT_EQ(writer.numObjects(), 1U);
}

TEST(RawlogWriter, commentsAreTheSameBytesWithAnyMrpt)
{
    const TempDir dir;
    const std::string path = dir / "a.rawlog";
    RawlogWriter writer(path);
    mrpt::obs::CObservationComment comment;
    comment.text = "a=1";
    comment.timestamp = mrpt::Clock::time_point(mrpt::Clock::duration(0x0102030405060708));
    writer.write(comment);
    writer.close();
    const std::string expected = std::string("\x9e") + "mrpt::obs::CObservationComment" +
                                 std::string("\0\3\0\0\0", 5) + "a=1" +
                                 "\x08\x07\x06\x05\x04\x03\x02\x01" + "\x88";
    std::string bytes(expected.size() + 1, ' ');
    mrpt::io::CFileGZInputStream file(path);
    bytes.resize(file.Read(bytes.data(), bytes.size()));
    EXPECT_EQ(bytes, expected);

    const auto objects = readAll(path).objects;
    ASSERT_EQ(objects.size(), 1U);
    const auto read = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(objects[0]);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->text, comment.text);
    EXPECT_EQ(read->timestamp, comment.timestamp);
}

TEST(RawlogWriter, mrptReadsIt)
{
    const TempDir dir;
    test::writeObservations(dir / "a.rawlog", 3);
    mrpt::io::CFileGZInputStream file(dir / "a.rawlog");
    auto archive = mrpt::serialization::archiveFrom(file);
    for (int i = 0; i < 3; ++i)
    {
        const auto scan = archive.ReadObject<mrpt::obs::CObservation3DRangeScan>();
        ASSERT_TRUE(scan);
        EXPECT_EQ(scan->rangeImage, test::sampleScan(i)->rangeImage);
    }
}

TEST(RawlogWriter, sameObjectsGiveSameBytes)
{
    const TempDir dir;
    test::writeObservations(dir / "a.rawlog", 40);
    test::writeObservations(dir / "b.rawlog", 40);
    EXPECT_EQ(readBytes(dir / "a.rawlog"), readBytes(dir / "b.rawlog"));
}

TEST(RawlogWriter, anUnfinishedFileLeavesTheOldOneAndSaysSo)
{
    const TempDir dir;
    const std::string path = dir / "a.rawlog";
    test::writeObservations(path, 1);
    const std::string before = readBytes(path);
    {
        RawlogWriter writer(path);
        for (int i = 0; i < 5; ++i)
        {
            writer.write(*test::sampleScan(i));
        }
    }
    EXPECT_EQ(readBytes(path), before);
    const auto contents = readAll(path + ".partial");
    EXPECT_EQ(contents.objects.size(), 5U);
    EXPECT_EQ(contents.ending.kind, RawlogEnd::Truncated);
}

TEST(RawlogWriter, killedProcessLosesAtMostWhatWasNotFlushed)
{
    const TempDir dir;
    const std::string path = dir / "a.rawlog";
    constexpr int kObjects = 100;
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0)
    {
        RawlogWriter writer(path);
        for (int i = 0; i < kObjects; ++i)
        {
            mrpt::obs::CObservationComment comment;
            comment.text = "number " + std::to_string(i);
            writer.write(comment);
        }
        ::kill(::getpid(), SIGKILL);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status));
    EXPECT_FALSE(std::filesystem::exists(path));
    const auto contents = readAll(path + ".partial");
    EXPECT_GT(
        contents.objects.size(),
        static_cast<std::size_t>(kObjects) - RawlogWriterOptions().flushEveryObjects);
    EXPECT_EQ(contents.ending.kind, RawlogEnd::Truncated);
}

TEST(RawlogWriter, fullDiskIsReported)
{
    const TempDir dir;
    // The file size limit stands for a full disk: write() fails in the same way.
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0)
    {
        std::signal(SIGXFSZ, SIG_IGN);
        rlimit limit{4096, 4096};
        setrlimit(RLIMIT_FSIZE, &limit);
        int code = 9;
        try
        {
            test::writeObservations(dir / "a.rawlog", 20);
        }
        catch (const EnvironmentError& e)
        {
            code = std::string(e.what()).find("a.rawlog.partial") != std::string::npos ? 0 : 8;
        }
        ::_exit(code);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 0);
    EXPECT_FALSE(std::filesystem::exists(dir / "a.rawlog"));
}

TEST(RawlogWriter, fullDeviceIsReportedEvenForOneSmallObject)
{
    const TempDir dir;
    const std::string path = dir / "a.rawlog";
    std::filesystem::create_symlink("/dev/full", path + ".partial");
    const auto writeOne = [&path]
    {
        RawlogWriter writer(path);
        writer.write(mrpt::obs::CObservationComment());
        writer.close();
    };
    EXPECT_THROW(writeOne(), EnvironmentError);
}

TEST(RawlogWriter, unwritablePlaceIsNamed)
{
    try
    {
        RawlogWriter writer("/nonexistent/a.rawlog");
        FAIL();
    }
    catch (const EnvironmentError& e)
    {
        EXPECT_STREQ(
            e.what(), "cannot create /nonexistent/a.rawlog.partial: No such file or directory");
    }
}
}  // namespace
}  // namespace pointplane
