// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/ScanWriter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <vector>

#include "TempDir.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using mrpt::obs::CObservation3DRangeScan;

RegisteredScan sample()
{
    RegisteredScan scan;
    scan.stamp = stampFromText("1000.25");
    scan.camera.width = 32;
    scan.camera.height = 24;
    scan.camera.fx = 26;
    scan.camera.fy = -27;
    scan.camera.cx = 15.5;
    scan.camera.cy = 11.5;
    scan.camera.distortion = {0.1, 0.2, 0.3, 0.4, 0.5};
    scan.colour.create(24, 32, CV_8UC3);
    cv::randu(scan.colour, 0, 256);
    scan.depth.create(24, 32, CV_16UC1);
    cv::randu(scan.depth, 0, 65536);
    scan.unitsPerMetre = 1000;
    return scan;
}

/** Everything but comments. */
std::vector<CObservation3DRangeScan::Ptr> scansOf(const std::string& path)
{
    RawlogReader reader(path);
    std::vector<CObservation3DRangeScan::Ptr> out;
    while (const auto object = reader.next())
    {
        if (auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(object))
        {
            out.push_back(scan);
        }
    }
    EXPECT_EQ(reader.ending().kind, RawlogEnd::Clean) << reader.ending().message;
    return out;
}

TEST(RawlogNames, besideTheRawlog)
{
    EXPECT_EQ(groundTruthOf("dir.x/a.b.rawlog"), "dir.x/a.b.groundtruth.txt");
    EXPECT_EQ(groundTruthOf("a.rawlog.gz"), "a.groundtruth.txt");
    EXPECT_EQ(imagesFolderOf("dir.x/a.b.rawlog"), "dir.x/a.b_Images");
}

TEST(RawlogNames, imagesAreFoundByTheReader)
{
    const test::TempDir dir;
    for (const char* name : {"a.rawlog", "a.rawlog.gz"})
    {
        const std::string path = dir / name;
        ScanWriter writer(path, "RGBD", true);
        writer.write(sample());
        writer.close();
        EXPECT_EQ(RawlogReader(path).externalsDirectory(), imagesFolderOf(path));
        // The folder that is missing is the one to name.
        std::filesystem::remove_all(imagesFolderOf(path));
        EXPECT_EQ(RawlogReader(path).externalsDirectory(), imagesFolderOf(path));
    }
}

TEST(ScanWriter, whatIsWrittenIsRead)
{
    const test::TempDir dir;
    const std::string path = dir / "a.rawlog";
    const RegisteredScan in = sample();
    for (const bool external : {false, true})
    {
        ScanWriter writer(path, "front", external);
        writer.write(in);
        writer.close();
        const auto scans = scansOf(path);
        ASSERT_EQ(scans.size(), 1U);
        EXPECT_EQ(scans[0]->sensorLabel, "front");
        EXPECT_EQ(stampText(scans[0]->timestamp), "1000.250000000");

        ObservationConverter converter;
        converter.setExternalsDirectory(imagesFolderOf(path));
        const ConvertedFrame out = converter.convert(*scans[0]);
        ASSERT_EQ(out.problem, "");
        EXPECT_EQ(out.frame.camera.width, 32);
        EXPECT_EQ(out.frame.camera.fy, -27);
        EXPECT_EQ(out.frame.camera.cx, 15.5);
        EXPECT_EQ(out.frame.camera.distortion, in.camera.distortion);
        for (int v = 0; v < 24; ++v)
        {
            for (int u = 0; u < 32; ++u)
            {
                const auto reading = in.depth.at<std::uint16_t>(v, u);
                const float z = out.frame.depth.at<float>(v, u);
                ASSERT_TRUE(reading == 0 ? std::isnan(z) : std::abs(z - 0.001F * reading) < 1e-5F)
                    << v << " " << u << ": " << reading << " as " << z;
            }
        }
    }
}

TEST(ScanWriter, externalColourIsTheFileItCameFrom)
{
    const test::TempDir dir;
    RegisteredScan scan = sample();
    scan.colourFile = dir / "in.jpg";
    ASSERT_TRUE(cv::imwrite(scan.colourFile, scan.colour));
    ScanWriter writer(dir / "a.rawlog", "RGBD", true);
    writer.write(scan);
    EXPECT_EQ(
        test::readBytes(dir / "a_Images/1000.250000000_rgb.jpg"), test::readBytes(scan.colourFile));

    scan.colourFile = dir / "gone.jpg";
    EXPECT_THROW(writer.write(scan), EnvironmentError);
}

TEST(ScanWriter, embeddedColourIsUnchanged)
{
    const test::TempDir dir;
    const RegisteredScan scan = sample();
    ScanWriter writer(dir / "a.rawlog", "RGBD", false);
    writer.write(scan);
    writer.close();
    const auto scans = scansOf(dir / "a.rawlog");
    EXPECT_EQ(cv::norm(scans.at(0)->intensityImage.asCvMatRef(), scan.colour, cv::NORM_INF), 0);
}

TEST(ScanWriter, refusesImagesThatDoNotFitTheCamera)
{
    const test::TempDir dir;
    ScanWriter writer(dir / "a.rawlog", "RGBD", false);
    RegisteredScan scan = sample();
    scan.camera.width = 31;
    EXPECT_THROW(writer.write(scan), std::invalid_argument);
}

TEST(ScanWriter, namesTheFolderThatCannotBeMade)
{
    const test::TempDir dir;
    test::writeBytes(dir / "a_Images", "a file");
    try
    {
        ScanWriter writer(dir / "a.rawlog", "RGBD", true);
        FAIL() << "no error";
    }
    catch (const EnvironmentError& e)
    {
        EXPECT_THAT(e.what(), testing::HasSubstr(dir / "a_Images"));
    }
}

TEST(DepthInUnits, roundsAndLeavesOutWhatDoesNotFit)
{
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const cv::Mat depth = (cv::Mat_<float>(1, 6) << 1.0F, 1.00011F, kNan, 0.0F, -1.0F, 13.2F);
    const cv::Mat units = depthInUnits(depth, 5000);
    const cv::Mat expected = (cv::Mat_<std::uint16_t>(1, 6) << 5000, 5001, 0, 0, 0, 0);
    EXPECT_EQ(cv::norm(units, expected, cv::NORM_INF), 0);
}
}  // namespace
}  // namespace pointplane
