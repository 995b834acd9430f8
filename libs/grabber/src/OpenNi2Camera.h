// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/Camera.h>

#include <atomic>
#include <optional>
#include <string>

#include <OpenNI.h>

namespace pointplane
{
/** A device or an .oni file through OpenNI2's C++ interface.
 *
 * Frames are always awaited with a time limit: at the end of a file, and after a device is
 * unplugged, a blocking readFrame() never returns. */
class OpenNi2Camera : public Camera
{
 public:
    OpenNi2Camera(const DeviceInfo& device, const CameraSettings& settings);
    ~OpenNi2Camera() override;
    OpenNi2Camera(const OpenNi2Camera&) = delete;
    OpenNi2Camera& operator=(const OpenNi2Camera&) = delete;

    [[nodiscard]] const CameraFacts& facts() const override { return facts_; }
    void start() override;
    [[nodiscard]] Delivery wait(CameraImage& image, std::chrono::milliseconds timeout) override;
    bool lockExposure() override;
    bool lockWhiteBalance() override;
    void recordTo(const std::string& oniPath) override;
    [[nodiscard]] bool startRecording() override;
    void stop() override;

 private:
    class Events;

    void openDevice();
    void openStreams();
    void createStream(openni::VideoStream& stream, openni::SensorType type, const char* what);
    void chooseMode(openni::VideoStream& stream, const char* what);
    void setUpFile();
    void setUpDevice();
    void chooseRegistration();
    void describeOptics();
    [[nodiscard]] int numStreams() const { return facts_.hasColour ? 2 : 1; }
    /** \return number of the stream that has an image, or nothing */
    [[nodiscard]] std::optional<std::size_t> waitForStream(int timeout_ms);
    [[nodiscard]] CameraImage copy(const openni::VideoFrameRef& frame, StreamKind stream) const;

    CameraSettings settings_;
    CameraFacts facts_;
    openni::Device device_;
    openni::VideoStream depth_, colour_;
    openni::Recorder recorder_;
    std::string oniPath_;
    int numStarts_{0};  // of the recorder
    std::unique_ptr<Events> events_;
    bool streaming_{false};
};
}  // namespace pointplane
