// SPDX-License-Identifier: BSD-3-Clause
// The real program with fakenect, libfreenect's own player of recorded sessions, in its place.
#include "FakenectSession.h"
#include "RenderedMotion.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace
{
using namespace pointplane;
using namespace pointplane::test;
using ::testing::HasSubstr;

// Depth and colour cameras alike and in one place, as the frames were rendered.
const std::string kCalibration = R"(
[KINECT_LEFT]
resolution = [640 480]
fx = 525
fy = 525
cx = 319.5
cy = 239.5
dist = [0 0 0 0 0]
[KINECT_RIGHT]
resolution = [640 480]
fx = 525
fy = 525
cx = 319.5
cy = 239.5
dist = [0 0 0 0 0]
[KINECT_LEFT2RIGHT_POSE]
pose_quaternion = [0 0 0 1 0 0 0]
)";

class FreenectRecording : public ::testing::Test
{
 protected:
    int record(const FakenectSession& session, const std::vector<std::string>& more)
    {
        writeBytes(dir_ / "kinect.ini", kCalibration);
        std::vector<std::string> args{
            "--driver",
            "freenect",
            "-o",
            out_,
            "--warm-up",
            "0.2",
            "--calibration",
            dir_ / "kinect.ini",
            "--section",
            "KINECT"};
        args.insert(args.end(), more.begin(), more.end());
        ChildProcess process(GRABBER, args, session.environment());
        const int code = process.wait();
        err_ = process.err();
        return code;
    }

    TempDir dir_;
    std::string out_{dir_ / "out.rawlog"};
    std::string err_;
};

TEST_F(FreenectRecording, keepsPixelsAndTheKinectsClockAcrossItsOverflow)
{
    const auto frames = patternFrames(30, 640, 480);
    // The 32-bit counter overflows at frame 15.
    const FakenectSession session(frames, 0U - 15U * FakenectSession::kPeriodTicks);
    ASSERT_EQ(record(session, {"--frames", "18"}), 0) << err_;
    const auto scans = scansOf(out_);
    ASSERT_EQ(scans.size(), 18U);
    const auto first =
        static_cast<std::size_t>(scans.front()->intensityImage.asCvMatRef().at<cv::Vec3b>(0, 0)[2]);
    EXPECT_LT(first, 12U) << "the overflow must be in what is recorded";
    for (std::size_t k = 0; k < scans.size(); ++k)
    {
        const auto& expected = frames.at(first + k);
        EXPECT_TRUE(samePixels(scans[k]->intensityImage.asCvMatRef(), expected.colour));
        const cv::Mat depth = depthOf(*scans[k]);
        for (const int x : {0, 1, 100, 639})
        {
            const auto truth = expected.depth.at<std::uint16_t>(100, x);
            const double coded =
                truth == 0 ? 0.0 : FakenectSession::depth_mm(FakenectSession::disparity(truth));
            EXPECT_NEAR(depth.at<std::uint16_t>(100, x), coded, 0.51);
        }
        if (k > 0)
        {
            const double step = mrpt::Clock::toDouble(scans[k]->timestamp) -
                                mrpt::Clock::toDouble(scans[k - 1]->timestamp);
            EXPECT_NEAR(step, 1.0 / 30.0, 1e-5);
        }
    }
    EXPECT_THAT(err_, HasSubstr("colour +5.0 ms after depth on average"));
    EXPECT_THAT(err_, HasSubstr("lost: 0 depth and 0 colour images by the camera"));
    EXPECT_THAT(err_, HasSubstr("Kinect for Xbox 360"));
    EXPECT_THAT(err_, HasSubstr("sections [KINECT_LEFT]"));
}

TEST_F(FreenectRecording, aLostFrameShowsInTheStampsAndIsReported)
{
    const FakenectSession session(patternFrames(30, 640, 480), 1000U, 15);
    ASSERT_EQ(record(session, {"--frames", "18"}), 0) << err_;
    EXPECT_THAT(err_, HasSubstr("lost: 1 depth and 0 colour images by the camera"));
    EXPECT_THAT(err_, HasSubstr("0 depth and 1 colour image without a partner"));
}

TEST_F(FreenectRecording, listsTheKinect)
{
    const FakenectSession session(patternFrames(1, 640, 480), 0U);
    ChildProcess process(GRABBER, {"--list", "--driver", "freenect"}, session.environment());
    EXPECT_EQ(process.wait(), 0);
    EXPECT_THAT(process.out(), HasSubstr("freenect://0  Microsoft Kinect for Xbox 360"));
}

TEST_F(FreenectRecording, noOtherKinectIsTakenForOneThatIsNotThere)
{
    const FakenectSession session(patternFrames(1, 640, 480), 0U);
    for (const char* device : {"freenect://abc", "freenect://", "freenect://-1", "freenect://0x"})
    {
        EXPECT_EQ(record(session, {"--device", device}), 3);
        EXPECT_THAT(err_, HasSubstr(std::string("no camera '") + device + "'"));
    }
}

TEST_F(FreenectRecording, writesNoOniFiles)
{
    const FakenectSession session(patternFrames(2, 640, 480), 0U);
    ChildProcess process(
        GRABBER, {"--driver", "freenect", "-o", dir_ / "out.oni"}, session.environment());
    EXPECT_EQ(process.wait(), 3);
    EXPECT_THAT(process.err(), HasSubstr("only the driver openni2 writes .oni files"));
    EXPECT_FALSE(std::filesystem::exists(dir_ / "out.oni"));
}

TEST_F(FreenectRecording, odometryOnTheRecordingFindsTheTrueMotion)
{
    const RenderedMotion motion(60);
    const FakenectSession session(motion.frames(), 12345U);
    ASSERT_EQ(record(session, {"--frames", "40"}), 0) << err_;
    const auto scans = scansOf(out_);
    ASSERT_EQ(scans.size(), 40U);
    motion.expectOdometryFinds(scans, 0.02);
}
}  // namespace
