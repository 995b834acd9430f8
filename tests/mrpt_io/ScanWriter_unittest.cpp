// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/ScanWriter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "TempDir.h"
#include "rawlog_samples.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::scansOf;

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
        test::readBytes(dir / "a_Images.partial/1000.250000000_rgb.jpg"),
        test::readBytes(scan.colourFile));

    scan.colourFile = dir / "gone.jpg";
    EXPECT_THROW(writer.write(scan), EnvironmentError);
}

/** The names of all files of a folder, and of those below. */
std::vector<std::string> filesIn(const std::string& folder)
{
    std::vector<std::string> out;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
    {
        out.push_back(std::filesystem::relative(entry.path(), folder));
    }
    std::sort(out.begin(), out.end());
    return out;
}

class ExternalImages : public testing::Test
{
 protected:
    /** A complete rawlog with an image of one colour. */
    void writeComplete(int value)
    {
        ScanWriter writer(path_, "RGBD", true);
        scan_.colour.setTo(value);
        writer.write(scan_);
        writer.close();
    }

    void expectShows(int value) const
    {
        const cv::Mat image = cv::imread(image_);
        ASSERT_FALSE(image.empty());
        EXPECT_EQ(image.at<cv::Vec3b>(0, 0)[0], value);
        EXPECT_EQ(scansOf(path_).size(), 1U);
    }

    test::TempDir dir_;
    std::string path_{dir_ / "a.rawlog"};
    std::string image_{dir_ / "a_Images/1000.250000000_rgb.png"};
    RegisteredScan scan_{sample()};
};

TEST_F(ExternalImages, ofAnEarlierRawlogStayUntilTheNewOneIsComplete)
{
    writeComplete(10);
    const auto before = filesIn(dir_ / "");
    {
        ScanWriter killed(path_, "RGBD", true);
        scan_.colour.setTo(20);
        killed.write(scan_);
    }
    expectShows(10);
    // What was written may be wanted, and is found.
    EXPECT_EQ(RawlogReader(path_ + ".partial").externalsDirectory(), dir_ / "a_Images.partial");
    EXPECT_TRUE(std::filesystem::exists(dir_ / "a_Images.partial/1000.250000000_rgb.png"));
    {
        ScanWriter refused(path_, "RGBD", true);
        refused.write(scan_);
        refused.discard();
    }
    expectShows(10);
    EXPECT_EQ(filesIn(dir_ / ""), before);
    scan_.stamp = stampFromText("1000.5");
    {
        ScanWriter other(path_, "RGBD", true);
        other.write(scan_);
        other.close();
    }
    // Of the earlier one, nothing is left.
    EXPECT_EQ(
        filesIn(dir_ / "a_Images"),
        (std::vector<std::string>{"1000.500000000_depth.bin", "1000.500000000_rgb.png"}));
    EXPECT_FALSE(std::filesystem::exists(dir_ / "a_Images.partial"));
    EXPECT_EQ(RawlogReader(path_).externalsDirectory(), dir_ / "a_Images");
}

/** First beside the link: somebody may have put them there. */
/** Stamps repeat where a clock is coarse. */
TEST_F(ExternalImages, ofFramesWithTheSameStampAreTwo)
{
    ScanWriter writer(path_, "RGBD", true);
    for (const int value : {10, 20})
    {
        scan_.colour.setTo(value);
        scan_.depth.setTo(100 * value);
        writer.write(scan_);
    }
    writer.close();
    ObservationConverter converter;
    converter.setExternalsDirectory(imagesFolderOf(path_));
    const auto scans = scansOf(path_);
    ASSERT_EQ(scans.size(), 2U);
    for (int i = 0; i < 2; ++i)
    {
        const RgbdFrame frame = converter.convert(*scans[static_cast<std::size_t>(i)]).frame;
        EXPECT_EQ(frame.gray.at<uchar>(5, 5), 10 * (i + 1));
        EXPECT_FLOAT_EQ(frame.depth.at<float>(5, 5), static_cast<float>(i + 1));
    }
    writeComplete(30);  // they are replaced as others are
    EXPECT_EQ(filesIn(dir_ / "a_Images").size(), 2U);
}

TEST_F(ExternalImages, areFoundThroughALink)
{
    writeComplete(10);
    std::filesystem::create_directories(dir_ / "links");
    const std::string link = dir_ / "links/b.rawlog";
    std::filesystem::create_symlink("../a.rawlog", link);
    EXPECT_EQ(RawlogReader(link).externalsDirectory(), dir_ / "a_Images");
    std::filesystem::create_directories(dir_ / "links/b_Images");
    EXPECT_EQ(RawlogReader(link).externalsDirectory(), dir_ / "links/b_Images");
    std::filesystem::remove_all(dir_ / "links/b_Images");
    std::filesystem::remove_all(dir_ / "a_Images");
    EXPECT_EQ(RawlogReader(link).externalsDirectory(), dir_ / "links/b_Images");
}

TEST_F(ExternalImages, leaveNothingBehindWhereTheRunIsRefused)
{
    ScanWriter writer(path_, "RGBD", true);
    writer.write(scan_);
    writer.discard();
    EXPECT_EQ(filesIn(dir_ / ""), std::vector<std::string>());
}

TEST_F(ExternalImages, doNotReplaceWhatIsSomebodyElses)
{
    writeComplete(10);
    for (const char* folder : {"a_Images", "a_Images.partial"})
    {
        const std::string file = dir_ / (std::string(folder) + "/notes.txt");
        std::filesystem::create_directories(dir_ / folder);
        test::writeBytes(file, "mine");
        const auto before = filesIn(dir_ / "");
        try
        {
            const ScanWriter writer(path_, "RGBD", true);
            FAIL() << "no error";
        }
        catch (const EnvironmentError& e)
        {
            EXPECT_THAT(e.what(), testing::HasSubstr(dir_ / folder));
            EXPECT_THAT(e.what(), testing::HasSubstr("notes.txt"));
        }
        EXPECT_EQ(filesIn(dir_ / ""), before);
        std::filesystem::remove(file);
    }
}

TEST_F(ExternalImages, stayWhereALinkLeads)
{
    std::filesystem::create_directory(dir_ / "disk");
    std::filesystem::create_directory_symlink(dir_ / "disk", dir_ / "a_Images");
    writeComplete(10);
    expectShows(10);
    EXPECT_TRUE(std::filesystem::is_symlink(dir_ / "a_Images"));
    EXPECT_EQ(filesIn(dir_ / "disk").size(), 2U);
}

/** a and a.rawlog have one name for them. */
TEST_F(ExternalImages, ofTwoRawlogsAtATimeAreNotMixed)
{
    ScanWriter first(path_, "RGBD", true);
    first.write(scan_);
    EXPECT_THROW(ScanWriter(dir_ / "a", "RGBD", true), EnvironmentError);
    first.close();
    EXPECT_EQ(filesIn(dir_ / "a_Images").size(), 2U);
}

TEST_F(ExternalImages, areNotRemovedBehindALinkWithThePartialName)
{
    writeComplete(10);
    const auto images = filesIn(dir_ / "a_Images");
    std::filesystem::create_directory_symlink("a_Images", dir_ / "b_Images.partial");
    EXPECT_THROW(ScanWriter(dir_ / "b.rawlog", "RGBD", true), EnvironmentError);
    EXPECT_EQ(filesIn(dir_ / "a_Images"), images);
}

TEST_F(ExternalImages, areNotTakenAwayWhereTheyAreTheInput)
{
    ScanWriter writer(path_, "RGBD", true);
    scan_.colourFile = dir_ / "a_Images.partial/1000.250000000_rgb.png";
    ASSERT_TRUE(cv::imwrite(scan_.colourFile, scan_.colour));
    const std::string bytes = test::readBytes(scan_.colourFile);
    writer.write(scan_);
    EXPECT_EQ(test::readBytes(scan_.colourFile), bytes);
}

TEST(DepthUnits, areThoseOfACamera)
{
    for (const double units : {1.0, 1000.0, 5000.0, 1e6})
    {
        EXPECT_EQ(problemOfDepthUnits(units), "");
    }
    const double kNan = std::numeric_limits<double>::quiet_NaN();
    for (const double units : {0.0, -1000.0, 1e-300, 1e300, 0.999, 1.1e6, kNan, 1 / 0.0})
    {
        EXPECT_NE(problemOfDepthUnits(units), "");
    }
    EXPECT_EQ(problemOfDepthUnits(1e300), "1e+300 is not a number from 1 to 1e+06");
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
    const cv::Mat depth =
        (cv::Mat_<float>(1, 7) << 1.0F, 1.00011F, kNan, 0.0F, -1.0F, 13.107F, 13.2F);
    const cv::Mat units = depthInUnits(depth, 5000);
    const cv::Mat expected = (cv::Mat_<std::uint16_t>(1, 7) << 5000, 5001, 0, 0, 0, 0, 0);
    EXPECT_EQ(cv::norm(units, expected, cv::NORM_INF), 0);
}

/** The size is right; before, the camera was blamed, or the scan could not be read again. */
TEST(ScanWriter, namesWhatIsWrongWithAnImage)
{
    const test::TempDir dir;
    ScanWriter writer(dir / "a.rawlog", "RGBD", false);
    const auto expectRefused = [&](const RegisteredScan& scan, const std::string& message)
    {
        EXPECT_THAT(
            [&] { writer.write(scan); },
            testing::ThrowsMessage<std::invalid_argument>(testing::HasSubstr(message)));
    };
    RegisteredScan scan = sample();
    scan.depth.convertTo(scan.depth, CV_32F);
    expectRefused(scan, "depth is not CV_16UC1");
    scan = sample();
    scan.colour.convertTo(scan.colour, CV_32F);
    expectRefused(scan, "colour is neither CV_8UC3 nor CV_8UC1");
    scan = sample();
    scan.unitsPerMetre = 0;
    expectRefused(scan, "unitsPerMetre: 0 is not a number from 1 to");
    writer.write(sample());
}
}  // namespace
}  // namespace pointplane
