// SPDX-License-Identifier: BSD-3-Clause
#include "OpenNi2Camera.h"

#include <array>
#include <cstdint>
#include <thread>

#include "OpenNi2Events.h"
#include "drivers.h"
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

Delivery OpenNi2Camera::wait(CameraImage& image, std::chrono::milliseconds timeout)
{
    std::array<openni::VideoStream*, 2> streams{&depth_, &colour_};
    const int numStreams = facts_.hasColour ? 2 : 1;
    // Once the device is gone only what is already here can come.
    const bool over = events_->disconnected || events_->atEnd;
    const int limit = over ? 100 : static_cast<int>(timeout.count());
    int ready = 0;
    const auto status = openni::OpenNI::waitForAnyStream(streams.data(), numStreams, &ready, limit);
    if (status != openni::STATUS_OK)
    {
        if (over)
        {
            return events_->disconnected ? Delivery::Disconnected : Delivery::EndOfFile;
        }
        return Delivery::Timeout;
    }
    openni::VideoFrameRef frame;
    if (streams.at(static_cast<std::size_t>(ready))->readFrame(&frame) != openni::STATUS_OK ||
        !frame.isValid())
    {
        return Delivery::Timeout;
    }
    image = copy(frame, ready == 0 ? StreamKind::Depth : StreamKind::Colour);
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
    image.pixels = borrowed.clone();
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
    bool good = recorder_.create(oniPath.c_str()) == openni::STATUS_OK &&
                recorder_.attach(depth_) == openni::STATUS_OK;
    good = good && (!facts_.hasColour || recorder_.attach(colour_) == openni::STATUS_OK);
    if (!good || recorder_.start() != openni::STATUS_OK)
    {
        throw EnvironmentError("cannot record to '" + oniPath + "': " + openNi2Error());
    }
}

void OpenNi2Camera::stop()
{
    if (!streaming_)
    {
        return;
    }
    streaming_ = false;
    if (recorder_.isValid())
    {
        recorder_.stop();
        recorder_.destroy();
    }
    depth_.stop();
    colour_.stop();
    // Some drivers do not join their threads: destroying a stream at once makes them crash.
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
}
}  // namespace pointplane
