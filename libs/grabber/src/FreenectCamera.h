// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/Camera.h>

#include <deque>
#include <memory>
#include <vector>

#include "KinectTimestamp.h"
#include <libfreenect.h>

namespace pointplane
{
/** libfreenect's handle on the USB bus; keeps the last error that it logged. */
class FreenectContext
{
 public:
    FreenectContext();
    ~FreenectContext();
    FreenectContext(const FreenectContext&) = delete;
    FreenectContext& operator=(const FreenectContext&) = delete;

    [[nodiscard]] freenect_context* get() const { return context_; }  //!< nullptr: no USB
    [[nodiscard]] static std::string lastError();

 private:
    freenect_context* context_{nullptr};
};

/** A Kinect for Xbox 360. Its two cameras stamp their frames with one 60 MHz clock. The
 * frame index counts what arrives; lost frames show in the stamps. */
class FreenectCamera : public Camera
{
 public:
    /** \param index among the Kinects */
    FreenectCamera(
        std::shared_ptr<FreenectContext> context,
        const DeviceInfo& device,
        int index,
        const CameraSettings& settings);
    ~FreenectCamera() override;
    FreenectCamera(const FreenectCamera&) = delete;
    FreenectCamera& operator=(const FreenectCamera&) = delete;

    [[nodiscard]] const CameraFacts& facts() const override { return facts_; }
    void start() override;
    [[nodiscard]] Delivery wait(CameraImage& image, std::chrono::milliseconds timeout) override;
    bool lockExposure() override;
    bool lockWhiteBalance() override;
    void recordTo(const std::string& oniPath) override;
    void stop() override;

 private:
    static void onDepth(freenect_device* device, void* data, std::uint32_t stamp);
    static void onVideo(freenect_device* device, void* data, std::uint32_t stamp);
    void chooseDepthMode(const CameraSettings& settings);
    void chooseVideoMode(const CameraSettings& settings);
    void keep(StreamKind stream, cv::Mat pixels, std::uint32_t stamp);
    bool lockFlag(freenect_flag flag);

    std::shared_ptr<FreenectContext> context_;
    freenect_device* device_{nullptr};
    CameraFacts facts_;
    freenect_frame_mode depthMode_{}, videoMode_{};
    std::vector<std::uint16_t> rawToMm_;  // empty when the library converts
    KinectTimestamp timestamp_;
    std::int64_t depthIndex_{0}, colourIndex_{0};
    std::deque<CameraImage> received_;
    bool streaming_{false};
};
}  // namespace pointplane
