// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/image_file.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <filesystem>

#include "SmallDisk.h"
#include "TempDir.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::TempDir;

class ImageFile : public testing::Test
{
 protected:
    /** What is wrong with the bytes as a file, or empty. */
    [[nodiscard]] std::string problem(const std::string& bytes) const
    {
        test::writeBytes(dir_ / "image", bytes);
        try
        {
            return cv::norm(
                       readImageFile(dir_ / "image", cv::IMREAD_UNCHANGED), image_, cv::NORM_INF) <
                           30
                       ? ""
                       : "another image";
        }
        catch (const InputError& e)
        {
            return e.what();
        }
    }

    [[nodiscard]] std::string encoded(const char* extension) const
    {
        std::vector<unsigned char> bytes;
        cv::imencode(extension, image_, bytes);
        return {bytes.begin(), bytes.end()};
    }

    TempDir dir_;
    cv::Mat image_{24, 32, CV_8UC1, cv::Scalar(100)};
};

/** OpenCV says so by a result that is easily overlooked. */
TEST_F(ImageFile, whatAFormatCannotHoldIsNotWritten)
{
    const std::string path = dir_ / "wide.webp";
    const cv::Mat wide(1, 20000, CV_8UC3, cv::Scalar(1, 2, 3));  // 16383 are the most
    EXPECT_THROW(writeImageFile(path, wide), EnvironmentError);
    EXPECT_FALSE(std::filesystem::exists(path));
}

TEST_F(ImageFile, aCutOrDamagedPngIsNotAnImage)
{
    cv::randu(image_, 0, 256);
    std::string bytes = encoded(".png");
    ASSERT_EQ(problem(bytes), "");
    for (std::size_t size = 8; size < bytes.size(); ++size)
    {
        ASSERT_THAT(problem(bytes.substr(0, size)), testing::HasSubstr("stops before the end"));
    }
    for (std::size_t at = 8; at < bytes.size(); at += 3)
    {
        std::string damaged = bytes;
        damaged[at] = static_cast<char>(damaged[at] ^ 4);
        ASSERT_NE(problem(damaged), "") << at;
    }
}

TEST_F(ImageFile, aCutJpegIsNotAnImageAlsoBehindAThumbnail)
{
    cv::GaussianBlur(image_, image_, {}, 2);
    const std::string bytes = encoded(".jpg");
    ASSERT_EQ(problem(bytes), "");
    // A segment with an image of its own, as cameras write it.
    const std::string start =
        std::string("\xFF\xE1\x01\x02", 4) + "\xFF\xD8" + std::string(252, 'x') + "\xFF\xD9";
    ASSERT_EQ(start.size(), 4U + 256U);
    const std::string withThumbnail = bytes.substr(0, 2) + start + bytes.substr(2);
    ASSERT_EQ(problem(withThumbnail), "");
    for (const std::string& whole : {bytes, withThumbnail})
    {
        for (std::size_t size = 3; size + 1 < whole.size(); size += 5)
        {
            ASSERT_THAT(problem(whole.substr(0, size)), testing::HasSubstr("stops before the end"));
        }
    }
    EXPECT_EQ(problem(bytes + "what cameras append"), "");
}

TEST_F(ImageFile, aMissingFolderIsNamedNotTheFile)
{
    const auto message = [](const std::string& path)
    {
        try
        {
            (void)readImageFile(path, cv::IMREAD_UNCHANGED);
        }
        catch (const InputError& e)
        {
            return std::string(e.what());
        }
        return std::string("read");
    };
    EXPECT_EQ(
        message(dir_ / "in_Images/1.png"),
        "cannot open " + (dir_ / "in_Images") + ": no such folder");
    EXPECT_EQ(message(dir_ / "1.png"), "cannot open " + (dir_ / "1.png") + ": no such file");
    std::filesystem::create_symlink("loop", dir_ / "loop");  // there, but not to be opened
    for (const std::string& name : {dir_ / "loop", dir_ / "loop/1.png"})
    {
        EXPECT_EQ(message(name), "cannot open " + name + ": Too many levels of symbolic links");
    }
    // A disk that fails.
    EXPECT_EQ(message("/proc/self/mem"), "cannot read /proc/self/mem: Input/output error");
    EXPECT_EQ(problem(""), (dir_ / "image") + ": is empty");
    EXPECT_EQ(problem("text"), (dir_ / "image") + ": is not an image, or damaged");
}

/** Depth and calibration are not turned either. */
TEST_F(ImageFile, anOrientationDoesNotTurnThePicture)
{
    cv::Mat picture(48, 64, CV_8UC3, cv::Scalar(0, 0, 0));
    picture.colRange(0, 32).setTo(200);
    writeJpegFile(dir_ / "a.jpg", picture, 95);
    const std::string plain = test::readBytes(dir_ / "a.jpg");
    for (const char orientation : {'\3', '\6'})  // by 180 and 90 degrees
    {
        std::string exif(
            "\xFF\xE1\0\x22"
            "Exif\0\0II*\0\x08\0\0\0\1\0",
            20);
        exif += std::string("\x12\1\3\0\1\0\0\0", 8) + orientation + std::string(7, '\0');
        test::writeBytes(dir_ / "turned.jpg", plain.substr(0, 2) + exif + plain.substr(2));
        const cv::Mat read = readImageFile(dir_ / "turned.jpg", cv::IMREAD_COLOR);
        ASSERT_EQ(read.size(), picture.size());
        EXPECT_LT(cv::norm(read, picture, cv::NORM_INF), 12);
    }
}

TEST_F(ImageFile, aJpegIsThePicture)
{
    cv::Mat picture(120, 160, CV_8UC3), wide(120, 200, CV_8UC3);
    cv::randu(wide, 0, 256);
    cv::GaussianBlur(wide, wide, cv::Size(), 4);
    wide(cv::Rect(20, 0, 160, 120)).copyTo(picture);
    writeJpegFile(dir_ / "fine.jpg", wide(cv::Rect(20, 0, 160, 120)), 95);
    writeJpegFile(dir_ / "coarse.jpg", picture, 20);
    const cv::Mat fine = readImageFile(dir_ / "fine.jpg", cv::IMREAD_COLOR);
    ASSERT_EQ(fine.size(), picture.size());
    EXPECT_LT(cv::norm(fine, picture, cv::NORM_INF), 12);
    EXPECT_LT(
        test::readBytes(dir_ / "coarse.jpg").size(), test::readBytes(dir_ / "fine.jpg").size() / 2);
    EXPECT_THROW(writeJpegFile(dir_ / "none/a.jpg", picture, 90), EnvironmentError);
}

TEST_F(ImageFile, aFullDiskLeavesNoPartOfAnImageAndTheEarlierOne)
{
    cv::Mat large(200, 200, CV_8UC1);
    cv::randu(large, 0, 256);
    const std::string path = dir_ / "disk/image.png";
    const auto code = test::onSmallDisk(
        dir_ / "disk",
        16,
        [&]
        {
            test::writeBytes(path, "earlier");
            try
            {
                writeImageFile(path, large);
            }
            catch (const EnvironmentError& e)
            {
                const std::string message = e.what();
                const bool named = message.find(path) != std::string::npos &&
                                   message.find(": No space") != std::string::npos;
                const bool kept = test::readBytes(path) == "earlier" &&
                                  !std::filesystem::exists(path + ".partial");
                return named && kept ? 0 : 1;
            }
            return 2;
        });
    if (!code)
    {
        GTEST_SKIP() << "this user may not mount a disk";
    }
    EXPECT_EQ(*code, 0);
}

/** The coder takes three bytes a pixel, whatever there is. */
TEST(JpegFile, isOfColourImagesAlone)
{
    const TempDir dir;
    for (const cv::Mat& image : {cv::Mat(8, 8, CV_8UC1, cv::Scalar(9)), cv::Mat()})
    {
        EXPECT_THROW(writeJpegFile(dir / "a.jpg", image, 90), std::invalid_argument);
    }
    EXPECT_FALSE(std::filesystem::exists(dir / "a.jpg"));
}
}  // namespace
}  // namespace pointplane
