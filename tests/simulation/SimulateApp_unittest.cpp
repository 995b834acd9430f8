// SPDX-License-Identifier: BSD-3-Clause
#include "SimulateApp.h"

#include <pointplane/evaluation/trajectory_text.h>
#include <pointplane/mrpt_io/mrpt_poses.h>
#include <pointplane/mrpt_io/rawlog_names.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <future>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "SequenceWriter.h"
#include "SmallDisk.h"
#include "TempDir.h"
#include "matchers.h"
#include "rawlog_samples.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

namespace pointplane
{
namespace
{
using test::convertedFrames;
using testing::HasSubstr;

struct Finished
{
    int code{-1};
    std::string out, err;
};

Finished run(const std::vector<std::string>& args)
{
    std::ostringstream out, err;
    Finished result;
    result.code = runSimulate(args, out, err);
    result.out = out.str();
    result.err = err.str();
    return result;
}

SimulationParams smallParams()
{
    SimulationParams params;
    params.width = 320;
    params.height = 240;
    params.duration = 0.1;
    return params;
}

std::vector<std::string> smallRun(const std::string& path)
{
    return {
        "corner", "-o", path, "--size", "320x240", "--duration", "0.1", "--seed", "9", "--quiet"};
}

double largestDifference(const cv::Mat& a, const cv::Mat& b)
{
    cv::Mat difference = cv::abs(a - b);
    cv::patchNaNs(difference, 0);
    return cv::norm(difference, cv::NORM_INF);
}
}  // namespace

TEST(SimulateApp, rawlogHoldsTheFramesOfTheSequence)
{
    const test::TempDir dir;
    const Finished result = run(smallRun(dir / "a.rawlog"));
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_THAT(result.out, testing::HasSubstr("4 frames"));
    EXPECT_EQ(result.err, "");
    const std::vector<ConvertedFrame> frames = convertedFrames(dir / "a.rawlog");
    const SimulatedSequence sequence("corner", smallParams(), 9);
    ASSERT_EQ(frames.size(), 4U);
    for (int i = 0; i < 4; ++i)
    {
        const ConvertedFrame& read = frames[static_cast<std::size_t>(i)];
        const RgbdFrame truth = sequence.frame(i);
        EXPECT_EQ(read.problem, "");
        EXPECT_NEAR(read.frame.stamp, truth.stamp, 1e-6);
        EXPECT_EQ(read.frame.camera.fx, truth.camera.fx);
        EXPECT_EQ(read.frame.camera.cy, truth.camera.cy);
        EXPECT_EQ(read.frame.shutter.readoutColour, 0.8 / 30);
        EXPECT_EQ(read.frame.shutter.readoutDepth, 0.8 / 30);
        EXPECT_EQ(read.frame.shutter.depthDelay, -0.01);
        EXPECT_THAT(read.T_robot_cam, test::IsNearPose(opticalInBody(), 1e-9, 1e-9));
        EXPECT_EQ(cv::countNonZero(read.frame.depth > 0), cv::countNonZero(truth.depth > 0));
        EXPECT_LE(largestDifference(read.frame.depth, truth.depth), 1.01e-4);
        cv::Mat gray;
        cv::absdiff(read.frame.gray, truth.gray, gray);
        EXPECT_LE(cv::norm(gray, cv::NORM_INF), 1) << "only the conversion to grey may round";
    }
}

TEST(SimulateApp, groundTruthIsTheCamerasPoseOrOnRequestTheRobots)
{
    const test::TempDir dir;
    ASSERT_EQ(run(smallRun(dir / "a.rawlog")).code, 0);
    std::vector<std::string> args = smallRun(dir / "b.rawlog");
    args.insert(args.end(), {"--truth-frame", "robot"});
    ASSERT_EQ(run(args).code, 0);
    const Trajectory camera = readTrajectoryText(dir / "a.groundtruth.txt");
    const Trajectory robot = readTrajectoryText(dir / "b.groundtruth.txt");
    const SimulatedSequence sequence("corner", smallParams(), 9);
    ASSERT_EQ(camera.size(), 4U);
    ASSERT_EQ(robot.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i)
    {
        const double stamp = sequence.stamp(static_cast<int>(i));
        EXPECT_NEAR(camera.stamps[i], stamp, 1e-6);
        const Eigen::Isometry3d T_world_cam = sequence.truth(stamp);
        EXPECT_THAT(camera.poses[i], test::IsNearPose(T_world_cam, 1e-8, 1e-8));
        // The robot looks along its x axis, with y to the left.
        const Eigen::Matrix3d R = robot.poses[i].linear();
        EXPECT_THAT(
            robot.poses[i].translation(), test::IsMatrixNear(T_world_cam.translation(), 1e-8));
        EXPECT_THAT(R.col(0), test::IsMatrixNear(T_world_cam.linear().col(2), 1e-8));
        EXPECT_THAT(R.col(1), test::IsMatrixNear(-T_world_cam.linear().col(0), 1e-8));
    }
}

TEST(SimulateApp, sameSeedSameBytesOtherSeedOtherBytes)
{
    const test::TempDir dir;
    ASSERT_EQ(run(smallRun(dir / "a.rawlog")).code, 0);
    ASSERT_EQ(run(smallRun(dir / "b.rawlog")).code, 0);
    std::vector<std::string> other = smallRun(dir / "c.rawlog");
    other[8] = "10";
    ASSERT_EQ(run(other).code, 0);
    EXPECT_EQ(test::readBytes(dir / "a.rawlog"), test::readBytes(dir / "b.rawlog"));
    EXPECT_EQ(
        test::readBytes(dir / "a.groundtruth.txt"), test::readBytes(dir / "b.groundtruth.txt"));
    EXPECT_NE(
        test::readBytes(dir / "a.groundtruth.txt"), test::readBytes(dir / "c.groundtruth.txt"));
}

TEST(SimulateApp, externalImagesAreTheEmbeddedOnes)
{
    const test::TempDir dir;
    ASSERT_EQ(run(smallRun(dir / "in.rawlog")).code, 0);
    std::vector<std::string> args = smallRun(dir / "ex.rawlog");
    args.emplace_back("--external");
    ASSERT_EQ(run(args).code, 0);
    EXPECT_LT(std::filesystem::file_size(dir / "ex.rawlog"), 5000U) << "images are still inside";
    const auto embedded = convertedFrames(dir / "in.rawlog"),
               external = convertedFrames(dir / "ex.rawlog");
    ASSERT_EQ(external.size(), embedded.size());
    for (std::size_t i = 0; i < external.size(); ++i)
    {
        ASSERT_EQ(external[i].problem, "");
        EXPECT_EQ(largestDifference(external[i].frame.depth, embedded[i].frame.depth), 0);
        EXPECT_EQ(cv::norm(external[i].frame.gray, embedded[i].frame.gray, cv::NORM_INF), 0);
    }
}

TEST(SimulateApp, masksTellWhatMoves)
{
    const test::TempDir dir;
    std::vector<std::string> args = smallRun(dir / "a.rawlog");
    args[0] = "half";
    args.emplace_back("--masks");
    const Finished done = run(args);
    ASSERT_EQ(done.code, 0) << done.err;
    EXPECT_THAT(done.out, testing::HasSubstr("a_Masks: masks of 1 mover\n"));
    const SimulatedSequence sequence("half", smallParams(), 9);
    for (int i = 0; i < sequence.numFrames(); ++i)
    {
        const std::string file = "a_Masks/00000" + std::to_string(i) + ".png";
        const cv::Mat mask = cv::imread(dir / file, cv::IMREAD_UNCHANGED);
        ASSERT_EQ(mask.type(), CV_8UC1) << file;
        EXPECT_EQ(cv::norm(mask, sequence.trueMovers(i).labels, cv::NORM_INF), 0);
    }
}

/** They appear with their recording, and leave nothing of another one. */
TEST(SimulateApp, masksReplaceThoseOfAnEarlierRun)
{
    namespace fs = std::filesystem;
    const test::TempDir dir;
    const std::string folder = dir / "a_Masks";
    std::vector<std::string> args = smallRun(dir / "a.rawlog");
    args.emplace_back("--masks");
    ASSERT_EQ(run(args).code, 0);
    ASSERT_TRUE(fs::exists(folder + "/000003.png"));
    fs::create_directory(folder + ".partial");
    test::writeBytes(folder + ".partial/000000.png.partial", "of a run that was killed");
    args[6] = "0.05";
    const Finished shorter = run(args);
    ASSERT_EQ(shorter.code, 0) << shorter.err;
    EXPECT_TRUE(fs::exists(folder + "/000001.png"));
    EXPECT_FALSE(fs::exists(folder + "/000003.png"));
    EXPECT_FALSE(fs::exists(folder + ".partial"));

    args.pop_back();
    const Finished without = run(args);
    EXPECT_EQ(without.code, 0);
    EXPECT_EQ(
        without.err,
        "pointplane-simulate: warning: " + folder +
            " was there before; remove it if it is of another recording\n");
}

/** By the name alone or the picture alone it is no mask. */
TEST(SimulateApp, masksDoNotReplaceWhatIsSomebodyElses)
{
    namespace fs = std::filesystem;
    const test::TempDir dir;
    const std::string folder = dir / "a_Masks", other = dir / "other.txt";
    test::writeBytes(other, "precious");
    std::vector<std::string> args = smallRun(dir / "a.rawlog");
    args.emplace_back("--masks");
    ASSERT_EQ(run(args).code, 0);
    const std::string rawlog = test::readBytes(dir / "a.rawlog");
    const auto expectRefused = [&](const std::string& name)
    {
        const Finished refused = run(args);
        EXPECT_EQ(refused.code, 3) << name;
        EXPECT_THAT(
            refused.err,
            HasSubstr(
                "cannot replace " + folder + ": it holds '" + name +
                "', which is no mask of what moves; move that elsewhere\n"));
        EXPECT_EQ(test::readBytes(dir / "a.rawlog"), rawlog);
        EXPECT_FALSE(fs::exists(dir / "a.rawlog.partial"));
        EXPECT_EQ(test::readBytes(other), "precious");
        fs::remove(folder + "/" + name);
    };
    test::writeBytes(folder + "/000001.png", "precious");
    expectRefused("000001.png");
    cv::imwrite(folder + "/000001.png", cv::Mat(24, 32, CV_8UC3));
    expectRefused("000001.png");
    fs::copy_file(folder + "/000000.png", folder + "/mine.png");
    expectRefused("mine.png");
    fs::create_symlink("../other.txt", folder + "/000001.png");
    expectRefused("000001.png");
    EXPECT_EQ(run(args).code, 0);
}

TEST(SimulateApp, shutterIsToldUnlessHidden)
{
    const test::TempDir dir;
    std::vector<std::string> args = smallRun(dir / "a.rawlog");
    args.emplace_back("--hide-shutter");
    ASSERT_EQ(run(args).code, 0);
    const auto frames = convertedFrames(dir / "a.rawlog");
    ASSERT_FALSE(frames.empty());
    EXPECT_TRUE(std::isnan(frames[0].frame.shutter.readoutColour));
    EXPECT_TRUE(std::isnan(frames[0].frame.shutter.depthDelay));
}

TEST(SimulateApp, idealAndSettingsReachTheCamera)
{
    const test::TempDir dir;
    std::vector<std::string> args = smallRun(dir / "a.rawlog");
    for (const char* arg : {"--ideal", "--set", "readoutDepth=0.02", "--set", "focalLengthPx=600"})
    {
        args.emplace_back(arg);
    }
    ASSERT_EQ(run(args).code, 0);
    const auto frames = convertedFrames(dir / "a.rawlog");
    ASSERT_FALSE(frames.empty());
    EXPECT_EQ(frames[0].frame.shutter.readoutColour, 0);
    EXPECT_EQ(frames[0].frame.shutter.readoutDepth, 0.02);
    EXPECT_EQ(frames[0].frame.camera.fx, 300);
    EXPECT_EQ(cv::countNonZero(frames[0].frame.depth > 0), 320 * 240);
}

TEST(SimulateApp, settingsMayStandBeforeTheScene)
{
    const test::TempDir dir;
    std::vector<std::string> args = smallRun(dir / "a.rawlog");
    args.insert(args.begin(), {"--set", "readoutDepth=0.02"});
    ASSERT_EQ(run(args).code, 0);
    EXPECT_EQ(convertedFrames(dir / "a.rawlog").at(0).frame.shutter.readoutDepth, 0.02);
}

TEST(SimulateApp, badUsageIsNamedAndLeavesNoFile)
{
    const test::TempDir dir;
    const std::string path = dir / "a.rawlog";
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
        {{"cave", "-o", path}, "cave"},
        {{"corner", "-o", path, "--set", "fpss=3"}, "fpss"},
        {{"corner", "-o", path, "--set", "fps=fast"}, "fps"},
        {{"corner", "-o", path, "--set", "a"}, "--set a: expected key=value (see --list-settings)"},
        {{"corner", "-o", path, "--set", "foo=1"},
         "--set foo=1: unknown key 'foo' (see --list-settings)"},
        {{"corner", "-o", path, "--label", "a\nb"}, "new line or another control character"},
        {{"corner", "-o", path, "--set", "fps=0"}, "--set: fps = 0 is not in"},
        {{"corner", "-o", path, "--set", "light=1", "--set", "light=2"},
         "setting 'Simulation.light=2': [Simulation] light is set twice"},
        {{"corner", "-o", path, "--fps", "10", "--set", "fps=20"}, "fps=20: --fps sets it, too"},
        {{"corner", "-o", path, "--size", "64x48", "--set", "width=32"}, "--size sets it, too"},
        {{"corner", "-o", path + ".txt"}, "a.rawlog.txt: would be a rawlog; give a name that ends"},
        {{"corner", "-o", path, "--size", "640"}, "--size"},
        {{"corner", "-o", path, "--size", "640x480px"}, "--size"},
        {{"corner", "-o", path, "--size", "320x0"}, "--size: height = 0 is not in [16, 4096]"},
        {{"corner", "-o", path, "--duration", "-1"}, "--duration: duration = -1 is not in"},
        {{"corner"}, "--output"}};
    for (const auto& [args, named] : cases)
    {
        const Finished result = run(args);
        EXPECT_EQ(result.code, 2) << named;
        EXPECT_THAT(result.err, testing::HasSubstr(named));
        EXPECT_FALSE(std::filesystem::exists(path));
    }
}

TEST(SimulateApp, whatStandsInTheWayOfMasksIsToldBeforeTheRun)
{
    const test::TempDir dir;
    test::writeBytes(dir / "a_Masks", "precious");
    const Finished result = run({"corner", "-o", dir / "a.rawlog", "--duration", "0", "--masks"});
    EXPECT_EQ(result.code, 2);
    EXPECT_THAT(result.err, testing::HasSubstr("a_Masks is not a folder"));
    EXPECT_FALSE(std::filesystem::exists(dir / "a.rawlog"));
    EXPECT_FALSE(std::filesystem::exists(dir / "a.rawlog.partial"));
}

/** As /dev/null would be: nothing appears in its folder. */
TEST(SimulateApp, nothingIsWrittenBesideAPipe)
{
    const test::TempDir dir;
    const std::string pipe = dir / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::vector<std::string> args{
        "corner", "-o", pipe, "--size", "32x24", "--duration", "0.1", "--quiet"};
    auto reader = std::async(std::launch::async, [&] { return test::readBytes(pipe); });
    const Finished piped = run(args);
    EXPECT_EQ(piped.code, 0) << piped.err;
    EXPECT_GT(reader.get().size(), 100U);
    EXPECT_THAT(piped.out, HasSubstr("the ground truth was not written"));
    for (const char* option : {"--masks", "--external"})
    {
        args.back() = option;
        const Finished refused = run(args);
        EXPECT_EQ(refused.code, 2) << option;
        EXPECT_THAT(refused.err, HasSubstr("of -o " + pipe + ": is not a file"));
    }
    const std::filesystem::directory_iterator first(dir / ""), end;
    EXPECT_EQ(std::distance(first, end), 1);
}

/** Three names of a rawlog, and one of the ground truth. */
TEST(SimulateApp, groundTruthOfAnotherRawlogIsNotReplaced)
{
    for (const std::string first : {"b.rawlog", "b.rawlog.gz", "b"})
    {
        const test::TempDir dir;
        const std::string truth = dir / "b.groundtruth.txt";
        std::vector<std::string> args{
            "corner", "--size", "32x24", "--duration", "0.1", "--quiet", "-o", dir / first};
        ASSERT_EQ(run(args).code, 0);
        const std::string before = test::readBytes(truth);
        ASSERT_EQ(run(args).code, 0);  // its own
        args[0] = "room";
        for (const std::string other : {"b.rawlog", "b.rawlog.gz", "b"})
        {
            if (other == first)
            {
                continue;
            }
            args.back() = dir / other;
            const Finished refused = run(args);
            EXPECT_EQ(refused.code, 2) << first << other;
            EXPECT_THAT(
                refused.err,
                HasSubstr(truth + ", which is that of " + (dir / first) + "; give another name"));
            EXPECT_EQ(test::readBytes(truth), before);
            EXPECT_FALSE(std::filesystem::exists(dir / other));
        }
    }
}

/** A folder of that name is none, and a link leads to the same rawlog. */
TEST(SimulateApp, groundTruthIsReplacedWhereNoOtherRawlogHasIt)
{
    const test::TempDir dir;
    std::filesystem::create_directory(dir / "b");
    std::filesystem::create_symlink("b.rawlog", dir / "b.rawlog.gz");
    for (const char* seed : {"1", "2"})
    {
        std::vector<std::string> args = smallRun(dir / "b.rawlog");
        args[8] = seed;
        const Finished again = run(args);
        EXPECT_EQ(again.code, 0) << again.err;
    }
}

TEST(SimulateApp, groundTruthThatALinkLeadsToIsNotReplaced)
{
    const test::TempDir dir;
    const std::string link = dir / "w.groundtruth.txt";
    ASSERT_EQ(run(smallRun(dir / "a.rawlog")).code, 0);
    const std::string before = test::readBytes(dir / "a.groundtruth.txt");
    std::filesystem::create_symlink("a.groundtruth.txt", link);
    std::vector<std::string> args = smallRun(dir / "w.rawlog");
    EXPECT_EQ(run(args).code, 0) << "it is the same";
    args[8] = "10";
    const Finished refused = run(args);
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("would replace " + link + ", which is a different one"));
    EXPECT_EQ(test::readBytes(dir / "a.groundtruth.txt"), before);
}

/** The lines of its shutter would be columns. */
TEST(SimulateApp, uprightImagesOfARollingShutterAreRefused)
{
    const test::TempDir dir;
    std::vector<std::string> args = smallRun(dir / "a.rawlog");
    args[4] = "240x320";
    const Finished refused = run(args);
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("set readoutColour and readoutDepth to 0"));
    args.insert(args.end(), {"--set", "readoutColour=0", "--set", "readoutDepth=0"});
    EXPECT_EQ(run(args).code, 0);
}

/** Nobody named it, so it may be a user's. What this program wrote can be rendered again. */
TEST(SimulateApp, aGroundTruthThatIsNotItsOwnIsNotReplaced)
{
    const test::TempDir dir;
    const std::string truth = dir / "a.groundtruth.txt";
    test::writeBytes(truth, "my mocap\n");
    const Finished refused = run(smallRun(dir / "a.rawlog"));
    EXPECT_EQ(refused.code, 2);
    EXPECT_EQ(
        refused.err,
        "pointplane-simulate: -o " + (dir / "a.rawlog") + ": its ground truth would replace " +
            truth + ", which is a different one; move that file or give another name\n");
    EXPECT_EQ(test::readBytes(truth), "my mocap\n");
    EXPECT_FALSE(std::filesystem::exists(dir / "a.rawlog"));
    std::filesystem::remove(truth);
    for (const char* seed : {"1", "1", "2"})
    {
        std::vector<std::string> args = smallRun(dir / "a.rawlog");
        args[8] = seed;
        const Finished again = run(args);
        EXPECT_EQ(again.code, 0) << again.err;
    }
}

TEST(SimulateApp, unwritableOutputIsTheEnvironmentsFault)
{
    const Finished result = run({"corner", "-o", "/no/such/dir/a.rawlog", "--duration", "0"});
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.err, testing::HasSubstr("/no/such/dir/a.rawlog"));
}

TEST(SimulateApp, aFullDiskIsReportedAndLeavesNothingThatLooksComplete)
{
    const test::TempDir dir;
    const std::string path = dir / "disk/a.rawlog";
    for (const bool external : {false, true})
    {
        std::vector<std::string> args = smallRun(path);
        if (external)
        {
            args.emplace_back("--external");
        }
        for (const int kilobytes : {4, 100, 300})
        {
            const auto code = test::onSmallDisk(
                dir / "disk",
                kilobytes,
                [&]
                {
                    const Finished result = run(args);
                    return std::filesystem::exists(path) ? 99 : result.code;
                });
            if (!code)
            {
                GTEST_SKIP() << "this user may not mount a disk";
            }
            EXPECT_EQ(*code, 3) << external << " with " << kilobytes << " kB";
        }
    }
}

/** Else it would be beside frames that it does not tell of. */
TEST(SimulateApp, theGroundTruthAppearsAfterTheRawlogOnly)
{
    namespace fs = std::filesystem;
    const test::TempDir dir;
    const std::string path = dir / "a.rawlog";
    std::thread somebody(
        [&]
        {
            while (!fs::exists(path + ".partial"))
            {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
            fs::create_directories(path + "/in the way");
        });
    const Finished result = run(smallRun(path));
    somebody.join();
    EXPECT_EQ(result.code, 3);
    EXPECT_FALSE(fs::exists(groundTruthOf(path)));
}

TEST(SimulateApp, listsItsSettingsAndScenes)
{
    const Finished settings = run({"--list-settings"});
    EXPECT_EQ(settings.code, 0);
    EXPECT_THAT(settings.out, testing::HasSubstr("depthDelay = -0.01"));
    const Finished phone = run({"--list-settings", "--camera", "phone", "--set", "maxDepth=4"});
    EXPECT_EQ(phone.code, 0);
    EXPECT_THAT(phone.out, testing::HasSubstr("depthDelay = 0 "));
    EXPECT_THAT(phone.out, testing::HasSubstr("maxDepth = 4 "));
    const Finished refused = run({"--list-settings", "--set", "maxDepth=-4"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, testing::HasSubstr("maxDepth = -4"));
    const Finished help = run({"--help"});
    EXPECT_EQ(help.code, 0);
    EXPECT_THAT(help.out, testing::HasSubstr("notexture: "));
}
}  // namespace pointplane
