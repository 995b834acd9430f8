// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/errors.h>

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/serialization/CArchive.h>

#include <cstdlib>
#include <fstream>
#include <future>

#include "TempDir.h"
#include "rawlog_samples.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

namespace pointplane
{
namespace
{
using test::decompressed;
using test::otherSensors;
using test::RawlogContents;
using test::readAll;
using test::readBytes;
using test::TempDir;
using test::writeBytes;

std::string messageFor(const std::string& path)
{
    try
    {
        RawlogReader reader(path);
    }
    catch (const InputError& e)
    {
        return e.what();
    }
    return "no error";
}

TEST(RawlogReader, readsBackWhatMrptWrote)
{
    const TempDir dir;
    const auto expected = test::sampleScan(3);
    {
        mrpt::io::CFileGZOutputStream file(dir / "a.rawlog");
        auto archive = mrpt::serialization::archiveFrom(file);
        archive << *expected;
    }
    const RawlogContents contents = readAll(dir / "a.rawlog");
    ASSERT_EQ(contents.objects.size(), 1U);
    EXPECT_EQ(contents.ending.kind, RawlogEnd::Clean);
    const auto scan =
        std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(contents.objects[0]);
    ASSERT_TRUE(scan);
    EXPECT_EQ(scan->timestamp, expected->timestamp);
    EXPECT_EQ(scan->rangeImage, expected->rangeImage);
    EXPECT_EQ(scan->intensityImage.getAsFloat(5, 7), expected->intensityImage.getAsFloat(5, 7));
}

TEST(RawlogReader, readsEveryMemberThatAScanCanHave)
{
    const TempDir dir;
    const auto scan = test::sampleScan(0);
    scan->hasPoints3D = true;
    scan->resizePoints3DVectors(7);
    for (std::size_t i = 0; i < 7; ++i)
    {
        scan->points3D_x[i] = static_cast<float>(i);
    }
    scan->hasConfidenceImage = true;
    scan->confidenceImage.resize(32, 24, mrpt::img::CH_GRAY);
    scan->rangeImageOtherLayers["second"].setSize(24, 32);
    scan->pixelLabels = std::make_shared<mrpt::obs::TPixelLabelInfo<2>>();
    scan->pixelLabels->setSize(24, 32);
    scan->pixelLabels->setLabelName(3, "wall");
    scan->pixelLabels->setLabel(5, 6, 3);
    {
        RawlogWriter writer(dir / "a.rawlog");
        writer.write(*scan);
        auto gray = test::sampleScan(1);
        gray->intensityImage = gray->intensityImage.grayscale();
        writer.write(*gray);
        auto deep = test::sampleScan(2);
        deep->intensityImage.resize(32, 24, mrpt::img::CH_GRAY, mrpt::img::PixelDepth::D16U);
        writer.write(*deep);
        auto empty = mrpt::obs::CObservation3DRangeScan::Create();
        writer.write(*empty);
        writer.close();
    }
    const RawlogContents contents = readAll(dir / "a.rawlog");
    EXPECT_EQ(contents.ending.kind, RawlogEnd::Clean) << contents.ending.message;
    ASSERT_EQ(contents.objects.size(), 4U);
    const auto back =
        std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(contents.objects[0]);
    EXPECT_EQ(back->points3D_x.at(6), 6.0F);
    EXPECT_EQ(back->rangeImageOtherLayers.size(), 1U);
    EXPECT_TRUE(back->pixelLabels->checkLabel(5, 6, 3));
}

TEST(RawlogReader, readsBothFormatsPlainAndCompressed)
{
    const TempDir dir;
    test::writeObservations(dir / "2.rawlog", 5);
    test::writeActionsAndFrames(dir / "1.rawlog", 5);
    writeBytes(dir / "2plain.rawlog", decompressed(dir / "2.rawlog"));
    writeBytes(dir / "1plain.rawlog", decompressed(dir / "1.rawlog"));
    for (const auto& [name, count] :
         {std::pair{"1.rawlog", 10}, {"1plain.rawlog", 10}, {"2.rawlog", 5}, {"2plain.rawlog", 5}})
    {
        const RawlogContents contents = readAll(dir / name);
        EXPECT_EQ(contents.objects.size(), static_cast<std::size_t>(count)) << name;
        EXPECT_EQ(contents.ending.kind, RawlogEnd::Clean) << name << contents.ending.message;
    }
}

TEST(RawlogReader, readsConcatenatedCompressedFiles)
{
    const TempDir dir;
    test::writeObservations(dir / "a.rawlog", 3);
    const std::string bytes = readBytes(dir / "a.rawlog");
    writeBytes(dir / "b.rawlog", bytes + bytes);
    const RawlogContents contents = readAll(dir / "b.rawlog");
    EXPECT_EQ(contents.objects.size(), 6U);
    EXPECT_EQ(contents.ending.kind, RawlogEnd::Clean);
    // The same with a damaged second half, which zlib's own reader would ignore.
    writeBytes(dir / "c.rawlog", bytes + "?" + bytes.substr(1));
    const RawlogContents damaged = readAll(dir / "c.rawlog");
    EXPECT_EQ(damaged.objects.size(), 3U);
    EXPECT_EQ(damaged.ending.kind, RawlogEnd::Damaged);
}

TEST(RawlogReader, passesOtherSensorsOn)
{
    const TempDir dir;
    {
        RawlogWriter writer(dir / "a.rawlog");
        mrpt::obs::CObservationIMU imu;
        imu.sensorLabel = "IMU";
        writer.write(imu);
        mrpt::obs::CSensoryFrame frame;
        auto laser = mrpt::obs::CObservation2DRangeScan::Create();
        laser->resizeScan(361);
        frame.insert(laser);
        frame.insert(test::sampleScan(0));
        writer.write(frame);
        writer.write(*test::sampleScan(1));
        writer.close();
    }
    const RawlogContents contents = readAll(dir / "a.rawlog");
    EXPECT_EQ(contents.ending.kind, RawlogEnd::Clean) << contents.ending.message;
    ASSERT_EQ(contents.objects.size(), 3U);
    const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(contents.objects[1]);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->size(), 2U);
}

TEST(RawlogReader, readsOtherSensorsByteForByte)
{
    const TempDir dir;
    const auto expected = otherSensors();
    {
        RawlogWriter writer(dir / "a.rawlog");
        for (const auto& object : expected)
        {
            writer.write(*object);
        }
        writer.close();
    }
    const RawlogContents contents = readAll(dir / "a.rawlog");
    EXPECT_EQ(contents.ending.kind, RawlogEnd::Clean) << contents.ending.message;
    ASSERT_EQ(contents.objects.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
    {
        std::vector<std::uint8_t> before, after;
        mrpt::serialization::ObjectToOctetVector(expected[i].get(), before);
        mrpt::serialization::ObjectToOctetVector(contents.objects[i].get(), after);
        EXPECT_EQ(before, after) << expected[i]->GetRuntimeClass()->className;
    }
}

/** Every one is read, or called not supported with its class: none is damaged. */
TEST(RawlogReader, readsMrptsOwnDatasets)
{
    const std::string folder = "/usr/share/mrpt/datasets";
    if (!std::filesystem::exists(folder))
    {
        GTEST_SKIP() << folder << " is not installed (package mrpt-common)";
    }
    int numRead = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    {
        const std::string path = entry.path();
        if (entry.path().extension() != ".rawlog")
        {
            continue;
        }
        if (messageFor(path) != "no error")
        {
            EXPECT_THAT(messageFor(path), testing::HasSubstr(": not supported at byte "));
            EXPECT_THAT(
                messageFor(path),
                testing::HasSubstr(": class CObservationRotatingScan, version 0"));
            continue;
        }
        const RawlogContents contents = readAll(path);
        EXPECT_EQ(contents.ending.kind, RawlogEnd::Clean) << contents.ending.message;
        ++numRead;
    }
    EXPECT_GE(numRead, 13);
}

/** An object as it stood in a file of another time: name, version, contents, end mark. */
std::string objectBytes(const std::string& name, int version, const std::string& contents)
{
    return static_cast<char>(0x80U | name.size()) + name + static_cast<char>(version) + contents +
           "\x88";
}

std::string floats(std::initializer_list<float> values)
{
    return {reinterpret_cast<const char*>(values.begin()), 4 * values.size()};
}

/** Poses of serialisation version 0, as of 2005, whose matrix is of class CMatrix. */
TEST(RawlogReader, whatIsOlderThanTheLayoutsIsLeftToMrpt)
{
    const TempDir dir;
    const std::string matrix = objectBytes(
        "CMatrix",
        0,
        std::string("\4\0\0\0\4\0\0\0", 8) +
            floats({1, 0, 0, 7, 0, 1, 0, 8, 0, 0, 1, 9, 0, 0, 0, 1}));
    const std::string pose = objectBytes("CPose3D", 0, matrix);
    const std::string distribution =
        objectBytes("CPose3DPDFGaussian", 1, pose + std::string(21 * sizeof(double), '\0'));
    const std::string observation = objectBytes(
        "CObservationRobotPose",
        1,
        distribution + std::string("\1\0\0\0p", 5) + std::string(8, '\0') + pose);
    const std::string frame =
        objectBytes("CSensoryFrame", 2, std::string("\1\0\0\0", 4) + observation);
    writeBytes(dir / "a.rawlog", observation + frame);
    const RawlogContents contents = readAll(dir / "a.rawlog");
    EXPECT_EQ(contents.ending.kind, RawlogEnd::Clean) << contents.ending.message;
    ASSERT_EQ(contents.objects.size(), 2U);
    const auto back =
        std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(contents.objects[0]);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->pose.mean.x(), 7);
    EXPECT_EQ(back->sensorPose.z(), 9);
}

TEST(RawlogReader, recordsAreTheBytesOfTheFile)
{
    const TempDir dir;
    {
        RawlogWriter writer(dir / "a.rawlog");
        for (int i = 0; i < 3; ++i)
        {
            writer.write(*test::sampleScan(i, 160, 120));
            writer.write(mrpt::obs::CObservationIMU());
        }
        writer.close();
    }
    RawlogReader reader(dir / "a.rawlog");
    RawlogWriter copy(dir / "b.rawlog");
    int numMembers = 0;
    while (reader.next())
    {
        const RawlogRecord record = reader.takeRecord();
        numMembers += record.bytes.empty() ? 1 : 0;
        copy.write(record);
    }
    EXPECT_EQ(reader.ending().kind, RawlogEnd::Clean);
    copy.close();
    EXPECT_EQ(numMembers, 6);
    EXPECT_EQ(decompressed(dir / "b.rawlog"), decompressed(dir / "a.rawlog"));
    EXPECT_EQ(readBytes(dir / "b.rawlog"), readBytes(dir / "a.rawlog"));
    // Out of a single gz stream and a plain file, too; and of JPEG and exchanged resolutions.
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(false);
    {
        mrpt::io::CFileGZOutputStream file(dir / "c.rawlog");
        auto archive = mrpt::serialization::archiveFrom(file);
        for (int i = 0; i < 3; ++i)
        {
            const auto scan = test::sampleScan(i, 160, 120);
            scan->cameraParams.ncols = 320;
            archive << *scan;
        }
    }
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(true);
    writeBytes(dir / "d.rawlog", decompressed(dir / "c.rawlog"));
    for (const char* name : {"c.rawlog", "d.rawlog"})
    {
        RawlogReader other(dir / name);
        RawlogWriter out(dir / "e.rawlog");
        while (other.next())
        {
            out.write(other.takeRecord());
        }
        out.close();
        EXPECT_EQ(decompressed(dir / "e.rawlog"), decompressed(dir / "c.rawlog")) << name;
    }
}

TEST(RawlogReader, badFilesAreNamed)
{
    const TempDir dir;
    EXPECT_THAT(messageFor(dir / "none.rawlog"), testing::HasSubstr("none.rawlog: No such file"));
    EXPECT_THAT(messageFor(dir / ""), testing::HasSubstr("is a directory"));
    writeBytes(dir / "empty.rawlog", "");
    EXPECT_EQ(messageFor(dir / "empty.rawlog"), dir / "empty.rawlog" + ": is empty");
    writeBytes(dir / "text.rawlog", "# timestamp tx ty tz\n1 2 3\n");
    EXPECT_EQ(
        messageFor(dir / "text.rawlog"), dir / "text.rawlog" + ": is a text file, not a rawlog");
    writeBytes(dir / "ros.rawlog", "#ROSBAG V2.0\n" + std::string(99, '\0'));
    EXPECT_EQ(
        messageFor(dir / "ros.rawlog"),
        dir / "ros.rawlog" +
            ": is a ROS bag, not a rawlog; pointplane-convert bag makes one of it");
    writeBytes(dir / "zeros.rawlog", std::string(99, '\0'));
    EXPECT_THAT(messageFor(dir / "zeros.rawlog"), testing::HasSubstr("is it a rawlog?"));
    writeBytes(dir / "zstd.rawlog", "\x28\xb5\x2f\xfd----");
    EXPECT_THAT(messageFor(dir / "zstd.rawlog"), testing::HasSubstr("zstd -dc"));
    test::writeObservations(dir / "good.rawlog", 1);
    writeBytes(dir / "short.rawlog", readBytes(dir / "good.rawlog").substr(0, 30));
    EXPECT_THAT(messageFor(dir / "short.rawlog"), testing::HasSubstr("truncated at byte 30"));
    writeBytes(
        dir / "unknown.rawlog",
        "\x88"
        "CNothing" +
            std::string(20, '\0'));
    EXPECT_THAT(messageFor(dir / "unknown.rawlog"), testing::HasSubstr("CNothing"));
}

/** Some have no first bytes of their own, some are damaged there: then the name tells. */
TEST(RawlogReader, whoGivesAnotherRecordingLearnsWhatReadsIt)
{
    const TempDir dir;
    const std::string noMagic(99, '\0');
    const auto expect = [&](const std::string& name, const std::string& text)
    {
        writeBytes(dir / name, noMagic);
        EXPECT_THAT(messageFor(dir / name), testing::HasSubstr(text));
    };
    expect(
        "x.klg",
        "x.klg: is a log of ElasticFusion by its name, not a rawlog; pointplane-convert klg");
    expect("x.bag", "is a ROS bag, not a rawlog; pointplane-convert bag");
    expect(
        "x.mcap", "is an MCAP recording, not a rawlog; make a ROS 1 bag of it (rosbags-convert)");
    expect("x.db3", "is a database of ROS 2, not a rawlog; make a ROS 1 bag of it");
    expect("x.zip", "is a zip archive, not a rawlog; unpack it, then pointplane-convert tum");
    test::writeObservations(dir / "rawlog.bag", 1);
    EXPECT_TRUE(RawlogReader(dir / "rawlog.bag").next()) << "its name does not matter";
}

/** What came out of a pipe is gone: opening it again would wait for ever. */
/** As by `gzip a.rawlog`. */
TEST(RawlogReader, aFileThatIsCompressedTwiceIsNamedAsSuch)
{
    const TempDir dir;
    test::writeObservations(dir / "a.rawlog", 2);
    writeBytes(dir / "b.rawlog", readBytes(dir / "a.rawlog"));
    ASSERT_EQ(std::system(("gzip " + (dir / "b.rawlog")).c_str()), 0);
    EXPECT_EQ(
        messageFor(dir / "b.rawlog.gz"),
        dir / "b.rawlog.gz" + ": is compressed twice; run gunzip on it once");
}

TEST(RawlogReader, aPipeIsReadOnce)
{
    const TempDir dir;
    const std::string pipe = dir / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    const auto write = [&pipe](const std::string& bytes)
    { return std::async(std::launch::async, [&pipe, bytes] { std::ofstream(pipe) << bytes; }); };
    {
        const auto writer = write("a text that is not a rawlog");
        EXPECT_THAT(messageFor(pipe), testing::HasSubstr("is it a rawlog?"));
    }
    test::writeObservations(dir / "good.rawlog", 2);
    const auto writer = write(readBytes(dir / "good.rawlog"));
    EXPECT_EQ(readAll(pipe).objects.size(), 2U);
}

TEST(RawlogReader, intrinsicsOfAnotherResolutionAreNotHidden)
{
    const TempDir dir;
    const auto scan = test::sampleScan(0);
    scan->cameraParams.ncols = 64;
    mrpt::obs::CSensoryFrame frame;
    frame.insert(test::sampleScan(1));
    frame.insert(scan);
    {
        RawlogWriter writer(dir / "a.rawlog");
        writer.write(frame);
        writer.close();
    }
    const RawlogContents contents = readAll(dir / "a.rawlog");
    const auto back = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(contents.objects.at(0));
    ASSERT_EQ(back->size(), 2U);
    const auto ncols = [&back](std::size_t i)
    {
        return back->getObservationByIndexAs<mrpt::obs::CObservation3DRangeScan::Ptr>(i)
            ->cameraParams.ncols;
    };
    EXPECT_EQ(ncols(0), 32U);
    EXPECT_EQ(ncols(1), 64U);
}
}  // namespace
}  // namespace pointplane
