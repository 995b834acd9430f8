// SPDX-License-Identifier: BSD-3-Clause
#include "OpenNi2Camera.h"

#include <opencv2/core.hpp>

#include <array>
#include <cstdint>
#include <thread>

#include "OpenNi2Events.h"
#include "drivers.h"
#include "oni_file.h"
#include "openni2_formats.h"

namespace pointplane
{
namespace
{
constexpr double kMicrosecond = 1e-6;
}  // namespace

void OpenNi2Camera::start()
{
    for (auto* stream : {&depth_, &colour_})
    {
        if (stream->isValid() && stream->start() != openni::STATUS_OK)
        {
            throw EnvironmentError(
                "camera " + facts_.device.uri + " does not start its " +
                (stream == &depth_ ? "depth" : "colour") + " stream: " + openNi2Error());
        }
    }
    streaming_ = true;
}

std::optional<std::size_t> OpenNi2Camera::waitForStream(int timeout_ms)
{
    std::array<openni::VideoStream*, 2> streams{&depth_, &colour_};
    int ready = 0;
    const auto status =
        openni::OpenNI::waitForAnyStream(streams.data(), numStreams(), &ready, timeout_ms);
    return status == openni::STATUS_OK ? std::optional<std::size_t>(ready) : std::nullopt;
}

Delivery OpenNi2Camera::wait(CameraImage& image, std::chrono::milliseconds timeout)
{
    // Once the device is gone only what is already here can come.
    const bool over = events_->disconnected || events_->atEnd;
    const auto ready = waitForStream(over ? 100 : static_cast<int>(timeout.count()));
    if (!ready)
    {
        if (over)
        {
            return events_->disconnected ? Delivery::Disconnected : Delivery::EndOfFile;
        }
        return Delivery::Timeout;
    }
    openni::VideoFrameRef frame;
    if ((*ready == 0 ? depth_ : colour_).readFrame(&frame) != openni::STATUS_OK || !frame.isValid())
    {
        return Delivery::Timeout;
    }
    image = copy(frame, *ready == 0 ? StreamKind::Depth : StreamKind::Colour);
    return Delivery::Image;
}

CameraImage OpenNi2Camera::copy(const openni::VideoFrameRef& frame, StreamKind stream) const
{
    CameraImage image;
    image.arrival = hostTime();
    image.stream = stream;
    image.index = frame.getFrameIndex();
    image.deviceTime = static_cast<double>(frame.getTimestamp()) * kMicrosecond;
    const auto format = frame.getVideoMode().getPixelFormat();
    image.depthUnit = format == openni::PIXEL_FORMAT_DEPTH_100_UM ? 1e-4 : 1e-3;
    const auto layout = layoutOf(format);
    image.layout = layout.layout;
    const int rowBytes = frame.getWidth() * static_cast<int>(CV_ELEM_SIZE(layout.cvType));
    const std::int64_t bytes = std::int64_t{frame.getStrideInBytes()} * frame.getHeight();
    if (frame.getStrideInBytes() < rowBytes || frame.getDataSize() < bytes)
    {
        throw EnvironmentError(
            "camera " + facts_.device.uri + " sent " + std::to_string(frame.getDataSize()) +
            " bytes for an image of " + toString(videoModeOf(frame.getVideoMode())));
    }
    const cv::Mat borrowed(
        frame.getHeight(),
        frame.getWidth(),
        layout.cvType,
        const_cast<void*>(frame.getData()),  // NOLINT: cv::Mat has no const view; only read
        static_cast<std::size_t>(frame.getStrideInBytes()));
    // Devices do not mirror: setUpDevice() has seen to it.
    const auto& source = stream == StreamKind::Depth ? depth_ : colour_;
    if (facts_.isFile && source.getMirroringEnabled())
    {
        cv::flip(borrowed, image.pixels, 1);
    }
    else
    {
        image.pixels = borrowed.clone();
    }
    return image;
}

bool OpenNi2Camera::lockExposure()
{
    auto* settings = colour_.isValid() ? colour_.getCameraSettings() : nullptr;
    return settings != nullptr && settings->setAutoExposureEnabled(false) == openni::STATUS_OK;
}

bool OpenNi2Camera::lockWhiteBalance()
{
    auto* settings = colour_.isValid() ? colour_.getCameraSettings() : nullptr;
    return settings != nullptr && settings->setAutoWhiteBalanceEnabled(false) == openni::STATUS_OK;
}

void OpenNi2Camera::recordTo(const std::string& oniPath)
{
    oniPath_ = oniPath;
    bool good = recorder_.create(oniPath.c_str()) == openni::STATUS_OK &&
                recorder_.attach(depth_) == openni::STATUS_OK;
    good = good && (!facts_.hasColour || recorder_.attach(colour_) == openni::STATUS_OK);
    if (!good)
    {
        throw EnvironmentError("cannot record to '" + oniPath + "': " + openNi2Error());
    }
}

bool OpenNi2Camera::startRecording()
{
    using Clock = std::chrono::steady_clock;
    constexpr int kMostStarts = 30;
    constexpr std::chrono::milliseconds kPause{100};  // longer than a frame takes
    const bool isBusy = ++numStarts_ > kMostStarts;
    if (isBusy || recorder_.start() != openni::STATUS_OK)
    {
        throw EnvironmentError(
            "cannot record to '" + oniPath_ + "': " +
            (isBusy ? "the computer is too busy to begin with both images of a frame"
                    : openNi2Error()));
    }
    // The recorder begins in a thread of its own, or never if the disk is full, which is found at
    // the end.
    const auto deadline = Clock::now() + std::chrono::seconds(3);
    bool hasBegun = false;
    while (!(hasBegun = oniFileHasBegun(oniPath_, numStreams())) && Clock::now() < deadline)
    {
        std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    if (!hasBegun || !streaming_ || !waitForStream(openni::TIMEOUT_NONE))
    {
        return true;
    }
    recorder_.stop();
    // While it still takes a frame, destroy() would never return.
    std::this_thread::sleep_for(kPause);
    recorder_.destroy();
    recordTo(oniPath_);
    return false;
}

void OpenNi2Camera::stop()
{
    if (recorder_.isValid())
    {
        recorder_.stop();
    }
    if (streaming_)
    {
        streaming_ = false;
        depth_.stop();
        colour_.stop();
        // Some drivers do not join their threads: destroying a stream at once makes them crash.
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    recorder_.destroy();  // while it still takes a frame, this would never return
}
}  // namespace pointplane
