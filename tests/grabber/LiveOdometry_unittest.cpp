// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/LiveOdometry.h>
#include <pointplane/grabber/RecordingWriter.h>
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/image_file.h>

#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <opencv2/imgproc.hpp>

#include <filesystem>
#include <memory>
#include <new>
#include <ostream>
#include <sstream>
#include <streambuf>
#include <string>
#include <vector>

#include "RenderedMotion.h"
#include "TempDir.h"
#include <gtest/gtest.h>

namespace
{
using namespace pointplane;

constexpr int kWidth = 64, kHeight = 48;

/** Takes so many lines; then there is no more memory. */
class ShortMemory : public std::streambuf
{
 public:
    explicit ShortMemory(int lines) : left_(lines) {}

 private:
    int_type overflow(int_type c) override
    {
        if (c == '\n' && --left_ < 0)
        {
            throw std::bad_alloc();
        }
        return c;
    }
    int left_;
};

ImagePair grey(double stamp)
{
    ImagePair pair;
    pair.stamp = stamp;
    pair.depth.pixels = cv::Mat(kHeight, kWidth, CV_16UC1, cv::Scalar(1500));
    pair.colour.stream = StreamKind::Colour;
    pair.colour.layout = PixelLayout::Rgb8;
    pair.colour.pixels = cv::Mat(kHeight, kWidth, CV_8UC3, cv::Scalar::all(90));
    return pair;
}

RgbdCalibration calibration()
{
    CameraFacts facts;
    facts.mode = {kWidth, kHeight, 30, ""};
    facts.registered = true;
    facts.colourFocal_px = 52.5;
    return nominalCalibration(facts);
}

TEST(LiveOdometry, anErrorEndsItAndNothingElse)
{
    const ObservationBuilder builder(calibration());
    ShortMemory memory(3);  // the header and two frames
    std::ostream out(&memory);
    out.exceptions(std::ios::badbit);

    const test::TempDir dir;
    LiveOptions options;
    options.waits = true;
    options.poseRawlog = dir / "poses.rawlog";
    LiveOdometry live(options, builder, out);
    for (int k = 0; k < 6; ++k)
    {
        live.add(grey(1 + k / 30.0));  // does not wait for who has given up
    }
    live.finish();

    EXPECT_EQ(live.stats().problem, "out of memory; --live ends there, the rest went on");
    EXPECT_EQ(live.stats().processed, 2U);
    EXPECT_FALSE(std::filesystem::exists(options.poseRawlog));
    EXPECT_TRUE(std::filesystem::exists(options.poseRawlog + ".partial"));
}

/** As in the rawlog of pointplane-odometry: else a prediction counts as measured. */
TEST(LiveOdometry, framesThatWereNotTrackedAreMarkedInTheRawlog)
{
    const test::TempDir dir;
    const ObservationBuilder builder(calibration());
    std::ostringstream out;
    LiveOptions options;
    options.waits = true;
    options.poseRawlog = dir / "poses.rawlog";
    LiveOdometry live(options, builder, out);
    for (int k = 0; k < 2; ++k)  // the same image twice
    {
        live.add(grey(1 + k / 30.0));
    }
    live.finish();
    std::vector<std::string> comments;
    RawlogReader reader(options.poseRawlog);
    while (const auto object = reader.next())
    {
        const auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(object);
        if (comment)
        {
            comments.push_back(comment->text);
        }
    }
    ASSERT_EQ(comments.size(), 1U);
    EXPECT_EQ(comments[0].rfind("pointplane-status label=OPENNI2 frame=1 predicted: ", 0), 0U);
}

/** Else a coverage of the recording would be that of the other frames. */
TEST(LiveOdometry, theRawlogTellsThatFramesWereSkipped)
{
    const test::TempDir dir;
    const ObservationBuilder builder(calibration());
    for (const bool waits : {true, false})
    {
        std::ostringstream out;
        LiveOptions options;
        options.waits = waits;
        options.poseRawlog = dir / "poses.rawlog";
        LiveOdometry live(options, builder, out);
        for (int k = 0; k < 20; ++k)
        {
            live.add(grey(1 + k / 30.0));
        }
        live.finish();
        ASSERT_EQ(live.stats().skipped == 0, waits);
        int told = 0;
        RawlogReader reader(options.poseRawlog);
        while (const auto object = reader.next())
        {
            const auto comment = std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(object);
            told += comment && comment->text == "pointplane-skipped label=OPENNI2" ? 1 : 0;
        }
        EXPECT_EQ(told, waits ? 0 : 1);
    }
}

TEST(LiveOdometry, aMaskOfAnotherSizeIsRefusedBeforeTheFirstFrame)
{
    const test::TempDir dir;
    const ObservationBuilder builder(calibration());
    std::ostringstream out;
    LiveOptions options;
    options.mask = dir / "mask.png";
    options.poseRawlog = dir / "poses.rawlog";
    cv::Mat mask(kHeight, kWidth, CV_8UC1, cv::Scalar(255));
    mask.row(0).setTo(0);
    writeImageFile(options.mask, mask);
    EXPECT_NO_THROW(LiveOdometry(options, builder, out));
    writeImageFile(options.mask, mask.colRange(0, 10));
    std::string problem;
    try
    {
        const LiveOdometry live(options, builder, out);
    }
    catch (const InputError& e)
    {
        problem = e.what();
    }
    EXPECT_EQ(
        problem,
        options.mask +
            ": is 10x48, but images of camera 'OPENNI2' are 64x48; draw it in that size");
}

/** A pair of a simulated motion, with depth some time after colour. */
ImagePair rendered(const test::PlainFrame& frame, double stamp, double delay)
{
    ImagePair pair;
    pair.stamp = stamp;
    pair.depth.pixels = frame.depth;
    pair.depth.deviceTime = stamp + delay;
    pair.colour.stream = StreamKind::Colour;
    pair.colour.layout = PixelLayout::Rgb8;
    pair.colour.deviceTime = stamp;
    cv::cvtColor(frame.colour, pair.colour.pixels, cv::COLOR_BGR2RGB);
    return pair;
}

/** Poses of the odometry over a recording, as pointplane-odometry reads it. */
std::vector<mrpt::poses::CPose3DPDFGaussian> replayed(const std::string& path)
{
    std::vector<mrpt::poses::CPose3DPDFGaussian> out;
    VisualOdometry odometry;
    RawlogReader reader(path);
    while (const auto object = reader.next())
    {
        if (const auto* comment = dynamic_cast<const mrpt::obs::CObservationComment*>(object.get()))
        {
            odometry.converter().readComment(*comment);
        }
        if (const auto* scan =
                dynamic_cast<const mrpt::obs::CObservation3DRangeScan*>(object.get()))
        {
            out.push_back(odometry.process(*scan).pose);
        }
    }
    return out;
}

/** Both know of the same camera: that its intrinsics are nominal, and when depth comes late. */
TEST(LiveOdometry, liveAndReplayAgree)
{
    const test::TempDir dir;
    constexpr int kFrames = 6, kColumns = 320, kLines = 240;
    const test::RenderedMotion motion(kFrames, kColumns, kLines);
    CameraFacts facts;
    facts.mode = {kColumns, kLines, 30, ""};
    facts.registered = true;
    facts.colourFocal_px = test::RenderedMotion::kFocal_px * kColumns / 640;
    const ObservationBuilder builder(nominalCalibration(facts));
    RecordingOptions recording;
    recording.path = dir / "recording.rawlog";
    recording.tellDelay = true;
    LiveOptions options;
    options.waits = true;
    options.knowsDelay = true;
    options.poseRawlog = dir / "poses.rawlog";
    std::ostringstream out;
    RecordingWriter writer(recording, builder);
    LiveOdometry live(options, builder, out);
    for (int k = 0; k < kFrames; ++k)
    {
        const double delay = k < 3 ? 0.01 : -0.01;
        const ImagePair pair =
            rendered(motion.frames()[static_cast<std::size_t>(k)], 1.7e9 + k / 30.0, delay);
        ASSERT_TRUE(writer.push(pair));
        live.add(pair);
    }
    writer.finish();
    live.finish();

    const auto expected = replayed(recording.path);
    std::size_t k = 0;
    RawlogReader reader(options.poseRawlog);
    while (const auto object = reader.next())
    {
        if (const auto* pose = dynamic_cast<const mrpt::obs::CObservationRobotPose*>(object.get()))
        {
            ASSERT_LT(k, expected.size());
            EXPECT_EQ(pose->pose.mean, expected[k].mean) << "frame " << k;
            EXPECT_EQ(pose->pose.cov, expected[k].cov) << "frame " << k;
            ++k;
        }
    }
    EXPECT_EQ(k, static_cast<std::size_t>(kFrames));
}
}  // namespace
