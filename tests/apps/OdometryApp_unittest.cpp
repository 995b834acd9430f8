// SPDX-License-Identifier: BSD-3-Clause
#include "OdometryApp.h"

#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/VisualOdometry.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/external_range.h>

#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <future>
#include <limits>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "TempDir.h"
#include "linear_algebra.h"
#include "rawlog_samples.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

namespace pointplane
{
namespace
{
using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationComment;
using mrpt::obs::CObservationRobotPose;
using test::readBytes;
using test::sampleScan;
using test::TempDir;
using test::writeBytes;
using testing::HasSubstr;
using testing::Not;

struct Outcome
{
    int code{-1};
    std::string out, err;
};

class OdometryApp : public testing::Test
{
 protected:
    [[nodiscard]] Outcome run(std::vector<std::string> args) const
    {
        args.emplace_back("--quiet");
        std::ostringstream out, err;
        Outcome outcome;
        outcome.code = runOdometry(args, out, err);
        outcome.out = out.str();
        outcome.err = err.str();
        return outcome;
    }

    /** Runs on n sample scans that `change` has been applied to. */
    template <class Change>
    [[nodiscard]] Outcome runOn(int n, const Change& change) const
    {
        RawlogWriter writer(in_);
        for (int i = 0; i < n; ++i)
        {
            const auto scan = sampleScan(i, 64, 48);
            change(i, *scan);
            writer.write(*scan);
        }
        writer.close();
        return run({in_, "-o", out_});
    }

    [[nodiscard]] std::size_t numPoses(const std::string& path) const
    {
        const auto contents = test::readAll(path);
        return static_cast<std::size_t>(std::count_if(
            contents.objects.begin(),
            contents.objects.end(),
            [](const auto& o)
            { return std::dynamic_pointer_cast<CObservationRobotPose>(o) != nullptr; }));
    }

    TempDir dir_;
    std::string in_{dir_ / "in.rawlog"};
    std::string out_{dir_ / "out.rawlog"};
};

TEST_F(OdometryApp, everyFrameGetsAPoseWithItsStamp)
{
    const Outcome outcome = runOn(5, [](int, CObservation3DRangeScan&) {});
    EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("RGBD: 5 frames"));
    const auto contents = test::readAll(out_);
    EXPECT_EQ(contents.ending.kind, RawlogEnd::Clean);
    mrpt::Clock::time_point stamp;
    int numFrames = 0;
    for (const auto& object : contents.objects)
    {
        if (const auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(object))
        {
            EXPECT_EQ(scan->rangeImage, sampleScan(numFrames++, 64, 48)->rangeImage);
            stamp = scan->timestamp;
        }
        else if (const auto pose = std::dynamic_pointer_cast<CObservationRobotPose>(object))
        {
            EXPECT_EQ(pose->timestamp, stamp);
            EXPECT_EQ(pose->sensorLabel, "RGBD_pose");
            EXPECT_TRUE(test::hasCholesky(pose->pose.cov.asEigen()));
        }
    }
    EXPECT_EQ(numFrames, 5);
}

TEST_F(OdometryApp, motionsSinceEarlierFramesAreWrittenWhenAskedFor)
{
    (void)runOn(5, [](int, CObservation3DRangeScan&) {});
    EXPECT_EQ(numPoses(out_), 5U);
    ASSERT_EQ(run({in_, "-o", out_, "--since", "3"}).code, kExitOk);
    std::map<std::string, int> labels;
    for (const auto& object : test::readAll(out_).objects)
    {
        if (const auto pose = std::dynamic_pointer_cast<CObservationRobotPose>(object))
        {
            ++labels[pose->sensorLabel];
            EXPECT_TRUE(test::hasCholesky(pose->pose.cov.asEigen()));
        }
    }
    const std::map<std::string, int> expected{
        {"RGBD_pose", 5}, {"RGBD_since_1", 4}, {"RGBD_since_2", 3}, {"RGBD_since_3", 2}};
    EXPECT_EQ(labels, expected);
    EXPECT_EQ(run({in_, "-o", out_, "--since", "0"}).code, kExitBadInput);
}

TEST_F(OdometryApp, sameInputSameBytesForAnyNumberOfThreads)
{
    ASSERT_EQ(runOn(8, [](int, CObservation3DRangeScan&) {}).code, kExitOk);
    const std::string rawlog = readBytes(out_);
    std::string trajectory;
    for (const char* jobs : {"1", "2", "3", "3"})
    {
        ASSERT_EQ(
            run({in_, "-o", out_, "--jobs", jobs, "--trajectory", dir_ / "t.txt"}).code, kExitOk);
        EXPECT_EQ(readBytes(out_), rawlog) << jobs << " jobs";
        const std::string text = readBytes(dir_ / "t.txt");
        EXPECT_TRUE(trajectory.empty() || trajectory == text) << jobs << " jobs";
        trajectory = text;
    }
}

TEST_F(OdometryApp, aFrameThatCannotBeUsedIsNamedAndTheRestIsDone)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    struct Case
    {
        std::function<void(CObservation3DRangeScan&)> change;
        const char* text;
    };
    const std::vector<Case> cases{
        {[](auto& s) { s.hasRangeImage = s.hasIntensityImage = false; }, "no range image"},
        {[](auto& s) { s.cameraParams.ncols = 640; },
         "range image is 64x48 but cameraParams is for 640x48"},
        {[nan](auto& s) { s.cameraParams.setIntrinsicParamsFromValues(nan, nan, 1, 1); },
         "not finite"},
        {[](auto& s) { s.cameraParamsIntensity.setIntrinsicParamsFromValues(0, 0, 0, 0); },
         "focal length is zero"},
        {[](auto& s) { s.timestamp = mrpt::Clock::fromDouble(900); }, "time stamp is not after"},
    };
    for (const Case& c : cases)
    {
        const Outcome outcome = runOn(
            4,
            [&c](int i, CObservation3DRangeScan& scan)
            {
                if (i == 2)
                {
                    c.change(scan);
                }
            });
        EXPECT_EQ(outcome.code, kExitIncomplete) << c.text;
        EXPECT_THAT(
            outcome.err, HasSubstr("1 of 4 frames could not be used, first frame 2 (stamp "));
        EXPECT_THAT(outcome.err, HasSubstr(c.text));
        EXPECT_EQ(numPoses(out_), 4U) << c.text;
        EXPECT_THAT(outcome.out, HasSubstr("1 lost")) << c.text;
    }
}

TEST_F(OdometryApp, theSummaryGroupsTheFramesThatWereNotTracked)
{
    const Outcome outcome = runOn(
        9,
        [](int i, CObservation3DRangeScan& scan)
        {
            if (i == 2 || i == 6 || i == 7)
            {
                scan.hasRangeImage = scan.hasIntensityImage = false;
            }
            if (i == 4)
            {
                scan.timestamp = mrpt::Clock::fromDouble(900);
            }
        });
    EXPECT_EQ(outcome.code, kExitIncomplete);
    EXPECT_THAT(outcome.out, HasSubstr("4 lost"));
    EXPECT_THAT(
        outcome.out,
        HasSubstr("\n  frame 2 (stamp 1000.062500000): lost: observation has no range image\n"
                  "  frame 4 (stamp 900.000000000): lost: its time stamp is not after the previous "
                  "frame's\n"
                  "  frames 6-7 (stamp 1000.187500000): lost: observation has no range image\n"));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

/** Here by a pipe that pauses in the middle of them. */
TEST_F(OdometryApp, theTimePerFrameIsWithoutTheFramesThatAreSkipped)
{
    RawlogWriterOptions plain;
    plain.compressionLevel = 0;
    test::writeObservations(in_, 300, plain);  // more bytes than a reader takes in advance
    const std::string bytes = readBytes(in_), pipe = dir_ / "pipe.rawlog";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    for (const char* jobs : {"1", "2"})
    {
        auto writer = std::async(
            std::launch::async,
            [&]
            {
                std::ofstream out(pipe, std::ios::binary);
                out << bytes.substr(0, bytes.size() / 2) << std::flush;
                std::this_thread::sleep_for(std::chrono::milliseconds(1500));
                out << bytes.substr(bytes.size() / 2);
            });
        const Outcome outcome = run({pipe, "--first", "297", "--jobs", jobs});
        writer.get();
        double milliseconds = 0;
        const std::size_t at = outcome.out.find("path ");
        ASSERT_NE(at, std::string::npos) << outcome.out << outcome.err;
        ASSERT_EQ(
            std::sscanf(outcome.out.c_str() + at, "path %*f m; %lf ms/frame", &milliseconds), 1);
        EXPECT_LT(milliseconds, 300) << outcome.out;  // 500, if the pause counts
        EXPECT_GT(milliseconds, 0);
    }
}

TEST_F(OdometryApp, oneFrameIsTheFirstAndTellsNoMotion)
{
    test::writeObservations(in_, 3);
    EXPECT_THAT(
        run({in_, "--count", "1"}).out,
        HasSubstr("RGBD: 1 frame, the first: nothing to compare it with; "));
    EXPECT_THAT(
        run({in_, "--count", "2"}).out, HasSubstr("RGBD: 2 frames: 2 tracked (2 in part), "));
    const Outcome lost = runOn(
        1,
        [](int, CObservation3DRangeScan& scan)
        { scan.hasRangeImage = scan.hasIntensityImage = false; });
    EXPECT_THAT(lost.out, HasSubstr("1 frame: 0 tracked, 0 predicted, 1 lost; path"));
    EXPECT_THAT(lost.err, HasSubstr("1 of 1 frame could not be used, first"));
}

/** The uppermost sixth of the images is the robot. */
TEST_F(OdometryApp, aMaskLeavesOutTheRobot)
{
    test::writeObservations(in_, 5);
    const cv::Mat scan = sampleScan(0)->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
    cv::Mat mask(scan.size(), CV_8UC1, cv::Scalar(255));
    mask.rowRange(0, mask.rows / 6).setTo(0);
    cv::imwrite(dir_ / "mask.png", mask);
    const auto poses = [&](const std::vector<std::string>& options)
    {
        std::vector<std::string> args{in_, "--trajectory", dir_ / "poses.txt"};
        args.insert(args.end(), options.begin(), options.end());
        const Outcome outcome = run(args);
        EXPECT_EQ(outcome.code, kExitOk) << outcome.out << outcome.err;
        return readBytes(dir_ / "poses.txt");
    };
    EXPECT_NE(poses({"--mask", dir_ / "mask.png"}), poses({}));
    EXPECT_THAT(
        run({in_, "--mask", dir_ / "mask.png", "--trajectory", dir_ / "mask.png"}).err,
        HasSubstr("is an input"));
}

/** Else one would look for depth in the recording. */
TEST_F(OdometryApp, aMaskThatLeavesNoDepthIsNamed)
{
    test::writeObservations(in_, 3);
    cv::Mat mask(24, 32, CV_8UC1, cv::Scalar(0));
    mask.at<std::uint8_t>(12, 16) = 255;
    cv::imwrite(dir_ / "one.png", mask);
    const Outcome outcome = run({in_, "--mask", dir_ / "one.png", "-o", out_});
    EXPECT_EQ(outcome.code, kExitIncomplete);
    EXPECT_THAT(
        outcome.err, HasSubstr(" (" + (dir_ / "one.png") + " leaves depth at 1 of 768 pixels)\n"));
    EXPECT_THAT(
        runOn(3, [](int, CObservation3DRangeScan& scan) { scan.rangeUnits = 1e-6F; }).err,
        testing::Not(HasSubstr("leaves depth")));
}

/** As one that was drawn for another camera. What an earlier run wrote stays. */
TEST_F(OdometryApp, aMaskOfAnotherSizeEndsTheRunAtTheFirstFrame)
{
    const std::string poses = dir_ / "poses.txt";
    test::writeObservations(in_, 5);
    ASSERT_EQ(run({in_, "--trajectory", poses}).code, kExitOk);
    const std::string before = readBytes(poses);
    cv::Mat mask(10, 20, CV_8UC1, cv::Scalar(255));
    mask.row(0).setTo(0);
    cv::imwrite(dir_ / "small.png", mask);
    const cv::Size size =
        sampleScan(0)->intensityImage.asCvMat<cv::Mat>(mrpt::img::SHALLOW_COPY).size();
    for (const char* jobs : {"1", "2"})
    {
        const Outcome outcome =
            run({in_, "--mask", dir_ / "small.png", "--jobs", jobs, "--trajectory", poses});
        EXPECT_EQ(outcome.code, kExitBadInput);
        EXPECT_EQ(
            outcome.err,
            "pointplane-odometry: " + (dir_ / "small.png") +
                ": is 20x10, but images of camera 'RGBD' are " + std::to_string(size.width) + "x" +
                std::to_string(size.height) + "; draw it in that size\n");
        EXPECT_EQ(readBytes(poses), before);
        EXPECT_FALSE(std::filesystem::exists(poses + ".partial"));
    }
}

/** Depth whose units are wrong by a thousand, and a camera that hangs. */
TEST_F(OdometryApp, aRunThatMeasuresNothingIsNotWell)
{
    const auto unitsOf = [](float units)
    { return [units](int, CObservation3DRangeScan& scan) { scan.rangeUnits = units; }; };
    const Outcome outcome = runOn(5, unitsOf(1e-6F));
    EXPECT_THAT(outcome.out, HasSubstr("5 frames: 0 tracked, 0 predicted, 5 lost"));
    EXPECT_THAT(outcome.out, HasSubstr("nearer than PointLifter.minDepth (0.02 m)"));
    EXPECT_EQ(outcome.code, kExitIncomplete);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(runOn(5, unitsOf(1e-3F)).code, kExitOk);
    EXPECT_EQ(runOn(1, unitsOf(1e-3F)).code, kExitOk);  // has no motion

    // One frame, and the same again: nothing is measured.
    const cv::Mat images =
        sampleScan(0, 64, 48)->intensityImage.asCvMat<cv::Mat>(mrpt::img::DEEP_COPY);
    const Outcome frozen = runOn(
        5,
        [&](int, CObservation3DRangeScan& scan)
        {
            scan.intensityImage = mrpt::img::CImage(images, mrpt::img::DEEP_COPY);
            scan.rangeImage = sampleScan(0, 64, 48)->rangeImage;
        });
    EXPECT_THAT(frozen.out, HasSubstr("5 frames: 1 tracked (1 in part), 4 predicted, 0 lost"));
    EXPECT_EQ(frozen.code, kExitIncomplete);
    EXPECT_THAT(
        frozen.err,
        HasSubstr("most of the motion is predicted, not measured: 1 of 5 frames tracked"));
    EXPECT_EQ(std::count(frozen.err.begin(), frozen.err.end(), '\n'), 1) << frozen.err;
}

/** Two rawlogs in the wrong order: one frame is late, then stamps go on from there. */
TEST_F(OdometryApp, afterAClockSetBackTheProgramSaysWhatTheOdometrySays)
{
    test::writeObservations(dir_ / "early.rawlog", 6);
    {
        RawlogWriter writer(dir_ / "late.rawlog");
        for (int i = 100; i < 106; ++i)
        {
            writer.write(*sampleScan(i));
        }
        writer.close();
    }
    const Outcome outcome = run({dir_ / "late.rawlog", dir_ / "early.rawlog", "-o", out_});
    EXPECT_EQ(outcome.code, kExitIncomplete);
    EXPECT_THAT(outcome.out, HasSubstr("1 lost"));
    EXPECT_THAT(outcome.out, HasSubstr("frame 6 (stamp 1000.000000000): lost: its time stamp"));
    EXPECT_THAT(
        outcome.out,
        HasSubstr("frame 7 (stamp 1000.031250000): predicted: two stamps in a row are not after an "
                  "earlier one: the clock was set back, or frames are out of order"));
    VisualOdometry odometry;
    odometry.setMinLoggingLevel(mrpt::system::LVL_ERROR);
    std::size_t frame = 0;
    const auto contents = test::readAll(out_);
    for (std::size_t i = 0; i + 1 < contents.objects.size(); ++i)
    {
        const auto scan = std::dynamic_pointer_cast<CObservation3DRangeScan>(contents.objects[i]);
        if (!scan)
        {
            continue;
        }
        const RobotMotion motion = odometry.process(*scan);
        const auto pose = std::dynamic_pointer_cast<CObservationRobotPose>(contents.objects[i + 1]);
        ASSERT_TRUE(pose);
        EXPECT_EQ(pose->pose.mean.asString(), motion.pose.mean.asString()) << "frame " << frame;
        EXPECT_EQ(pose->pose.cov, motion.pose.cov) << "frame " << frame;
        ++frame;
    }
    EXPECT_EQ(frame, 12U);
}

TEST_F(OdometryApp, aRunOnAnOutputReplacesWhatIsThere)
{
    ASSERT_EQ(
        runOn(5, [](int i, auto& scan) { scan.hasRangeImage = scan.hasIntensityImage = i != 3; })
            .code,
        1);
    const std::string first = dir_ / "first.rawlog";
    ASSERT_EQ(run({in_, "-o", first, "--since", "2"}).code, kExitIncomplete);
    for (const char* format : {"--format1", "--quiet"})
    {
        const Outcome again = run({first, "-o", out_, "--since", "2", format});
        EXPECT_EQ(again.code, kExitIncomplete) << again.err;
        // Per frame a pose, 0 + 1 + 2 + 2 + 2 motions, one comment.
        EXPECT_THAT(
            again.out, HasSubstr("replaced: 13 records (poses and comments) of an earlier run"));
    }
    EXPECT_EQ(readBytes(out_), readBytes(first));
}

TEST_F(OdometryApp, nominalIntrinsicsAreTold)
{
    for (const bool isNominal : {false, true})
    {
        RawlogWriter writer(in_);
        CObservationComment comment;
        comment.timestamp = sampleScan(0)->timestamp;
        comment.text = cameraComment("RGBD", {}, isNominal);
        writer.write(comment);
        writer.write(*sampleScan(0, 64, 48));
        writer.close();
        const Outcome outcome = run({in_, "-o", out_});
        EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
        EXPECT_EQ(outcome.out.find("nominal intrinsics") != std::string::npos, isNominal);
    }
}

TEST_F(OdometryApp, labelsOfAnyLengthLeaveTheSummaryWhole)
{
    const std::string label = "front camera " + std::string(300, 'x');
    const Outcome outcome =
        runOn(2, [&](int, CObservation3DRangeScan& scan) { scan.sensorLabel = label; });
    EXPECT_THAT(outcome.out, HasSubstr(label + ": 2 frames: "));
    EXPECT_THAT(outcome.out, HasSubstr(" fps\n"));
    EXPECT_THAT(
        runOn(2, [&](int, CObservation3DRangeScan& scan) { scan.sensorLabel = ""; }).out,
        HasSubstr("camera '': 2 frames: "));
}

TEST_F(OdometryApp, whatNoFrameToldIsNotInTheSummary)
{
    EXPECT_THAT(
        runOn(2, [](int, CObservation3DRangeScan&) {}).out,
        HasSubstr("\ndepth noise: assumed (nothing told it), "));
    EXPECT_THAT(
        runOn(
            2,
            [](int, CObservation3DRangeScan& scan)
            { scan.hasRangeImage = scan.hasIntensityImage = false; })
            .out,
        testing::Not(HasSubstr("depth noise")));
}

/** A motion of two frames tells less of the lens than is known before. */
TEST_F(OdometryApp, aLensOfWhichNothingWasLearntIsNotInTheSummary)
{
    test::writeObservations(in_, 2);
    const Outcome outcome =
        run({in_, "--set", "Lens.nominal=true", "--trajectory", dir_ / "poses.txt"});
    EXPECT_THAT(outcome.out, HasSubstr("2 frames: 2 tracked"));
    EXPECT_THAT(outcome.out, testing::Not(HasSubstr("learnt from the motion")));
}

TEST_F(OdometryApp, otherCamerasAreNamed)
{
    const Outcome outcome = runOn(
        6, [](int i, CObservation3DRangeScan& scan) { scan.sensorLabel = i == 4 ? "" : "RGBD"; });
    EXPECT_THAT(outcome.out, HasSubstr("not used: 1 frame of camera ''"));
}

TEST_F(OdometryApp, optionsWithoutEffectAreNamed)
{
    test::writeObservations(in_, 2);
    for (const std::vector<std::string>& args : std::vector<std::vector<std::string>>{
             {"--since", "2"},
             {"--only-poses"},
             {"--format1"},
             {"--with-points"},
             {"--only-poses", "--with-points", "-o", out_},
             {"--keyframe-distance", "1"},
             {"--keyframe-angle", "1"},
             {"--trajectory-frame", "robot"}})
    {
        std::vector<std::string> all{in_};
        all.insert(all.end(), args.begin(), args.end());
        const Outcome outcome = run(all);
        EXPECT_EQ(outcome.code, kExitBadInput) << args[0];
        EXPECT_THAT(outcome.err, HasSubstr(args[0]));
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    }
    EXPECT_THAT(run({in_}).err, HasSubstr("warning: nothing was written"));
}

TEST_F(OdometryApp, untrackedFramesSaySoInTheRawlog)
{
    (void)runOn(
        3,
        [](int i, CObservation3DRangeScan& scan)
        {
            if (i == 1)
            {
                scan.hasRangeImage = scan.hasIntensityImage = false;
            }
        });
    bool found = false;
    for (const auto& object : test::readAll(out_).objects)
    {
        if (const auto comment = std::dynamic_pointer_cast<CObservationComment>(object))
        {
            found = found ||
                    comment->text ==
                        "pointplane-status label=RGBD frame=1 lost: observation has no range image";
        }
    }
    EXPECT_TRUE(found);
}

/** Lost frames have no pose in a text trajectory, only a comment that says so. */
TEST_F(OdometryApp, textTrajectoriesLeaveLostFramesOut)
{
    (void)runOn(
        3,
        [](int i, mrpt::obs::CObservation3DRangeScan& scan)
        { scan.hasRangeImage = scan.hasIntensityImage = i != 1; });
    const std::string path = dir_ / "t.txt";
    ASSERT_EQ(run({in_, "--trajectory", path}).code, kExitIncomplete);
    std::istringstream text(readBytes(path));
    std::vector<std::string> marks, poses;
    for (std::string line; std::getline(text, line);)
    {
        if (line[0] != '#')
        {
            poses.push_back(line);
        }
        else if (line.rfind("# pointplane-status ", 0) == 0)
        {
            marks.push_back(line);
        }
    }
    EXPECT_EQ(poses.size(), 2U);
    ASSERT_EQ(marks.size(), 1U);
    EXPECT_THAT(marks[0], testing::EndsWith(" lost: observation has no range image"));
}

/** A camera of depth alone lacks nothing that its user could give. */
TEST_F(OdometryApp, recordingsWithoutColourAreToldOnce)
{
    const auto withoutColour = [](int from)
    {
        return [from](int i, CObservation3DRangeScan& scan)
        {
            scan.hasIntensityImage = i < from;
            scan.intensityImage = i < from ? scan.intensityImage : mrpt::img::CImage();
        };
    };
    const Outcome none = runOn(5, withoutColour(0));
    EXPECT_THAT(
        none.out, HasSubstr("no tracked frame has a colour image: the motion is from planes"));
    EXPECT_THAT(none.out, Not(HasSubstr("it has no colour image"))) << none.out;
    EXPECT_THAT(none.out, HasSubstr("5 tracked (4 in part), 0 predicted"));
    const Outcome some = runOn(5, withoutColour(3));
    EXPECT_THAT(some.out, Not(HasSubstr("no tracked frame has")));
    EXPECT_THAT(some.out, HasSubstr("  in part, first frame 0 (stamp "));
    EXPECT_THAT(some.out, HasSubstr("5 tracked (5 in part), 0 predicted"));
}

TEST_F(OdometryApp, badInputIsNamedWithExitCode2)
{
    const auto expect = [this](const std::vector<std::string>& args, const std::string& text)
    {
        const Outcome outcome = run(args);
        EXPECT_EQ(outcome.code, kExitBadInput) << text;
        EXPECT_THAT(outcome.err, HasSubstr(text));
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_FALSE(std::filesystem::exists(out_));
    };
    test::writeObservations(in_, 2);
    expect({dir_ / "none.rawlog", "-o", out_}, "none.rawlog: No such file");
    writeBytes(dir_ / "empty.rawlog", "");
    expect({dir_ / "empty.rawlog", "-o", out_}, "empty.rawlog: is empty");
    writeBytes(dir_ / "text.rawlog", "hello");
    expect({dir_ / "text.rawlog", "-o", out_}, "is a text file, not a rawlog");
    expect({dir_ / "", "-o", out_}, "not a rawlog; pointplane-convert folder");
    writeBytes(dir_ / "metadata.yaml", "rosbag2_bagfile_information:\n");
    expect({dir_ / "", "-o", out_}, "not a rawlog; if ROS 2 wrote it, make a ROS 1 bag");
    writeBytes(dir_ / "depth.txt", "");
    expect({dir_ / "", "-o", out_}, "not a rawlog; pointplane-convert tum makes one of it");
    expect(
        {in_, "-o", out_, "--sensor-label", "LEFT"},
        "no frames of camera 'LEFT'; in it are 2 frames of camera 'RGBD'");
    expect(
        {in_, "-o", out_, "--first", "2"},
        "--first 2 skips all of them; in it are 2 frames of camera 'RGBD'");
    writeBytes(dir_ / "b.rawlog", readBytes(in_));
    expect(
        {in_, dir_ / "b.rawlog", "-o", out_, "--sensor-label", "LEFT"},
        in_ + " and 1 more: no frames of camera 'LEFT'; in it are 4 frames of camera 'RGBD'");
    expect({in_, "-o", in_}, "is an input");
    writeBytes(dir_ / "typo.ini", "[DepthNoise]\nsigmaInverseDept = 1\n");
    expect({in_, "-o", out_, "-c", dir_ / "typo.ini"}, "did you mean 'sigmaInverseDepth'?");
    expect({in_, "-o", out_, "-c", dir_ / "none.ini"}, "none.ini: No such file");
    expect({in_, "-o", out_, "--set", "DepthNoise.sigmaInverseDepth=-1"}, "sigmaInverseDepth");
    expect({in_, "-o", out_, "--mask", dir_ / "none.png"}, "none.png: no such file");
    cv::imwrite(dir_ / "white.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(255)));
    expect(
        {in_, "-o", out_, "--mask", dir_ / "white.png"}, "white.png: the mask is white everywhere");
    cv::imwrite(dir_ / "black.png", cv::Mat(48, 64, CV_8UC1, cv::Scalar(0)));
    expect(
        {in_, "-o", out_, "--mask", dir_ / "black.png"}, "black.png: the mask is black everywhere");
    {
        RawlogWriter writer(dir_ / "comments.rawlog");
        writer.write(CObservationComment());
        writer.close();
    }
    expect({dir_ / "comments.rawlog", "-o", out_}, "no CObservation3DRangeScan");
    CObservationComment comment;
    comment.text = "pointplane-camera label=RGBD depthDelay=late";
    {
        RawlogWriter writer(dir_ / "shutter.rawlog");
        writer.write(comment);
        writer.close();
    }
    expect(
        {dir_ / "shutter.rawlog", "-o", out_},
        "shutter.rawlog: comment 'pointplane-camera': 'late' is not a number of seconds");
}

TEST_F(OdometryApp, aCommentThatCannotBeReadEndsTheRunAtItsPlaceOnly)
{
    RawlogWriter writer(in_);
    const auto tell = [&](const std::string& text)
    {
        CObservationComment comment;
        comment.text = "pointplane-camera label=RGBD " + text;
        writer.write(comment);
    };
    tell("temperature=20");
    for (int i = 0; i < 3; ++i)
    {
        writer.write(*sampleScan(i, 64, 48));
    }
    tell("depthDelay=late");
    writer.write(*sampleScan(3, 64, 48));
    writer.close();
    const Outcome outcome = run({in_, "-o", out_});
    EXPECT_EQ(outcome.code, kExitIncomplete);
    EXPECT_EQ(numPoses(out_), 3U);
    EXPECT_THAT(outcome.err, HasSubstr(": 'late' is not a number of seconds (key depthDelay)"));
    EXPECT_THAT(outcome.out, HasSubstr("not used: key 'temperature' of comments about cameras"));
}

TEST_F(OdometryApp, unwritableOutputIsExitCode3)
{
    test::writeObservations(in_, 2);
    for (const char* option : {"-o", "--trajectory", "--diagnostics", "--simplemap", "--graph"})
    {
        const Outcome outcome = run({in_, option, "/nonexistent/x"});
        EXPECT_EQ(outcome.code, kExitEnvironment) << option;
        EXPECT_THAT(
            outcome.err, HasSubstr("cannot write /nonexistent/x: there is no folder /nonexistent"));
    }
    std::filesystem::create_symlink("/dev/full", dir_ / "full.rawlog");
    const Outcome full = run({in_, "-o", dir_ / "full.rawlog"});
    EXPECT_EQ(full.code, kExitEnvironment);
    EXPECT_THAT(full.err, HasSubstr("No space left on device"));
    std::filesystem::create_symlink(dir_ / "other", dir_ / "taken.rawlog.partial");
    const Outcome taken = run({in_, "-o", dir_ / "taken.rawlog"});
    EXPECT_EQ(taken.code, kExitEnvironment);
    EXPECT_THAT(taken.err, HasSubstr("taken.rawlog.partial: something else has this name"));
    EXPECT_FALSE(std::filesystem::exists(dir_ / "other")) << "written through the link";
}

TEST_F(OdometryApp, damagedInputIsDoneUpToTheDamage)
{
    std::mt19937 rng(7);
    RawlogWriterOptions options;
    options.flushEveryObjects = 1;
    test::writeObservations(in_, 6, options);
    const std::string bytes = readBytes(in_);
    for (int i = 0; i < 10; ++i)
    {
        const std::size_t cut = bytes.size() / 2 + rng() % (bytes.size() / 2 - 1);
        writeBytes(dir_ / "cut.rawlog", bytes.substr(0, cut));
        const Outcome outcome = run({dir_ / "cut.rawlog", "-o", out_});
        EXPECT_EQ(outcome.code, kExitIncomplete);
        EXPECT_THAT(outcome.err, HasSubstr("cut.rawlog: truncated at byte " + std::to_string(cut)));
        EXPECT_EQ(numPoses(out_), test::readAll(dir_ / "cut.rawlog").objects.size());
        EXPECT_EQ(test::readAll(out_).ending.kind, RawlogEnd::Clean);
    }
    writeBytes(dir_ / "b.rawlog", bytes);
    EXPECT_THAT(
        run({dir_ / "cut.rawlog", in_, dir_ / "b.rawlog", "-o", out_}).err,
        HasSubstr("; not read: " + in_ + " and 1 more\n"));
}

TEST_F(OdometryApp, severalCamerasAndSeveralFiles)
{
    {
        RawlogWriter writer(in_);
        for (int i = 0; i < 3; ++i)
        {
            for (const char* label : {"LEFT", "RIGHT"})
            {
                const auto scan = sampleScan(i, 64, 48);
                scan->sensorLabel = label;
                writer.write(*scan);
            }
        }
        writer.close();
    }
    EXPECT_THAT(run({in_, "-o", out_}).out, HasSubstr("LEFT: 3 frames"));
    EXPECT_THAT(
        run({in_, "-o", out_, "--sensor-label", "RIGHT"}).out, HasSubstr("RIGHT: 3 frames"));
    // Both cameras' observations are still there.
    EXPECT_GE(test::readAll(out_).objects.size(), 9U);
    test::writeObservations(dir_ / "a.rawlog", 3);
    RawlogWriter writer(dir_ / "b.rawlog");
    writer.write(*sampleScan(3));
    writer.close();
    EXPECT_THAT(
        run({dir_ / "a.rawlog", dir_ / "b.rawlog", "-o", out_}).out, HasSubstr("RGBD: 4 frames"));
}

TEST_F(OdometryApp, firstAndCount)
{
    test::writeObservations(in_, 8);
    const Outcome outcome =
        run({in_, "--first", "2", "--count", "3", "--diagnostics", dir_ / "d.csv"});
    EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("RGBD: 3 frames"));
    EXPECT_THAT(readBytes(dir_ / "d.csv"), HasSubstr("\n2,1000.062500000,first"));
    const Outcome none = run({in_, "--first", "8", "-o", out_});
    EXPECT_EQ(none.code, kExitBadInput);
}

/** A pipe may have nothing more for a long time. */
TEST_F(OdometryApp, nothingIsReadBehindTheFramesWanted)
{
    RawlogWriterOptions options;
    options.flushEveryObjects = 1;
    test::writeObservations(in_, 4, options);
    const std::string bytes = readBytes(in_);
    writeBytes(in_, bytes.substr(0, bytes.size() * 7 / 8));
    const Outcome outcome = run({in_, "--count", "3", "-o", out_});
    EXPECT_EQ(outcome.code, kExitOk) << outcome.err;
    EXPECT_EQ(numPoses(out_), 3U);
}

/** Comments about cameras as `tells` has them, then the scans from `from` on. */
void writeTold(const std::string& path, const std::vector<std::string>& tells, int from, int to)
{
    RawlogWriter writer(path);
    for (const std::string& text : tells)
    {
        CObservationComment comment;
        comment.timestamp = sampleScan(from)->timestamp;
        comment.text = text;
        writer.write(comment);
    }
    for (int i = from; i < to; ++i)
    {
        writer.write(*sampleScan(i, 64, 48));
    }
    writer.close();
}

/** Of a rawlog of either format. */
[[nodiscard]] std::vector<mrpt::obs::CObservation::Ptr> observationsIn(const std::string& path)
{
    std::vector<mrpt::obs::CObservation::Ptr> out;
    for (const auto& object : test::readAll(path).objects)
    {
        if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
        {
            out.insert(out.end(), frame->begin(), frame->end());
        }
        else if (const auto o = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object))
        {
            out.push_back(o);
        }
    }
    return out;
}

TEST_F(OdometryApp, commentsThatHoldAreWrittenThoughTheyStandBeforeTheFirstFrame)
{
    const std::string other = cameraComment("OTHER", {}, true);
    const std::string replaced = cameraComment("RGBD", {0.01, 0.01, 0}, false);
    const std::string holds = cameraComment("RGBD", {0.02, 0.03, 0.004}, true);
    const std::string all = dir_ / "all.rawlog", a = dir_ / "a.rawlog", b = dir_ / "b.rawlog";
    writeTold(all, {other, "of the skipped part", replaced, holds}, 0, 6);
    writeTold(a, {other, replaced, holds}, 0, 3);
    writeTold(b, {}, 3, 6);
    for (const std::vector<std::string>& inputs : {std::vector{all}, std::vector{a, b}})
    {
        for (const char* format : {"--format1", "--profile"})
        {
            std::vector<std::string> args{"--first", "3", "-o", out_, format};
            args.insert(args.begin(), inputs.begin(), inputs.end());
            ASSERT_EQ(run(args).code, kExitOk);
            std::vector<std::string> found;
            for (const auto& observation : observationsIn(out_))
            {
                const auto* comment = dynamic_cast<const CObservationComment*>(observation.get());
                found.push_back(comment != nullptr ? comment->text : observation->sensorLabel);
            }
            ASSERT_GE(found.size(), 3U);
            found.resize(3);
            EXPECT_THAT(found, testing::ElementsAre(other, holds, "RGBD")) << format;
        }
    }
}

TEST_F(OdometryApp, readsFormat1AsFormat2)
{
    test::writeObservations(in_, 5);
    test::writeActionsAndFrames(dir_ / "format1.rawlog", 5);
    ASSERT_EQ(run({in_, "--trajectory", dir_ / "2.txt"}).code, kExitOk);
    ASSERT_EQ(run({dir_ / "format1.rawlog", "--trajectory", dir_ / "1.txt"}).code, kExitOk);
    EXPECT_EQ(readBytes(dir_ / "1.txt"), readBytes(dir_ / "2.txt"));
}

/** Another odometry is not lost without a word. */
TEST_F(OdometryApp, actionsThatAreNotPassedOnAreTold)
{
    test::writeActionsAndFrames(in_, 5);
    const std::string told = "not passed on: 5 objects of class mrpt::obs::CActionCollection\n";
    EXPECT_THAT(run({in_, "-o", out_}).out, HasSubstr(told));
    EXPECT_THAT(run({in_, "-o", out_, "--format1"}).out, HasSubstr(told));
    EXPECT_THAT(run({in_, "-o", out_, "--only-poses"}).out, Not(HasSubstr("not passed on")));
    EXPECT_THAT(run({in_}).out, Not(HasSubstr("not passed on")));
}

TEST_F(OdometryApp, lengthsInMillimetresAreRefused)
{
    test::writeObservations(in_, 2);
    const Outcome outcome =
        run({in_, "--simplemap", dir_ / "map.simplemap", "--keyframe-distance", "200"});
    EXPECT_EQ(outcome.code, kExitBadInput);
    EXPECT_THAT(outcome.err, HasSubstr("--keyframe-distance: '200' is not a number from 0.001"));
}

TEST_F(OdometryApp, format1KeepsOtherSensorsAndComments)
{
    {
        RawlogWriter writer(in_);
        for (int i = 0; i < 3; ++i)
        {
            CObservationComment comment;
            comment.timestamp = sampleScan(i)->timestamp;
            comment.text = "before frame " + std::to_string(i);
            writer.write(comment);
            writer.write(*sampleScan(i));
        }
        CObservationComment comment;
        comment.timestamp = sampleScan(3)->timestamp;
        comment.text = "the end";
        writer.write(comment);
        writer.close();
    }
    ASSERT_EQ(run({in_, "-o", out_, "--format1"}).code, kExitOk);
    std::vector<std::string> texts;
    size_t numFrames = 0, numScans = 0;
    for (const auto& object : test::readAll(out_).objects)
    {
        if (const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object))
        {
            ++numFrames;
            for (const auto& observation : *frame)
            {
                const auto* comment = dynamic_cast<const CObservationComment*>(observation.get());
                texts.push_back(comment ? comment->text : observation->sensorLabel);
                numScans += texts.back() == "RGBD" ? 1 : 0;
            }
        }
    }
    EXPECT_EQ(numFrames, 3U);
    EXPECT_EQ(numScans, 3U);
    EXPECT_THAT(
        texts,
        testing::ElementsAre(
            "before frame 0",
            "RGBD",
            "RGBD_pose",
            "before frame 1",
            "RGBD",
            "RGBD_pose",
            "before frame 2",
            "RGBD",
            "RGBD_pose",
            "the end"));
    EXPECT_EQ(run({out_, "--only-poses", "--format1", "-o", dir_ / "poses.rawlog"}).code, kExitOk);
}

TEST_F(OdometryApp, externalFilesStayReachableFromTheOutput)
{
    std::filesystem::create_directories(dir_ / "in_Images");
    {
        RawlogWriter writer(in_);
        for (int i = 0; i < 3; ++i)
        {
            const auto scan = sampleScan(i);
            const std::string name = std::to_string(i);
            cv::imwrite(dir_ / "in_Images/" + name + ".png", scan->intensityImage.asCvMatRef());
            scan->intensityImage.setExternalStorage(name + ".png");
            moveRangeToFile(*scan, dir_ / "in_Images", name + ".bin");
            writer.write(*scan);
        }
        writer.close();
    }
    std::filesystem::create_directories(dir_ / "elsewhere");
    const std::string moved = dir_ / "elsewhere/out.rawlog";
    ASSERT_EQ(run({in_, "-o", moved, "--trajectory", dir_ / "a.txt"}).code, kExitOk);
    ASSERT_EQ(run({moved, "--trajectory", dir_ / "b.txt"}).code, kExitOk);
    EXPECT_EQ(readBytes(dir_ / "a.txt"), readBytes(dir_ / "b.txt"));
    // One removed, one replaced by garbage: named, and the rest is done.
    std::filesystem::remove(dir_ / "in_Images/1.bin");
    writeBytes(dir_ / "in_Images/2.png", "garbage");
    const Outcome outcome = run({in_, "-o", out_});
    EXPECT_EQ(outcome.code, kExitIncomplete);
    EXPECT_THAT(outcome.err, HasSubstr("in_Images/1.bin: No such file"));
    EXPECT_THAT(outcome.out, HasSubstr("in_Images/2.png: is not an image, or damaged"));
    EXPECT_EQ(numPoses(out_), 3U);
}

TEST_F(OdometryApp, picturesOfEveryFrame)
{
    test::writeObservations(in_, 2);
    ASSERT_EQ(run({in_, "--overlay", dir_ / "pictures"}).code, kExitOk);
    const cv::Mat picture = cv::imread(dir_ / "pictures/000001.jpg");
    EXPECT_EQ(picture.cols, 32);
    EXPECT_GT(picture.rows, 24) << "no legend";
    ASSERT_EQ(run({in_, "--overlay", dir_ / "few", "--overlay-every", "2"}).code, kExitOk);
    EXPECT_TRUE(std::filesystem::exists(dir_ / "few/000000.jpg"));
    EXPECT_FALSE(std::filesystem::exists(dir_ / "few/000001.jpg"));
}

/** A video has one size. */
TEST_F(OdometryApp, picturesOfLostFramesAreAsLargeAsOthers)
{
    RawlogWriter writer(in_);
    for (int i = 0; i < 4; ++i)
    {
        const auto scan = sampleScan(i, 64, 48);
        scan->timestamp = i == 0 ? INVALID_TIMESTAMP : scan->timestamp;
        scan->hasRangeImage = scan->hasIntensityImage = i != 2;
        writer.write(*scan);
    }
    writer.close();
    const Outcome outcome = run({in_, "--overlay", dir_ / "pictures"});
    EXPECT_THAT(outcome.out, HasSubstr("  frame 0: lost: has no time stamp"));
    const cv::Size size = cv::imread(dir_ / "pictures/000001.jpg").size();
    EXPECT_EQ(size.width, 64);
    EXPECT_EQ(cv::imread(dir_ / "pictures/000000.jpg").size(), size);
    EXPECT_EQ(cv::imread(dir_ / "pictures/000002.jpg").size(), size);
}

/** Velocities come from stamps. A rawlog need not be one that pointplane-convert has checked. */
TEST_F(OdometryApp, stampsThatJitterAreTold)
{
    for (const bool jitter : {false, true})
    {
        RawlogWriter writer(in_);
        for (int i = 0; i < 20; ++i)
        {
            const auto scan = sampleScan(i);
            const double shift = jitter ? 0.01 * std::sin(7.0 * i) : 0;
            scan->timestamp += std::chrono::duration_cast<mrpt::Clock::duration>(
                std::chrono::duration<double>(shift));
            writer.write(*scan);
        }
        writer.close();
        const Outcome outcome = run({in_, "--trajectory", dir_ / (jitter ? "b.txt" : "a.txt")});
        EXPECT_EQ(outcome.out.find("stamps: they jitter by ") != std::string::npos, jitter)
            << outcome.out;
    }
}

/** Frames are lost by them, but the stamps of lost frames count. */
TEST_F(OdometryApp, stampsThatRepeatOrGoBackAreTold)
{
    const auto outOf = [this](const std::vector<double>& stamps)
    {
        RawlogWriter writer(in_);
        for (std::size_t i = 0; i < stamps.size(); ++i)
        {
            const auto scan = sampleScan(static_cast<int>(i));
            scan->timestamp = mrpt::Clock::fromDouble(1000 + stamps[i]);
            writer.write(*scan);
        }
        writer.close();
        return run({in_, "--trajectory", dir_ / "a.txt"}).out;
    };
    EXPECT_THAT(
        outOf({0, 0.1, 0.1, 0.2, 0.2, 0.3}),
        HasSubstr("\nstamps: 2 of them repeat the one before: odometry cannot use such frames"));
    // Two late ones; the next has the stamp of the frame before them.
    EXPECT_THAT(
        outOf({0, 0.1, 0.2, 0.18, 0.16, 0.2, 0.3}),
        HasSubstr("\nstamps: 2 of them are before the one before\n"));
}

TEST_F(OdometryApp, aRawlogGivenTwiceIsRefused)
{
    test::writeObservations(in_, 2);
    std::filesystem::create_symlink(in_, dir_ / "link.rawlog");
    for (const std::string& again : {in_, std::string(dir_ / "link.rawlog")})
    {
        const Outcome outcome = run({in_, again, "-o", out_});
        EXPECT_EQ(outcome.code, kExitBadInput);
        EXPECT_EQ(outcome.err, "pointplane-odometry: " + again + ": is given more than once\n");
    }
    EXPECT_FALSE(std::filesystem::exists(out_));
}

TEST_F(OdometryApp, oneOfAKindIsNotToldAsMany)
{
    test::writeObservations(in_, 1);
    const std::vector<std::string> args{
        in_,
        "-o",
        out_,
        "--overlay",
        dir_ / "pictures",
        "--simplemap",
        dir_ / "map.simplemap",
        "--graph",
        dir_ / "path.graph"};
    const std::string first = run(args).out;
    EXPECT_THAT(first, HasSubstr("pictures: 1 picture\n"));
    EXPECT_THAT(first, HasSubstr("map.simplemap: 1 key frame, CSimpleMap\n"));
    EXPECT_THAT(first, HasSubstr("path.graph: pose graph of 1 node\n"));
}

/** They stay, as they may be wanted, and are not taken for pictures of this run. */
TEST_F(OdometryApp, picturesOfAnEarlierRunAreTold)
{
    test::writeObservations(in_, 5);
    const std::string folder = dir_ / "pictures";
    const Outcome first = run({in_, "--overlay", folder});
    EXPECT_THAT(first.out, HasSubstr("pictures: 5 pictures\n"));
    for (const char* name : {"photo.jpg", "000009.png", "12.jpg", "-00009.jpg"})
    {
        writeBytes(folder + "/" + name, "of somebody else");
    }
    EXPECT_EQ(run({in_, "--overlay", folder}).out.find("earlier"), std::string::npos);
    const Outcome shorter = run({in_, "--overlay", folder, "--count", "2"});
    EXPECT_EQ(shorter.code, kExitOk);
    EXPECT_THAT(
        shorter.out, HasSubstr("pictures: 2 pictures, and 3 of an earlier run, e.g. 000002.jpg\n"));
    EXPECT_TRUE(std::filesystem::exists(folder + "/000004.jpg"));
}

TEST_F(OdometryApp, dumpedConfigurationIsItsOwnInput)
{
    const Outcome dumped = run({"--dump-config", "--set", "DepthNoise.sigmaPixelPx=0.7"});
    ASSERT_EQ(dumped.code, kExitOk);
    EXPECT_THAT(dumped.out, HasSubstr("sigmaPixelPx = 0.7"));
    writeBytes(dir_ / "a.ini", dumped.out);
    EXPECT_EQ(run({"--dump-config", "-c", dir_ / "a.ini"}).out, dumped.out);
}

TEST_F(OdometryApp, helpAndVersion)
{
    EXPECT_EQ(run({"--help"}).code, kExitOk);
    EXPECT_EQ(run({"--version"}).code, kExitOk);
    EXPECT_EQ(run({"--nonsense"}).code, kExitBadInput);
    EXPECT_EQ(run({}).code, kExitBadInput);
}
}  // namespace
}  // namespace pointplane
