// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/Capture.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "drivers.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace
{
using namespace pointplane;

/** Sends images at once, of both streams or, from an image on, of depth alone. */
class QuickCamera : public Camera
{
 public:
    explicit QuickCamera(int lastColour = 1 << 20) : lastColour_(lastColour)
    {
        facts_.mode = {4, 3, 30, ""};
    }

    [[nodiscard]] const CameraFacts& facts() const override { return facts_; }
    void start() override {}
    [[nodiscard]] Delivery wait(CameraImage& image, std::chrono::milliseconds) override
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        const int number = numImages_++;
        const bool isDepth = number % 2 == 0 || number > lastColour_;
        image.stream = isDepth ? StreamKind::Depth : StreamKind::Colour;
        image.pixels = cv::Mat(3, 4, isDepth ? CV_16UC1 : CV_8UC3, cv::Scalar(0));
        image.index = number > lastColour_ ? number : number / 2;
        image.deviceTime = static_cast<double>(image.index) / 30;
        image.arrival = hostTime();
        return Delivery::Image;
    }
    bool lockExposure() override { return false; }
    bool lockWhiteBalance() override { return false; }
    void recordTo(const std::string&) override {}
    void stop() override {}

 private:
    CameraFacts facts_;
    int lastColour_, numImages_{0};
};

CaptureOptions options()
{
    CaptureOptions out;
    out.warmUp = 0;
    out.stallTimeout = 0.2;
    out.maxFrames = 5;
    return out;
}

/** A slow disk, or a program that was stopped for a while. */
TEST(Capture, theCameraIsNotBlamedForASlowConsumer)
{
    QuickCamera camera;
    int numPairs = 0;
    Capture capture(
        camera,
        options(),
        [&](const ImagePair&)
        {
            ++numPairs;
            std::this_thread::sleep_for(std::chrono::milliseconds(400));
            return true;
        });
    const std::atomic<bool> stop{false};
    EXPECT_EQ(capture.run(stop), CaptureEnd::Stopped);
    EXPECT_EQ(capture.problem(), "");
    EXPECT_EQ(numPairs, 5);
}

/** Its .oni file begins late. */
class SlowRecorder : public QuickCamera
{
 public:
    [[nodiscard]] bool startRecording() override { return ++numStarts == 3; }
    int numStarts{0};
};

TEST(Capture, framesCountFromWhereTheOniFileBegins)
{
    SlowRecorder camera;
    auto o = options();
    o.oniPath = "/nowhere/out.oni";
    o.warmUp = 0.01;
    std::vector<std::int64_t> indices;
    Capture capture(
        camera,
        o,
        [&](const ImagePair& pair)
        {
            EXPECT_EQ(camera.numStarts, 3);
            EXPECT_EQ(pair.depth.index, pair.colour.index);
            indices.push_back(pair.depth.index);
            return true;
        });
    const std::atomic<bool> stop{false};
    EXPECT_EQ(capture.run(stop), CaptureEnd::Error);  // for there is no file
    EXPECT_EQ(indices.size(), 5U);
    EXPECT_EQ(capture.stats().pairing.pairs, 5U);
    EXPECT_EQ(capture.stats().pairing.unpairedDepth, 0U);
}

TEST(Capture, framesThatNoOniFileHasDoNotCount)
{
    class NoRecorder : public QuickCamera
    {
     public:
        [[nodiscard]] bool startRecording() override { throw EnvironmentError("too busy"); }
    } camera;
    auto o = options();
    o.oniPath = "/nowhere/out.oni";
    Capture capture(camera, o, [](const ImagePair&) { return true; });
    const std::atomic<bool> stop{false};
    EXPECT_EQ(capture.run(stop), CaptureEnd::Error);
    EXPECT_EQ(capture.stats().pairing.pairs, 0U);
}

TEST(Capture, aStreamThatEndsIsNamedThoughTheOtherGoesOn)
{
    QuickCamera camera(5);
    Capture capture(camera, options(), [](const ImagePair&) { return true; });
    const std::atomic<bool> stop{false};
    EXPECT_EQ(capture.run(stop), CaptureEnd::Stalled);
    EXPECT_THAT(capture.problem(), testing::HasSubstr("sends no colour images"));
}
}  // namespace
