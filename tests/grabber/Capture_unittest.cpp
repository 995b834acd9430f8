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

TEST(Capture, aStreamThatEndsIsNamedThoughTheOtherGoesOn)
{
    QuickCamera camera(5);
    Capture capture(camera, options(), [](const ImagePair&) { return true; });
    const std::atomic<bool> stop{false};
    EXPECT_EQ(capture.run(stop), CaptureEnd::Stalled);
    EXPECT_THAT(capture.problem(), testing::HasSubstr("sends no colour images"));
}
}  // namespace
