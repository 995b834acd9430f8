// SPDX-License-Identifier: BSD-3-Clause
#include "ConvertApp.h"

#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <opencv2/imgcodecs.hpp>

#include <array>
#include <filesystem>
#include <future>
#include <iterator>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "SmallDisk.h"
#include "TempDir.h"
#include "calibration_file.h"
#include "camera_oddity.h"
#include "rawlog_samples.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

namespace pointplane
{
namespace
{
using test::scansOf;
using test::TempDir;
using test::writeBytes;
using testing::HasSubstr;
using testing::Not;

/** A folder with three colour and four depth images, of which two pairs match. */
class ConvertApp : public testing::Test
{
 protected:
    void SetUp() override
    {
        for (const char* sub : {"in", "in/rgb", "in/depth"})
        {
            std::filesystem::create_directory(dir_ / sub);
        }
        cv::Mat colour(24, 32, CV_8UC3);
        cv::Mat depth(24, 32, CV_16UC1);
        for (int i = 0; i < 4; ++i)
        {
            cv::randu(colour, 0, 256);
            cv::randu(depth, 0, 65536);
            colour.copyTo(colours_[i]);
            depth.copyTo(depths_[i]);
            const std::string name = std::to_string(i) + ".png";
            cv::imwrite(dir_ / "in/rgb/" + name, colour);
            cv::imwrite(dir_ / "in/depth/" + name, depth);
        }
        writeBytes(
            dir_ / "in/rgb.txt",
            "# colour\n1305031102.175304 rgb/0.png\n1305031102.211214 rgb/1.png\n"
            "1305031109.0 rgb/2.png\n");
        writeBytes(
            dir_ / "in/depth.txt",
            "# depth\n1305031102.160407 depth/0.png\n1305031102.194330 depth/1.png\n"
            "1305031102.226738 depth/2.png\n1305031104.0 depth/3.png\n");
        writeBytes(dir_ / "in/camera.txt", "26.2 -26.1 15.5 11.5 0.1 0 0 0 0 32 24 5000\n");
        writeBytes(dir_ / "in/groundtruth.txt", "# truth\n1305031102.1 0 0 0 0 0 0 1\n");
    }

    [[nodiscard]] int run(std::vector<std::string> args)
    {
        args.insert(args.begin(), "tum");
        args.emplace_back("--quiet");
        std::ostringstream out, err;
        const int code = runConvert(args, out, err);
        text_ = out.str() + err.str();
        return code;
    }

    TempDir dir_;
    std::string in_{dir_ / "in"};
    std::string out_{dir_ / "out.rawlog"};
    cv::Mat colours_[4], depths_[4];
    std::string text_;
};

TEST_F(ConvertApp, stampsAreEvenedOutIfAsked)
{
    std::string colour, depth;
    for (int i = 0; i < 40; ++i)
    {
        const std::string file = "/" + std::to_string(i % 3) + ".png\n";
        const double t = 1305031102 + i / 30.0;
        colour += std::to_string(std::round(100 * t) / 100) + " rgb" + file;
        depth += std::to_string(std::round(100 * (t - 0.008)) / 100) + " depth" + file;
    }
    writeBytes(dir_ / "in/rgb.txt", colour);
    writeBytes(dir_ / "in/depth.txt", depth);
    ASSERT_EQ(run({in_, "-o", out_}), kExitOk);
    EXPECT_THAT(text_, HasSubstr("rounded to 0.01 s"));
    EXPECT_THAT(text_, HasSubstr("--even-stamps"));

    const std::string even = dir_ / "even.rawlog";
    ASSERT_EQ(run({in_, "-o", even, "--even-stamps"}), kExitOk) << text_;
    EXPECT_THAT(text_, Not(HasSubstr("rounded")));
    EXPECT_THAT(text_, HasSubstr("stamps: evened out, moved by 2.7 ms (rms), 3."));
    EXPECT_THAT(text_, HasSubstr("depth after colour: -6.8 ms"));
    const auto scans = scansOf(even);
    ASSERT_EQ(scans.size(), 40U);
    for (size_t i = 1; i < scans.size(); ++i)
    {
        const double interval = mrpt::Clock::toDouble(scans[i]->timestamp) -
                                mrpt::Clock::toDouble(scans[i - 1]->timestamp);
        EXPECT_NEAR(interval, 1 / 30.0, 1e-3);
    }
    writeBytes(dir_ / "in/rgb.txt", "1 rgb/0.png\n1 rgb/1.png\n1 rgb/2.png\n");
    EXPECT_EQ(run({in_, "-o", dir_ / "none.rawlog", "--even-stamps"}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("in/rgb.txt: all stamps are the same"));
}

TEST_F(ConvertApp, pairsAreThoseOfAssociateAndNothingIsLost)
{
    ASSERT_EQ(run({in_, "-o", out_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("2 frames"));
    EXPECT_THAT(text_, HasSubstr("1 colour and 2 depth images"));
    const auto scans = scansOf(out_);
    ASSERT_EQ(scans.size(), 2U);
    // Nearest first: 102.175304 with .160407 (15 ms), 102.211214 with .226738 (16 ms); .194330 is
    // 17 and 19 ms away.
    const int partners[2] = {0, 2};
    for (int i = 0; i < 2; ++i)
    {
        const auto& scan = *scans[static_cast<std::size_t>(i)];
        EXPECT_FLOAT_EQ(scan.rangeUnits, 1.0F / 5000);
        for (int v = 0; v < 24; ++v)
        {
            for (int u = 0; u < 32; ++u)
            {
                ASSERT_EQ(scan.rangeImage(v, u), depths_[partners[i]].at<std::uint16_t>(v, u));
            }
        }
        EXPECT_EQ(cv::norm(scan.intensityImage.asCvMatRef(), colours_[i], cv::NORM_INF), 0);
        EXPECT_EQ(scan.sensorPose, mrpt::poses::CPose3D());
    }
    EXPECT_EQ(stampText(scans[0]->timestamp), "1305031102.175304000");
    EXPECT_EQ(
        test::readBytes(dir_ / "out.groundtruth.txt"),
        "# copied by pointplane-convert\n" + test::readBytes(dir_ / "in/groundtruth.txt"));
}

TEST_F(ConvertApp, aLineThatIsTwiceInAListCountsOnce)
{
    const std::string colour = test::readBytes(dir_ / "in/rgb.txt");
    writeBytes(dir_ / "in/rgb.txt", colour + colour);
    ASSERT_EQ(run({in_, "-o", out_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("2 frames"));
    EXPECT_THAT(text_, HasSubstr("1 colour and 2 depth images"));
}

TEST_F(ConvertApp, namesOfImagesMayHaveBlanks)
{
    for (const char* name : {"rgb", "depth"})
    {
        const std::string image = dir_ / ("in/" + std::string(name));
        std::filesystem::rename(image + "/0.png", image + "/in the  hall.png");
        std::string listing = test::readBytes(image + ".txt");
        listing.replace(listing.find("/0.png"), 6, "/in the  hall.png \r");
        writeBytes(image + ".txt", listing);
    }
    ASSERT_EQ(run({in_, "-o", out_}), kExitOk) << text_;
    const auto scans = scansOf(out_);
    ASSERT_EQ(scans.size(), 2U);
    EXPECT_EQ(cv::norm(scans[0]->intensityImage.asCvMatRef(), colours_[0], cv::NORM_INF), 0);
}

TEST_F(ConvertApp, groundTruthWithoutPosesIsTold)
{
    for (const char* text : {"", "# timestamp tx ty tz qx qy qz qw\n \n"})
    {
        writeBytes(dir_ / "in/groundtruth.txt", text);
        ASSERT_EQ(run({in_, "-o", out_}), kExitOk) << text_;
        EXPECT_THAT(
            text_,
            HasSubstr(in_ + "/groundtruth.txt: has no poses, so no ground truth is written"));
        EXPECT_FALSE(std::filesystem::exists(dir_ / "out.groundtruth.txt"));
    }
}

TEST_F(ConvertApp, cameraAndDelayReachEachFrame)
{
    ASSERT_EQ(run({in_, "-o", out_}), kExitOk) << text_;
    std::vector<double> delays;
    for (const ConvertedFrame& converted : test::convertedFrames(out_))
    {
        ASSERT_EQ(converted.problem, "");
        EXPECT_DOUBLE_EQ(converted.frame.camera.fy, -26.1);
        EXPECT_DOUBLE_EQ(converted.frame.camera.distortion[0], 0.1);
        delays.push_back(converted.frame.shutter.depthDelay);
    }
    ASSERT_EQ(delays.size(), 2U);
    EXPECT_NEAR(delays[0], -0.014897, 1e-6);
    EXPECT_NEAR(delays[1], 0.015524, 1e-6);
    EXPECT_THAT(text_, testing::HasSubstr("15.5 ms (median)"));  // the upper one
}

TEST_F(ConvertApp, aFullDiskIsExitCode3AndLeavesNothingThatLooksComplete)
{
    const std::string path = dir_ / "disk/out.rawlog";
    for (const bool external : {false, true})
    {
        const auto code = test::onSmallDisk(
            dir_ / "disk",
            4,
            [&]
            {
                std::vector<std::string> args{in_, "-o", path};
                if (external)
                {
                    args.emplace_back("--external");
                }
                const int result = run(args);
                return std::filesystem::exists(path) ? 99 : result;
            });
        if (!code)
        {
            GTEST_SKIP() << "this user may not mount a disk";
        }
        EXPECT_EQ(*code, kExitEnvironment) << external;
    }
}

TEST_F(ConvertApp, externalFilesAreTheOriginalsAndGiveTheSameFrames)
{
    ASSERT_EQ(run({in_, "-o", out_}), kExitOk) << text_;
    const std::string external = dir_ / "external.rawlog";
    ASSERT_EQ(run({in_, "-o", external, "--external"}), kExitOk) << text_;
    EXPECT_LT(std::filesystem::file_size(external), 3000U);
    const std::string folder = dir_ / "external_Images";
    EXPECT_EQ(
        test::readBytes(folder + "/1305031102.175304000_rgb.png"),
        test::readBytes(dir_ / "in/rgb/0.png"));
    const auto a = scansOf(out_), b = scansOf(external);
    ASSERT_EQ(a.size(), b.size());
    ObservationConverter converter;
    converter.setExternalsDirectory(folder);
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        const ConvertedFrame fa = converter.convert(*a[i]), fb = converter.convert(*b[i]);
        ASSERT_EQ(fa.problem + fb.problem, "");
        EXPECT_EQ(cv::norm(fa.frame.gray, fb.frame.gray, cv::NORM_INF), 0);
        for (int v = 0; v < 24; ++v)  // NaN compares with nothing
        {
            EXPECT_EQ(
                std::memcmp(fa.frame.depth.ptr(v), fb.frame.depth.ptr(v), 32 * sizeof(float)), 0);
        }
    }
}

TEST_F(ConvertApp, cameraFiles)
{
    writeBytes(
        dir_ / "mrpt.ini",
        "[CAMERA_PARAMS]\nresolution = [32 24]\ncx = 15.5\ncy = 11.5\nfx = 26\nfy = 27\n"
        "dist = [0.1 0.2 0.3 0.4 0.5]\ndistortion_model = plumb_bob\n");
    const Calibration camera = loadCalibration(dir_ / "mrpt.ini", in_);
    EXPECT_EQ(camera.camera.width, 32);
    EXPECT_DOUBLE_EQ(camera.camera.fy, 27);
    EXPECT_DOUBLE_EQ(camera.camera.distortion[4], 0.5);
    EXPECT_DOUBLE_EQ(loadCalibration("fr1", in_).camera.fx, 517.306408);
    EXPECT_DOUBLE_EQ(loadCalibration("", "/data/rgbd_dataset_freiburg3_cabinet").camera.cy, 247.6);
    EXPECT_DOUBLE_EQ(loadCalibration("", in_).camera.fx, 26.2);
    writeBytes(dir_ / "bad.txt", "1 2 3\n");
    EXPECT_THROW((void)loadCalibration(dir_ / "bad.txt", in_), InputError);
    writeBytes(dir_ / "zero.txt", "0 0 0 0 0 0 0 0 0 32 24 5000\n");
    EXPECT_THROW((void)loadCalibration(dir_ / "zero.txt", in_), InputError);
    writeBytes(dir_ / "camera.txt", "26 26 15.5 24 0 0 0 0 0 32 24 5000\n");
    try
    {
        (void)loadCalibration(dir_ / "camera.txt", in_);
        ADD_FAILURE() << "a principal point below the image";
    }
    catch (const InputError& e)
    {
        EXPECT_EQ(
            std::string(e.what()),
            (dir_ / "camera.txt") +
                ": principal point is outside of the image (cx=15.5 cy=24, image 32x24)");
    }
    EXPECT_THROW((void)loadCalibration("fr7", in_), InputError);
    writeBytes(dir_ / "formula.ini", "[CAMERA_PARAMS]\nfx = 26\nfy = $eval{27\n");
    try
    {
        (void)loadCalibration(dir_ / "formula.ini", in_);
        ADD_FAILURE() << "an unfinished formula";
    }
    catch (const InputError& e)
    {
        EXPECT_THAT(e.what(), HasSubstr("formula.ini: Line 3: Expected closing `}`"));
    }
}

/** MRPT takes abc for 0, 318,5 for 318, 5e for 5 and the last of two values, and says nothing. */
TEST_F(ConvertApp, aTypoInACalibrationIsRefusedAndNamed)
{
    const std::string ini = dir_ / "c.ini";
    const auto cameraWith = [&](const std::string& line)
    {
        const std::string key = line.substr(0, line.find('='));
        std::string text = "[CAM]\n";
        for (const char* good :
             {"resolution=[32 24]",
              "fx=26",
              "fy=27",
              "cx=15.5",
              "cy=11.5",
              "dist=[0.2 -0.9 0 0 1]"})
        {
            text += (std::string(good).rfind(key + "=", 0) == 0 ? line : good) + std::string("\n");
        }
        writeBytes(ini, text + (text.find(line) == std::string::npos ? line + "\n" : ""));
        return loadCalibration(ini, in_).camera;
    };
    const std::vector<std::pair<std::string, std::string>> wrong{
        {"cx=abc", "cx = 'abc': 'abc' is not a number"},
        {"cx=318,5", "cx = '318,5' is not one number"},
        {"fx=5e", "fx = '5e': '5e' is not a number"},
        {"fy=5 16", "fy = '5 16' is not one number"},
        {"fx=inf", "'inf' is not a number"},
        {"fx=", "fx = '' is not one number"},
        {"dist=[a b c d e]", "dist = '[a b c d e]': 'a' is not a number"},
        {"dist=[0,2 -0,9 0,0 0,0]", "is not a number"},
        {"dist=[1 2 3]", "dist must be [k1 k2 p1 p2 k3]"},
        {"dist=[0.2 -0.9 0 0 1 0.1 0.2 0.3]", "dist has k4, k5 or k6"},
        {"resolution=[32 24.5]", "resolution is not two whole numbers of pixels"},
        {"resolution=640x480", "resolution = '640x480': '640x480' is not a number"},
        {"distortion_model=fisheye", "distortion_model = 'fisheye' is neither plumb_bob nor none"},
        {"distortion_model=kannala_brandt", "fisheye distortion is not supported"}};
    for (const auto& [line, words] : wrong)
    {
        try
        {
            (void)cameraWith(line);
            ADD_FAILURE() << "accepted " << line;
        }
        catch (const InputError& e)
        {
            EXPECT_THAT(e.what(), testing::StartsWith(ini + ": section [CAM]: ")) << line;
            EXPECT_THAT(e.what(), HasSubstr(words)) << line;
        }
    }
    EXPECT_EQ(cameraWith("cx=16 // px").cx, 16);
    EXPECT_EQ(cameraWith("dist=[0.1, 0.2, 0, 0]").distortion[1], 0.2);
    EXPECT_EQ(cameraWith("dist=[0.1 0.2 0 0 0.3 0 0 0]").distortion[4], 0.3);
    EXPECT_EQ(cameraWith("distortion_model=none").distortion[0], 0);
    // A file from before there was a distortion_model.
    EXPECT_EQ(cameraWith("fx=28").distortion, (std::array<double, 5>{0.2, -0.9, 0, 0, 1}));
    writeBytes(ini, "[CAM]\nfx=1\n# fx=2\ncx=3\nFX = 4\n");
    try
    {
        (void)loadCalibration(ini, in_);
        ADD_FAILURE() << "a key that is there twice";
    }
    catch (const InputError& e)
    {
        EXPECT_THAT(e.what(), HasSubstr(ini + ":5: key 'FX' appears twice in [CAM]"));
    }
}

TEST_F(ConvertApp, unitsThatNoCameraHasAreRefused)
{
    for (const char* units : {"1e300", "1e-300", "0.5"})
    {
        EXPECT_EQ(run({in_, "-o", out_, "--depth-scale", units}), kExitBadInput) << units;
        EXPECT_THAT(text_, HasSubstr("--depth-scale"));
        writeBytes(
            dir_ / "c.txt", std::string("26.2 26.1 15.5 11.5 0 0 0 0 0 32 24 ") + units + "\n");
        EXPECT_EQ(run({in_, "-o", out_, "--camera", dir_ / "c.txt"}), kExitBadInput) << units;
        EXPECT_THAT(text_, HasSubstr("c.txt: depth units per metre: "));
        EXPECT_FALSE(std::filesystem::exists(out_));
    }
}

TEST_F(ConvertApp, aCameraIsGuessedFromWholeWordsOfTheFoldersOwnName)
{
    for (const char* folder :
         {"/data/rgbd_dataset_freiburg1_xyz", "/data/fr1_x/", "fr1", "/fr3/tum-fr1", "a/../b.fr1"})
    {
        EXPECT_EQ(loadCalibration("", folder).guessed, "fr1") << folder;
    }
    EXPECT_EQ(loadCalibration("", "/data/fr1_backup/rgbd_dataset_freiburg3_x").guessed, "fr3");
    for (const char* folder : {"/data/scan_15fr30s", "/data/fr1tz", "/data/fr1/x", "/data/fr10"})
    {
        EXPECT_THROW((void)loadCalibration("", folder), InputError) << folder;
    }
}

TEST_F(ConvertApp, listsMayHaveAByteOrderMarkAndAbsoluteNames)
{
    const std::string mark = "\xEF\xBB\xBF";
    writeBytes(dir_ / "in/rgb.txt", mark + "1305031102.175304 " + dir_ / "in/rgb/0.png" + "\n");
    writeBytes(dir_ / "in/depth.txt", mark + "# depth\n1305031102.160407 depth/0.png\n");
    writeBytes(dir_ / "in/camera.txt", mark + "26.2 26.1 15.5 11.5 0 0 0 0 0 32 24 5000\n");
    ASSERT_EQ(run({in_, "-o", out_}), kExitOk) << text_;
    EXPECT_EQ(scansOf(out_).size(), 1U);
}

TEST_F(ConvertApp, aGuessedCameraIsTold)
{
    const std::string folder = dir_ / "fr1_x";
    std::filesystem::create_directories(folder);
    for (const char* name : {"rgb.png", "depth.png"})
    {
        cv::imwrite(
            folder + "/" + name,
            cv::Mat(480, 640, name[0] == 'r' ? CV_8UC3 : CV_16UC1, cv::Scalar::all(1)));
    }
    writeBytes(folder + "/rgb.txt", "1 rgb.png\n");
    writeBytes(folder + "/depth.txt", "1 depth.png\n");
    ASSERT_EQ(run({folder, "-o", out_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("camera: fr1, by the folder's name"));
    ASSERT_EQ(run({folder, "-o", out_, "--camera", "fr1"}), kExitOk) << text_;
    EXPECT_THAT(text_, testing::Not(HasSubstr("by the folder's name")));
}

TEST_F(ConvertApp, depthMayBeAlone)
{
    std::filesystem::remove(dir_ / "in/rgb.txt");
    for (const bool isExternal : {false, true})
    {
        std::vector<std::string> args{in_, "-o", out_};
        if (isExternal)
        {
            args.emplace_back("--external");
        }
        ASSERT_EQ(run(args), kExitOk) << text_;
        EXPECT_THAT(text_, HasSubstr("4 frames"));
        EXPECT_THAT(
            text_, HasSubstr("in: has no rgb.txt, so frames have depth alone, and only planes"));
        EXPECT_THAT(text_, Not(HasSubstr("colour and")));
        EXPECT_THAT(text_, Not(HasSubstr("after colour")));
        const auto scans = scansOf(out_);
        ASSERT_EQ(scans.size(), 4U);
        for (std::size_t i = 0; i < scans.size(); ++i)
        {
            EXPECT_FALSE(scans[i]->hasIntensityImage);
            EXPECT_TRUE(scans[i]->hasRangeImage);
        }
        const auto frames = test::convertedFrames(out_);
        ASSERT_EQ(frames.size(), 4U);
        EXPECT_EQ(frames[3].problem, "");
        EXPECT_NEAR(frames[3].frame.stamp, 1305031104.0, 1e-6);
        EXPECT_NEAR(
            frames[3].frame.depth.at<float>(10, 20),
            depths_[3].at<std::uint16_t>(10, 20) / 5000.0,
            1e-4);
    }
}

/** A link that leads nowhere is a list that cannot be read. */
TEST_F(ConvertApp, aListThatCannotBeReadIsNotTakenForNone)
{
    std::filesystem::remove(dir_ / "in/rgb.txt");
    std::filesystem::create_symlink(dir_ / "gone.txt", dir_ / "in/rgb.txt");
    EXPECT_EQ(run({in_, "-o", out_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("cannot open " + in_ + "/rgb.txt"));
}

/** Where a disk fails, a list does not end. */
TEST_F(ConvertApp, aListThatCannotBeReadToItsEndIsTold)
{
    for (const std::string name : {"rgb.txt", "groundtruth.txt", "camera.txt"})
    {
        const std::string path = in_ + "/" + name, kept = dir_ / "kept";
        const bool isThere = std::filesystem::exists(path);
        if (isThere)
        {
            std::filesystem::rename(path, kept);
        }
        std::filesystem::create_symlink("/proc/self/mem", path);
        EXPECT_EQ(run({in_, "-o", out_}), kExitBadInput);
        EXPECT_THAT(text_, HasSubstr("cannot read " + path + ": input/output error"));
        EXPECT_FALSE(std::filesystem::exists(out_));
        std::filesystem::remove(path);
        if (isThere)
        {
            std::filesystem::rename(kept, path);
        }
    }
}

TEST_F(ConvertApp, mistakesAreNamed)
{
    const auto expect = [this](const std::string& text, std::vector<std::string> more = {})
    {
        std::vector<std::string> args{in_, "-o", out_};
        args.insert(args.end(), more.begin(), more.end());
        EXPECT_EQ(run(args), kExitBadInput) << text;
        EXPECT_THAT(text_, HasSubstr(text));
        EXPECT_FALSE(std::filesystem::exists(out_));
    };
    const std::string listing = test::readBytes(dir_ / "in/depth.txt");
    writeBytes(dir_ / "in/depth.txt", "# x\n\n12.0 a.png b.png\n");
    expect("depth.txt:3: expected 'stamp file'");
    writeBytes(dir_ / "in/depth.txt", "abc a.png\n");
    expect("depth.txt:1: 'abc' is not a time stamp");
    writeBytes(dir_ / "in/depth.txt", "1305031102160407000 a.png\n");
    expect("seconds; if it is in nanoseconds, write 1305031102.160407000\n");
    writeBytes(dir_ / "in/depth.txt", "1305031102160 a.png\n");
    expect("seconds; if it is in milliseconds, write 1305031102.160\n");
    writeBytes(dir_ / "in/depth.txt", "1305031102160.407 a.png\n");
    expect("seconds; if it is in milliseconds, write 1305031102.160407\n");
    writeBytes(dir_ / "in/depth.txt", "5.0 a b.png\n");
    expect("expected 'stamp file', found '5.0 a b.png'; no file is named 'a b.png'\n");
    std::filesystem::remove(dir_ / "in/depth.txt");
    expect("/depth.txt: No such file or directory; without lists, pointplane-convert folder takes");
    writeBytes(dir_ / "in/depth.txt", "# nothing\n");
    expect("depth.txt: lists no images");
    writeBytes(dir_ / "in/depth.txt", "5 depth/0.png\n5.0 depth/1.png\n");
    expect("in/depth.txt: all its images have the stamp 5.000 s; the program that recorded them");
    writeBytes(dir_ / "in/depth.txt", "5.0 depth/0.png\n");
    expect(
        "no colour and depth stamps within 0.02 s of each other: colour from 1305031102.175 to "
        "1305031109.000 s, depth from 5.000 to 5.000 s (stamps must be in seconds");
    writeBytes(dir_ / "in/depth.txt", listing);
    expect("is 32x24 but the camera is for 640x480", {"--camera", "fr3"});
    writeBytes(dir_ / "pinhole.txt", "26.2 26.1 15.5 11.5\n");
    expect("line of 12 numbers, fx fy cx cy k1 k2", {"--camera", dir_ / "pinhole.txt"});
    for (const char* size : {"32.5 24", "1e300 24", "32 0", "32 -24"})
    {
        writeBytes(
            dir_ / "size.txt", std::string("26.2 26.1 15.5 11.5 0 0 0 0 0 ") + size + " 1\n");
        expect("size.txt: width and height are not whole numbers", {"--camera", dir_ / "size.txt"});
    }
    cv::imwrite(dir_ / "in/depth/0.png", colours_[0]);
    expect(
        "depth/0.png: is not a depth image of 16 bit and one channel, but of 8 bit and 3 "
        "channels\n",
        {"--strict"});
    cv::imwrite(dir_ / "in/depth/0.tiff", cv::Mat(24, 32, CV_32FC1, cv::Scalar(1)));
    std::filesystem::rename(dir_ / "in/depth/0.tiff", dir_ / "in/depth/0.png");
    expect(
        "but of 32 bit in floating point and 1 channel; pointplane-convert folder reads that",
        {"--strict"});
    std::filesystem::remove(dir_ / "in/depth/0.png");
    expect("cannot open " + in_ + "/depth/0.png: no such file", {"--strict"});
    std::filesystem::rename(dir_ / "in/rgb", dir_ / "in/elsewhere");
    std::filesystem::rename(dir_ / "in/depth", dir_ / "in/elsewhere2");
    expect("cannot open " + in_ + "/depth: no such folder\n");
    std::filesystem::remove(dir_ / "in/camera.txt");
    expect("say --camera");
    std::ostringstream out, err;
    EXPECT_EQ(runConvert({"tum", dir_ / "none", "-o", out_}, out, err), kExitBadInput);
    EXPECT_THAT(err.str(), HasSubstr("none: no such folder"));
    writeBytes(dir_ / "fr1.tgz", "packed");
    EXPECT_EQ(runConvert({"tum", dir_ / "fr1.tgz", "-o", out_}, out, err), kExitBadInput);
    EXPECT_THAT(err.str(), HasSubstr("fr1.tgz: is a file, not a folder; archives have to be un"));
}

/** A folder without permission fails likewise, but not for root, who may run this. */
TEST_F(ConvertApp, aFolderThatCannotBeOpenedIsAMistakeOfTheUser)
{
    std::filesystem::create_symlink("loop", dir_ / "loop");
    const std::string reason = "cannot open " + (dir_ / "loop") + ": Too many levels of symbolic";
    for (const char* command : {"tum", "folder"})
    {
        std::ostringstream out, err;
        EXPECT_EQ(runConvert({command, dir_ / "loop", "-o", out_}, out, err), kExitBadInput);
        EXPECT_THAT(err.str(), HasSubstr(reason));
    }
}

TEST_F(ConvertApp, aBadImageIsLeftOutAndNamed)
{
    const std::string whole = test::readBytes(dir_ / "in/depth/0.png");
    writeBytes(dir_ / "in/depth/0.png", whole.substr(0, whole.size() / 2));
    EXPECT_EQ(run({in_, "-o", out_}), kExitIncomplete);
    EXPECT_THAT(text_, HasSubstr("left out: " + in_ + "/depth/0.png: stops before the end"));
    EXPECT_EQ(scansOf(out_).size(), 1U);
    EXPECT_TRUE(std::filesystem::exists(dir_ / "out.groundtruth.txt"));
}

/** As /dev/null would be: nothing appears in its folder. */
TEST_F(ConvertApp, nothingIsWrittenBesideAPipe)
{
    std::filesystem::create_directory(dir_ / "devices");
    const std::string pipe = dir_ / "devices/pipe", link = dir_ / "devices/link";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::filesystem::create_symlink("pipe", link);
    for (const std::string& name : {pipe, link})
    {
        auto reader = std::async(std::launch::async, [&] { return test::readBytes(pipe); });
        EXPECT_EQ(run({in_, "-o", name}), kExitOk) << text_;
        EXPECT_GT(reader.get().size(), 100U);
        EXPECT_THAT(text_, HasSubstr("the ground truth was not written"));
        EXPECT_EQ(run({in_, "-o", name, "--external"}), kExitBadInput);
        EXPECT_THAT(text_, HasSubstr("images of -o " + name + ": is not a file"));
    }
    const std::filesystem::directory_iterator first(dir_ / "devices"), end;
    EXPECT_EQ(std::distance(first, end), 2);
}

/** out and out.rawlog have one name for their images, out.rawlog.gz has another. */
TEST_F(ConvertApp, imagesOfAnotherRawlogAreNotReplaced)
{
    const std::string other = dir_ / "out", images = dir_ / "out_Images";
    ASSERT_EQ(run({in_, "-o", out_, "--external"}), kExitOk) << text_;
    std::filesystem::remove(dir_ / "out.groundtruth.txt");
    EXPECT_EQ(run({in_, "-o", other, "--external"}), kExitBadInput);
    EXPECT_THAT(
        text_,
        HasSubstr("would replace " + images + ", which is that of " + out_ + "; give another"));
    EXPECT_FALSE(std::filesystem::exists(other));
    for (int i = 0; i < 2; ++i)  // their own they replace
    {
        EXPECT_EQ(run({in_, "-o", out_, "--external"}), kExitOk) << text_;
        std::filesystem::remove(dir_ / "out.groundtruth.txt");
        EXPECT_EQ(run({in_, "-o", out_ + ".gz", "--external"}), kExitOk) << text_;
        std::filesystem::remove(dir_ / "out.groundtruth.txt");
    }
}

/** Of another rawlog, whose name differs by .gz alone, or of an earlier one. */
TEST_F(ConvertApp, groundTruthOfAnotherRawlogIsNotReplacedAndNotAdopted)
{
    const std::string truth = dir_ / "out.groundtruth.txt";
    ASSERT_EQ(run({in_, "-o", out_}), kExitOk) << text_;
    writeBytes(truth, "the first");
    EXPECT_EQ(run({in_, "-o", out_ + ".gz"}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr(truth + ", which is that of " + out_ + "; give another name"));
    EXPECT_EQ(test::readBytes(truth), "the first");
    EXPECT_FALSE(std::filesystem::exists(out_ + ".gz"));

    // Nobody named this file: it may be a user's.
    const std::string rawlog = test::readBytes(out_);
    EXPECT_EQ(run({in_, "-o", out_, "--label", "other"}), kExitBadInput);
    EXPECT_THAT(
        text_,
        HasSubstr(
            "-o " + out_ + ": its ground truth would replace " + truth +
            ", which is a different one; move that file or give another name\n"));
    EXPECT_EQ(test::readBytes(truth), "the first");
    EXPECT_EQ(test::readBytes(out_), rawlog);

    for (const std::string& own :
         {test::readBytes(dir_ / "in/groundtruth.txt"),
          std::string(),
          std::string("# copied by pointplane-convert\nwhat was in the folder before\n"),
          std::string("# exact pose in the world of the robot, as rendered\n")})
    {
        writeBytes(truth, own);
        ASSERT_EQ(run({in_, "-o", out_}), kExitOk) << text_;
        EXPECT_THAT(text_, Not(HasSubstr("warning")));
        EXPECT_THAT(test::readBytes(truth), HasSubstr("# truth"));
    }

    std::filesystem::remove(dir_ / "in/groundtruth.txt");
    EXPECT_EQ(run({in_, "-o", out_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("warning: " + truth + " was there before"));
    EXPECT_EQ(run({in_, "-o", dir_ / "other.rawlog"}), kExitOk) << text_;
    EXPECT_THAT(text_, Not(HasSubstr("warning")));
}

TEST_F(ConvertApp, aRefusedRunWithExternalImagesLeavesAnEarlierOneAsItWas)
{
    ASSERT_EQ(run({in_, "-o", out_, "--external"}), kExitOk) << text_;
    const std::string image = dir_ / "out_Images/1305031102.175304000_rgb.png";
    const std::string before = test::readBytes(image);
    ASSERT_FALSE(before.empty());
    cv::imwrite(dir_ / "in/rgb/0.png", colours_[3]);
    writeBytes(dir_ / "in/rgb/1.png", "no picture");
    EXPECT_EQ(run({in_, "-o", out_, "--external", "--strict"}), kExitBadInput);
    EXPECT_EQ(test::readBytes(image), before);
    EXPECT_FALSE(std::filesystem::exists(dir_ / "out_Images.partial"));
}

/** The file that is being written, or one beside it, has a longer name than the one that is given.
 */
TEST_F(ConvertApp, namesThatAreTooLongAreRefusedBeforeTheRun)
{
    const std::string suffix = ".rawlog", folder = dir_ / "long/";
    std::filesystem::create_directory(folder);
    for (const std::size_t size : {248U, 240U})  // .partial; .groundtruth.txt.partial
    {
        const std::string name = std::string(size - suffix.size(), 'n') + suffix;
        EXPECT_EQ(run({in_, "-o", folder + name}), kExitBadInput) << size;
        EXPECT_THAT(text_, HasSubstr("bytes while it is written, but 255 are the most; give a"));
    }
    EXPECT_EQ(
        run({in_, "-o", folder + std::string(241, 'n') + suffix, "--external"}), kExitBadInput);
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

TEST_F(ConvertApp, aRawlogHasTheNameOfOne)
{
    EXPECT_EQ(run({in_, "-o", dir_ / "out.txt"}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr("out.txt: would be a rawlog; give a name that ends in .rawlog"));
    EXPECT_FALSE(std::filesystem::exists(dir_ / "out.txt"));
}

TEST_F(ConvertApp, aLabelIsOneLine)
{
    for (const char* label : {"a\nb", "\x1b[2J", "a\tb"})
    {
        EXPECT_EQ(run({in_, "-o", out_, "--label", label}), kExitBadInput);
        EXPECT_THAT(text_, HasSubstr("holds a new line or another control character"));
    }
    EXPECT_EQ(run({in_, "-o", out_, "--label", "front \"camera\" \xc3\xa4"}), kExitOk) << text_;
}

/** The name that was given, not that of the ground truth. */
TEST_F(ConvertApp, aFolderThatIsNotThereIsNamed)
{
    const std::string out = dir_ / "none/out.rawlog";
    EXPECT_EQ(run({in_, "-o", out}), kExitEnvironment);
    EXPECT_THAT(
        text_, HasSubstr("-o: cannot write " + out + ": there is no folder " + (dir_ / "none")));
}

TEST_F(ConvertApp, groundTruthThatCannotBeReadLeavesNothing)
{
    std::filesystem::remove(dir_ / "in/groundtruth.txt");
    std::filesystem::create_directory(dir_ / "in/groundtruth.txt");
    EXPECT_EQ(run({in_, "-o", out_}), kExitBadInput);
    EXPECT_THAT(text_, HasSubstr(in_ + "/groundtruth.txt: not a file"));
    EXPECT_FALSE(std::filesystem::exists(out_ + ".partial"));
}

TEST_F(ConvertApp, realFolders)
{
    const char* data = std::getenv("POINTPLANE_DATA");
    if (data == nullptr)
    {
        GTEST_SKIP() << "POINTPLANE_DATA is not set";
    }
    ASSERT_EQ(run({std::string(data) + "/icl_living_room_kt0_part", "-o", out_}), kExitOk) << text_;
    const auto scans = scansOf(out_);
    ASSERT_EQ(scans.size(), 151U);
    EXPECT_LT(scans[0]->cameraParams.fy(), 0);
    EXPECT_EQ(ObservationConverter().convert(*scans[150]).problem, "");
}

TEST(CameraOddity, isThatOfMixedUpCalibrations)
{
    PinholeCamera good;
    good.fx = 517.3;
    good.fy = 516.5;
    good.cx = 318.6;
    good.cy = 255.3;
    good.width = 640;
    good.height = 480;
    good.distortion = {0.262383, -0.953104, -0.005358, 0.002628, 1.163314};
    EXPECT_EQ(oddityOf(good), "");
    PinholeCamera flipped = good;
    flipped.fy *= -1;
    EXPECT_EQ(oddityOf(flipped), "");

    PinholeCamera mixed = good;
    std::swap(mixed.cx, mixed.fy);  // fx cx fy cy
    EXPECT_THAT(oddityOf(mixed), HasSubstr("focal lengths differ (fx=517.3 fy=318.6)"));
    PinholeCamera ofLarger = good;
    ofLarger.width = 320;
    ofLarger.height = 240;
    EXPECT_THAT(oddityOf(ofLarger), HasSubstr("far from the middle of the image (320x240)"));
    PinholeCamera folded = good;
    folded.distortion = {-1, 0, 0, 0, 0};
    EXPECT_THAT(oddityOf(folded), HasSubstr("lens distortion folds"));
}

TEST_F(ConvertApp, depthThatIsListedAsColourIsRefused)
{
    writeBytes(
        dir_ / "in/rgb.txt", "1305031102.160407 depth/0.png\n1305031102.194330 depth/1.png\n");
    EXPECT_EQ(run({in_, "-o", out_}), kExitBadInput);
    EXPECT_THAT(
        text_, HasSubstr("depth/0.png: is listed as colour, but is of 16 bit and 1 channel"));
    EXPECT_FALSE(std::filesystem::exists(out_));
}

/** Fields in the order fx cx fy cy. */
TEST_F(ConvertApp, anOddCameraIsTold)
{
    EXPECT_EQ(run({in_, "-o", out_}), kExitOk) << text_;
    EXPECT_THAT(text_, testing::Not(HasSubstr("odd")));
    writeBytes(dir_ / "in/camera.txt", "26.2 15.5 26.1 11.5 0 0 0 0 0 32 24 5000\n");
    EXPECT_EQ(run({in_, "-o", out_}), kExitOk) << text_;
    EXPECT_THAT(text_, HasSubstr("the camera is odd: its focal lengths differ (fx=26.2 fy=15.5)"));
}
}  // namespace
}  // namespace pointplane
