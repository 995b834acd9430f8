// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/errors.h>

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/serialization/CArchive.h>

#include "TempDir.h"
#include "rawlog_samples.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(RawlogReader, readsMrptsOwnDatasets)
{
    for (const char* name :
         {"tests_rgbd.rawlog", "kf-slam_6D_demo.rawlog", "localization_demo.rawlog"})
    {
        const std::string path = std::string("/usr/share/mrpt/datasets/") + name;
        if (!std::filesystem::exists(path))
        {
            GTEST_SKIP() << path << " is not installed (package mrpt-common)";
        }
        const RawlogContents contents = readAll(path);
        EXPECT_EQ(contents.ending.kind, RawlogEnd::Clean) << contents.ending.message;
        EXPECT_GE(contents.objects.size(), 1U);
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
    EXPECT_THAT(messageFor(dir / "text.rawlog"), testing::HasSubstr("is it a rawlog?"));
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
