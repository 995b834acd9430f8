// SPDX-License-Identifier: BSD-3-Clause
// The real program with the real OpenNI2 runtime and a virtual camera.
#include <mrpt/obs/CObservationRobotPose.h>

#include <algorithm>
#include <cmath>

#include "RenderedMotion.h"
#include "SmallDisk.h"
#include "VirtualCamera.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace
{
using namespace pointplane;
using namespace pointplane::test;
using ::testing::HasSubstr;
namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kWidth = 64, kHeight = 48;
constexpr double kPeriod = 0.033333;  // [s] the virtual camera's

class OpenNi2Recording : public ::testing::Test
{
 protected:
    using Args = std::vector<std::string>;

    /** A small camera with 30 different frames. */
    VirtualCamera camera(const std::string& settings = "")
    {
        return VirtualCamera(settings, frames_, 52.5);
    }
    static std::unique_ptr<ChildProcess> start(const VirtualCamera& camera, Args args)
    {
        args.insert(args.begin(), {"--driver", "openni2"});
        return std::make_unique<ChildProcess>(GRABBER, args, camera.environment());
    }
    /** Records the small camera until the program ends by itself. */
    int record(const std::string& settings, const Args& more)
    {
        const auto virtualCamera = camera(settings);
        Args args{"-o", out_, "--mode", "64x48@30", "--warm-up", "0.3"};
        args.insert(args.end(), more.begin(), more.end());
        const auto process = start(virtualCamera, args);
        const int code = process->wait();
        err_ = process->err();
        stdout_ = process->out();
        return code;
    }
    /** Records the small camera to out.oni, and that to the rawlog. */
    int recordOni(const std::string& settings, const Args& more)
    {
        const auto virtualCamera = camera(settings);
        Args args{"-o", oni_, "--mode", "64x48@30", "--warm-up", "0.5"};
        args.insert(args.end(), more.begin(), more.end());
        const auto writing = start(virtualCamera, args);
        EXPECT_EQ(writing->wait(), 0) << writing->err();
        return record("noDevice 1", {"--device", oni_});
    }
    /** Which of the 30 frames. */
    static int depthNumber(const mrpt::obs::CObservation3DRangeScan& scan)
    {
        return depthOf(scan).at<std::uint16_t>(0, 1) - 1001;
    }
    static int colourNumber(const mrpt::obs::CObservation3DRangeScan& scan)
    {
        return scan.intensityImage.asCvMatRef().at<cv::Vec3b>(0, 0)[2];
    }
    void waitForFrames(const std::string& path, std::uintmax_t numBytes)
    {
        for (int i = 0; i < 1000; ++i)
        {
            std::error_code error;
            if (fs::file_size(path, error) >= numBytes && !error)
            {
                return;
            }
            std::this_thread::sleep_for(milliseconds(10));
        }
        FAIL() << path << " does not grow";
    }
    static double stampOf(const mrpt::obs::CObservation3DRangeScan& scan)
    {
        return mrpt::Clock::toDouble(scan.timestamp);
    }

    TempDir dir_;
    std::string out_{dir_ / "out.rawlog"}, oni_{dir_ / "out.oni"};
    std::vector<PlainFrame> frames_{patternFrames(30, kWidth, kHeight)};
    std::string err_, stdout_;
};

TEST_F(OpenNi2Recording, recordsEveryPixelOfConsecutiveFrames)
{
    ASSERT_EQ(record("skewUs 3000", {"--frames", "45"}), 0) << err_;
    const auto scans = scansOf(out_);
    ASSERT_EQ(scans.size(), 45U);
    const auto first = static_cast<std::size_t>(depthNumber(*scans[0]));
    for (std::size_t k = 0; k < scans.size(); ++k)
    {
        const auto& expected = frames_[(first + k) % frames_.size()];
        EXPECT_TRUE(samePixels(depthOf(*scans[k]), expected.depth)) << "frame " << k;
        EXPECT_TRUE(samePixels(scans[k]->intensityImage.asCvMatRef(), expected.colour));
    }
    EXPECT_THAT(err_, HasSubstr("recorded 45 frames"));
    EXPECT_THAT(err_, HasSubstr("colour +3.0 ms after depth on average, 3.0 ms apart at most"));
    EXPECT_THAT(err_, HasSubstr("lost: 0 depth and 0 colour images by the camera"));
    EXPECT_THAT(err_, HasSubstr("serial VC-0000000000000000000012345"));
    EXPECT_THAT(err_, HasSubstr("depth registered to colour, synchronised"));
    EXPECT_THAT(err_, HasSubstr("calibration: the driver's field of view"));
    EXPECT_NEAR(scans[0]->cameraParams.fx(), 52.5, 1e-3);
}

TEST_F(OpenNi2Recording, stampsAreUtcWithTheCamerasSpacing)
{
    const double before = mrpt::Clock::nowDouble();
    ASSERT_EQ(record("", {"--frames", "60"}), 0) << err_;
    const double after = mrpt::Clock::nowDouble();
    const auto scans = scansOf(out_);
    ASSERT_EQ(scans.size(), 60U);
    EXPECT_GT(stampOf(*scans.front()), before);
    EXPECT_LT(stampOf(*scans.back()), after);
    bool complete = true;
    for (std::size_t k = 1; k < scans.size(); ++k)
    {
        // Host jitter is milliseconds; slewing may change 0.2 per mille. A busy machine may lose an
        // image, which then is said.
        const double spacing = stampOf(*scans[k]) - stampOf(*scans[k - 1]);
        const double periods = std::max(1.0, std::round(spacing / kPeriod));
        complete = complete && periods == 1;
        EXPECT_NEAR(spacing, periods * kPeriod, periods * 1e-5) << "frame " << k;
    }
    EXPECT_EQ(complete, err_.find("lost: 0 depth and 0 colour images") != std::string::npos)
        << err_;
}

TEST_F(OpenNi2Recording, wrongTimeUnitOfADriverIsCorrected)
{
    ASSERT_EQ(record("ticksPerUs 60", {"--frames", "30"}), 0) << err_;
    const auto scans = scansOf(out_);
    ASSERT_EQ(scans.size(), 30U);
    EXPECT_NEAR(stampOf(*scans[29]) - stampOf(*scans[0]), 29 * kPeriod, 1e-3);
    EXPECT_THAT(err_, HasSubstr("time stamps are in a wrong unit"));
}

TEST_F(OpenNi2Recording, lostImagesAreReportedAndNothingIsJoinedWrongly)
{
    ASSERT_EQ(record("dropColourEvery 5", {"--duration", "2"}), 0) << err_;
    const auto scans = scansOf(out_);
    EXPECT_NEAR(static_cast<double>(scans.size()), 48.0, 2.0);
    EXPECT_THAT(err_, ::testing::ContainsRegex("lost: 0 depth and 1[0-3] colour images"));
    EXPECT_THAT(err_, ::testing::ContainsRegex("1[0-3] depth and 0 colour images without"));
    for (const auto& scan : scans)
    {
        EXPECT_EQ(depthNumber(*scan), colourNumber(*scan));
    }
}

TEST_F(OpenNi2Recording, lossesThatTheDriverDoesNotNumberAreInTheStamps)
{
    ASSERT_EQ(record("countsDelivered 1\nloseBothEvery 5", {"--duration", "2"}), 0) << err_;
    EXPECT_THAT(
        err_,
        ::testing::ContainsRegex("lost: 1[0-3] depth and 1[0-3] colour images by the camera"));
}

/** Times of arrival jitter: their difference is no delay of depth. */
TEST_F(OpenNi2Recording, stampsThatFollowNoClockTellNoDelay)
{
    ASSERT_EQ(record("constantStamps 1\nskewUs 5000", {"--frames", "20"}), 0) << err_;
    EXPECT_THAT(err_, HasSubstr("times of arrival are used instead"));
    EXPECT_THAT(err_, ::testing::Not(HasSubstr("clock: UTC with the camera's spacing")));
    EXPECT_THAT(err_, HasSubstr("lost: 0 depth and 0 colour images by the camera"));
    RawlogReader reader(out_);
    while (const auto object = reader.next())
    {
        const auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(object);
        EXPECT_THAT(comment ? comment->text : "", ::testing::Not(HasSubstr("depthDelay")));
    }
}

TEST_F(OpenNi2Recording, skewBeyondTheLimitIsNotJoined)
{
    EXPECT_EQ(record("skewUs 8000", {"--max-skew", "0.004", "--timeout", "2"}), 3);
    EXPECT_THAT(err_, HasSubstr("farther apart in time than a pair may be (--max-skew)"));
    EXPECT_THAT(err_, HasSubstr("recorded 0 frames"));
    EXPECT_THAT(err_, ::testing::Not(HasSubstr("clock:")));
    EXPECT_FALSE(fs::exists(out_)) << "it would be in the way of the next attempt";
}

TEST_F(OpenNi2Recording, unpluggingKeepsEverythingBefore)
{
    EXPECT_EQ(record("unplugAt 40", {}), 3);
    EXPECT_THAT(err_, HasSubstr("camera virtual://0 was unplugged; everything before is kept"));
    const auto scans = scansOf(out_);
    EXPECT_GE(scans.size(), 25U);
    EXPECT_LE(scans.size(), 39U);
}

TEST_F(OpenNi2Recording, aSilentStreamEndsWithItsName)
{
    EXPECT_EQ(record("silentColour 1", {"--timeout", "1"}), 3);
    EXPECT_THAT(err_, HasSubstr("camera virtual://0 sends no colour images"));
}

TEST_F(OpenNi2Recording, aSlowStartIsNotLost)
{
    EXPECT_EQ(record("startDelayMs 1500", {"--frames", "10", "--timeout", "5"}), 0) << err_;
    EXPECT_EQ(scansOf(out_).size(), 10U);
}

TEST_F(OpenNi2Recording, aCameraWithoutColourNeedsDepthOnly)
{
    EXPECT_EQ(record("noColour 1", {"--frames", "5"}), 3);
    EXPECT_THAT(err_, HasSubstr("has no colour stream; --depth-only records without it"));
    EXPECT_EQ(record("noColour 1", {"--frames", "5", "--depth-only"}), 0) << err_;
    const auto scans = scansOf(out_);
    ASSERT_EQ(scans.size(), 5U);
    EXPECT_FALSE(scans[0]->hasIntensityImage);
}

TEST_F(OpenNi2Recording, unregisteredDepthIsStoredAsSuch)
{
    EXPECT_EQ(record("noRegistration 1", {"--frames", "3"}), 0) << err_;
    EXPECT_THAT(err_, HasSubstr("depth not registered"));
    EXPECT_FALSE(scansOf(out_).front()->doDepthAndIntensityCamerasCoincide());
    fs::remove(out_);
    EXPECT_EQ(record("noRegistration 1", {"--registration", "on"}), 2);
    EXPECT_THAT(err_, HasSubstr("cannot register depth to colour"));
}

TEST_F(OpenNi2Recording, noCameraExplainsItself)
{
    EXPECT_EQ(record("noDevice 1", {}), 3);
    EXPECT_THAT(err_, HasSubstr("no RGB-D camera found"));
    EXPECT_THAT(err_, HasSubstr("libVirtualCamera.so.0"));
    EXPECT_THAT(err_, HasSubstr("libfreenect"));
    EXPECT_FALSE(fs::exists(out_));
}

TEST_F(OpenNi2Recording, mistakesInFilesAreToldBeforeACameraIsThere)
{
    writeBytes(dir_ / "there.rawlog", "precious");
    writeBytes(dir_ / "typo.ini", "[PoseSolver]\nalpa = 7\n");
    const std::vector<std::pair<Args, std::string>> mistakes{
        {{"-o", out_, "--calibration", dir_ / "none.ini"}, "none.ini: no such file"},
        {{"--live", "--live-config", dir_ / "typo.ini"}, "alpa"},
        {{"--live", "--live-mask", dir_ / "none.png"}, "none.png: no such file"},
        {{"-o", out_, "--live-mask", dir_ / "none.png"},
         "--live-mask and --live-output need --live"},
        {{"-o", dir_ / "there.rawlog"}, "exists already; recordings never overwrite"},
        {{"--live", "--live-output", dir_ / "there.rawlog"},
         "exists already; recordings never overwrite"},
        {{"--live", "--live-output", dir_ / "poses.txt"}, "poses.txt: would be a rawlog; give a"},
        {{"-o", out_, "--preview", out_}, "would write over"}};
    const auto virtualCamera = camera("noDevice 1");
    for (const auto& [args, words] : mistakes)
    {
        Args all{"--wait"};
        all.insert(all.end(), args.begin(), args.end());
        const auto process = start(virtualCamera, all);
        EXPECT_EQ(process->wait(), 2) << words;
        EXPECT_THAT(process->err(), HasSubstr(words));
        EXPECT_THAT(process->err(), ::testing::Not(HasSubstr("camera")));
    }
    EXPECT_EQ(readBytes(dir_ / "there.rawlog"), "precious");
}

TEST_F(OpenNi2Recording, waitsForACameraToAppear)
{
    EXPECT_EQ(record("appearAfterMs 1500", {"--wait", "--frames", "5"}), 0) << err_;
    EXPECT_THAT(err_, HasSubstr("waiting for a camera"));
    EXPECT_EQ(scansOf(out_).size(), 5U);
    fs::remove(out_);
    EXPECT_EQ(record("noDevice 1", {"--wait=1"}), 3);
    for (const char* value : {"-1", "nan", "inf", "abc"})
    {
        EXPECT_EQ(record("noDevice 1", {std::string("--wait=") + value}), 2) << value << err_;
    }
}

TEST_F(OpenNi2Recording, listsCamerasAndModes)
{
    const auto virtualCamera = camera();
    const auto process = start(virtualCamera, {"--list"});
    EXPECT_EQ(process->wait(), 0);
    EXPECT_THAT(process->out(), HasSubstr("0  virtual://0  pointplane Virtual RGB-D"));
    EXPECT_THAT(process->out(), HasSubstr("depth: 64x48@30 DEPTH_1_MM"));
    EXPECT_THAT(process->out(), HasSubstr("registration of depth to colour: yes"));
}

TEST_F(OpenNi2Recording, cameraIsChosenByUriSerialOrIndex)
{
    for (const char* choice : {"virtual://0", "VC-0000000000000000000012345", "0"})
    {
        EXPECT_EQ(record("", {"--frames", "2", "--device", choice}), 0) << choice << err_;
        fs::remove(out_);
    }
    EXPECT_EQ(record("", {"--frames", "2", "--device", "1"}), 3);
    EXPECT_THAT(err_, HasSubstr("no camera '1'; connected:\n  virtual://0"));
}

TEST_F(OpenNi2Recording, badRequestsAreExplained)
{
    const auto virtualCamera = camera();
    const auto messageOf = [&](const Args& args)
    {
        ChildProcess process(GRABBER, args, virtualCamera.environment());
        EXPECT_EQ(process.wait(), 2);
        return process.err();
    };
    EXPECT_THAT(
        messageOf({"-o", out_, "--driver", "openni2", "--mode", "1280x1024@15"}),
        HasSubstr("it offers: 64x48@30 DEPTH_1_MM"));
    EXPECT_THAT(messageOf({"-o", out_, "--mode", "big"}), HasSubstr("640x480@30"));
    EXPECT_THAT(
        messageOf({"-o", out_, "--driver", "kinect"}),
        HasSubstr("no driver 'kinect' in this build"));
    EXPECT_THAT(messageOf({}), HasSubstr("nothing to do"));
    EXPECT_THAT(messageOf({"-o", dir_ / "out.bag"}), HasSubstr("must end in .rawlog or .oni"));
    EXPECT_THAT(
        messageOf({"-o", oni_, "--jpeg", "90"}), HasSubstr("--jpeg is for a rawlog, not for"));
    EXPECT_THAT(messageOf({"-o", oni_, "--label", "A"}), HasSubstr("--label is for a rawlog"));
    EXPECT_THAT(
        messageOf({"-o", out_, "--depth-only", "--registration", "on"}),
        HasSubstr("--depth-only has no colour to register depth to"));
    EXPECT_EQ(record("", {"--jpeg", "101"}), 2);
    EXPECT_EQ(record("", {"--warm-up", "nan"}), 2);
    EXPECT_EQ(record("", {"--frames", "99999999999999999999"}), 2);  // recorded for ever
    EXPECT_EQ(record("", {"--device", dir_ / "missing.oni"}), 2);
    fs::create_directory(dir_ / "out_Images");
    EXPECT_EQ(
        record(
            "", {"--frames", "3", "--images", "external", "--preview", dir_ / "out_Images/p.png"}),
        2);
    EXPECT_THAT(err_, HasSubstr("would write over what images of -o"));
    writeBytes(dir_ / "out_007.rawlog", "precious");  // there it would end
    EXPECT_EQ(record("", {"--frames", "3", "--split-minutes", "1"}), 2);
    EXPECT_THAT(err_, HasSubstr("out_007.rawlog' exists already; recordings never overwrite"));
    writeBytes(out_, "precious");
    EXPECT_EQ(record("", {"--frames", "3"}), 2);
    EXPECT_EQ(readBytes(out_), "precious");
}

TEST_F(OpenNi2Recording, ctrlCAndTermEndCleanly)
{
    for (const int number : {SIGINT, SIGTERM})
    {
        const auto virtualCamera = camera();
        const auto process =
            start(virtualCamera, {"-o", out_, "--mode", "64x48@30", "--warm-up", "0.2"});
        waitForFrames(out_, 100'000);
        process->signal(number);
        EXPECT_EQ(process->wait(seconds(10)), 0) << process->err();
        EXPECT_THAT(process->err(), HasSubstr("recorded"));
        EXPECT_GE(scansOf(out_).size(), 10U);
        fs::remove(out_);
    }
}

/** What comes next in a script needs the recording. */
TEST_F(OpenNi2Recording, toBeStoppedBeforeACameraAppearsIsNoSuccess)
{
    const auto virtualCamera = camera("noDevice 1");
    const auto process = start(virtualCamera, {"-o", out_, "--wait"});
    std::this_thread::sleep_for(std::chrono::seconds(1));
    process->signal(SIGINT);
    EXPECT_EQ(process->wait(seconds(10)), 3);
    EXPECT_THAT(
        process->err(), HasSubstr("stopped before a camera appeared: nothing was recorded"));
    EXPECT_FALSE(fs::exists(out_));
}

TEST_F(OpenNi2Recording, toBeStoppedWhileItWarmsUpIsNoSuccess)
{
    const auto virtualCamera = camera();
    for (const auto& path : {out_, oni_})
    {
        const auto process =
            start(virtualCamera, {"-o", path, "--mode", "64x48@30", "--warm-up", "60"});
        waitForFrames(path, 0);
        std::this_thread::sleep_for(milliseconds(500));
        process->signal(SIGINT);
        EXPECT_EQ(process->wait(seconds(10)), 3);
        EXPECT_THAT(
            process->err(), HasSubstr("ended before the first frame: nothing was recorded"));
        EXPECT_FALSE(fs::exists(path));
    }
}

/** Between the check at the start and the camera's appearance. */
TEST_F(OpenNi2Recording, anOniFileThatAppearsMeanwhileIsKept)
{
    const auto virtualCamera = camera("appearAfterMs 2000");
    const auto process =
        start(virtualCamera, {"-o", oni_, "--mode", "64x48@30", "--frames", "3", "--wait"});
    std::this_thread::sleep_for(seconds(1));
    writeBytes(oni_, "precious");
    EXPECT_EQ(process->wait(), 2);
    EXPECT_THAT(process->err(), HasSubstr("exists already; recordings never overwrite"));
    EXPECT_EQ(readBytes(oni_), "precious");
}

/** nohup(1) has it ignored, so that a recording outlives its terminal. */
TEST_F(OpenNi2Recording, aHangupThatIsIgnoredEndsNothing)
{
    const auto virtualCamera = camera();
    auto* const before = std::signal(SIGHUP, SIG_IGN);
    const auto process =
        start(virtualCamera, {"-o", out_, "--mode", "64x48@30", "--warm-up", "0.2"});
    std::signal(SIGHUP, before);
    waitForFrames(out_, 100'000);
    process->signal(SIGHUP);
    waitForFrames(out_, fs::file_size(out_) + 100'000);
    process->signal(SIGTERM);
    EXPECT_EQ(process->wait(seconds(10)), 0) << process->err();
}

TEST_F(OpenNi2Recording, killNineLosesAtMostTheLastSecond)
{
    for (const char* images : {"embedded", "external"})
    {
        const auto virtualCamera = camera();
        const std::string path = dir_ / (std::string(images) + ".rawlog");
        const auto process = start(
            virtualCamera,
            {"-o", path, "--mode", "64x48@30", "--warm-up", "0.2", "--images", images});
        waitForFrames(path, 1);
        std::this_thread::sleep_for(seconds(2));
        process->signal(SIGKILL);
        EXPECT_EQ(process->wait(), 128 + SIGKILL);
        const double killed = mrpt::Clock::nowDouble();
        RawlogReader reader(path);
        double last = 0.0;
        std::size_t count = 0;
        while (const auto object = reader.next())
        {
            const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(object);
            if (!scan)
            {
                continue;  // a comment: the delay between the device's stamps
            }
            last = stampOf(*scan);
            ++count;
            const auto folder = dir_ / (std::string(images) + "_Images/");
            EXPECT_TRUE(
                std::string(images) == "embedded" ||
                fs::exists(folder + scan->rangeImage_getExternalStorageFile("")));
        }
        EXPECT_GE(count, 30U) << images;
        EXPECT_LT(killed - last, 1.0) << images;
    }
}

TEST_F(OpenNi2Recording, aFullDiskStopsBeforeIt)
{
    EXPECT_EQ(record("", {"--min-free-mb", "1e12"}), 3);
    EXPECT_THAT(err_, HasSubstr("nearly full"));
    EXPECT_FALSE(fs::exists(out_)) << "it would be in the way of the next attempt";
}

TEST_F(OpenNi2Recording, previewIsACompletePicture)
{
    const std::string picture = dir_ / "preview.png";
    EXPECT_EQ(record("", {"--frames", "40", "--preview", picture}), 0) << err_;
    const auto bytes = readBytes(picture);
    ASSERT_GT(bytes.size(), 100U);
    EXPECT_EQ(bytes.substr(1, 3), "PNG");
    EXPECT_THAT(bytes.substr(bytes.size() - 8), HasSubstr("IEND"));
}

TEST_F(OpenNi2Recording, toOniFileAndBackLosesNothing)
{
    ASSERT_EQ(recordOni("", {"--duration", "2"}), 0) << err_;
    const auto scans = scansOf(out_);
    ASSERT_GE(scans.size(), 58U);
    ASSERT_LE(scans.size(), 62U);
    for (std::size_t k = 1; k < scans.size(); ++k)
    {
        EXPECT_NEAR(stampOf(*scans[k]) - stampOf(*scans[k - 1]), kPeriod, 1e-4);
        EXPECT_EQ((depthNumber(*scans[k]) - depthNumber(*scans[k - 1]) + 30) % 30, 1);
    }
    EXPECT_THAT(err_, HasSubstr("taken as registered"));
    EXPECT_THAT(err_, HasSubstr("time stamps count from the date of the .oni file"));
}

/** OpenNI2 lets the stamps of each stream begin at 0. */
TEST_F(OpenNi2Recording, anOniFilePairsWhatWasTakenTogether)
{
    for (const char* settings : {"firstColour 5", "skewUs 12000", "skewUs -12000"})
    {
        ASSERT_EQ(recordOni(settings, {"--frames", "20"}), 0) << err_;
        const auto scans = scansOf(out_);
        EXPECT_GE(scans.size(), 20U) << settings;
        EXPECT_LE(scans.size(), 22U) << settings;
        for (const auto& scan : scans)
        {
            EXPECT_EQ(depthNumber(*scan), colourNumber(*scan)) << settings;
        }
        fs::remove(oni_);
        fs::remove(out_);
    }
}

TEST_F(OpenNi2Recording, aMirroredOniFileIsTurned)
{
    ASSERT_EQ(recordOni("claimsMirrored 1", {"--frames", "5"}), 0) << err_;
    const auto scan = scansOf(out_).front();
    cv::Mat depth, colour;
    cv::flip(depthOf(*scan), depth, 1);
    cv::flip(scan->intensityImage.asCvMatRef(), colour, 1);
    const auto number = static_cast<std::size_t>(depth.at<std::uint16_t>(0, 1) - 1001);
    ASSERT_LT(number, frames_.size());
    EXPECT_TRUE(samePixels(depth, frames_[number].depth));
    EXPECT_TRUE(samePixels(colour, frames_[number].colour));
}

TEST_F(OpenNi2Recording, anOniFileOnAFullDiskIsToldIncomplete)
{
    const std::string disk = dir_ / "disk", err = dir_ / "err";
    // The whole file takes a little more than 300 kB: it has holes, and a frame more or less.
    for (const int kilobytes : {4, 100, 200})
    {
        const auto code = onSmallDisk(
            disk,
            kilobytes,
            [&]
            {
                const auto virtualCamera = camera();
                const auto process = start(
                    virtualCamera,
                    {"-o",
                     disk + "/out.oni",
                     "--mode",
                     "64x48@30",
                     "--warm-up",
                     "0.2",
                     "--frames",
                     "20",
                     "--min-free-mb",
                     "0"});
                const int result = process->wait();
                writeBytes(err, process->err());
                return result;
            });
        if (!code)
        {
            GTEST_SKIP() << "this user may not mount a disk";
        }
        EXPECT_EQ(code, 3) << kilobytes;
        EXPECT_THAT(readBytes(err), HasSubstr("out.oni' is incomplete")) << kilobytes;
    }
}

/** Then OpenNI2's recorder never begins. */
TEST_F(OpenNi2Recording, anOniFileThatCannotGrowIsToldIncomplete)
{
    const auto virtualCamera = camera();
    Args args{"-c", "ulimit -f 1 && exec \"$@\"", "sh", GRABBER, "-o", oni_, "--driver", "openni2"};
    args.insert(args.end(), {"--mode", "64x48@30", "--warm-up", "0.2", "--frames", "5"});
    ChildProcess process("/bin/sh", args, virtualCamera.environment());
    EXPECT_EQ(process.wait(), 3);
    EXPECT_THAT(process.err(), HasSubstr("out.oni' is incomplete"));
}

TEST_F(OpenNi2Recording, damagedOniFilesAreBadInput)
{
    writeBytes(dir_ / "random.oni", std::string(1000, 'x'));
    EXPECT_EQ(record("noDevice 1", {"--device", dir_ / "random.oni"}), 2);
    EXPECT_THAT(err_, HasSubstr("random.oni"));
}

/** What is recorded of a rendered camera in motion must let the odometry find that motion. */
TEST_F(OpenNi2Recording, odometryOnTheRecordingFindsTheTrueMotion)
{
    const RenderedMotion motion(50);
    const VirtualCamera virtualCamera("forthAndBack 1", motion.frames(), RenderedMotion::kFocal_px);
    const std::string poses = dir_ / "poses.rawlog";
    const auto process = start(
        virtualCamera,
        {"-o", out_, "--frames", "48", "--warm-up", "0.2", "--live", "--live-output", poses});
    ASSERT_EQ(process->wait(), 0) << process->err();
    EXPECT_THAT(process->err(), HasSubstr("0 pairs because the queue was full"));
    const auto scans = scansOf(out_);
    ASSERT_EQ(scans.size(), 48U);
    motion.expectOdometryFinds(scans, 0.02);

    // Live odometry: a line and a pose per frame that it took.
    const auto lines = process->out();
    EXPECT_THAT(lines, HasSubstr("# stamp status x y z yaw pitch roll"));
    EXPECT_THAT(lines, HasSubstr(" first 0.000000 0.000000 0.000000"));
    const auto numLines = std::count(lines.begin(), lines.end(), '\n');
    RawlogReader reader(poses);
    long numPoses = 0;
    while (const auto object = reader.next())
    {
        // A comment tells that frames were skipped.
        numPoses += std::dynamic_pointer_cast<mrpt::obs::CObservationRobotPose>(object) ? 1 : 0;
    }
    EXPECT_EQ(reader.ending().kind, RawlogEnd::Clean);
    EXPECT_EQ(numLines, numPoses + 1);
    EXPECT_GE(numPoses, 2) << "a busy machine skips most of them, but it goes on";
}
}  // namespace
