// SPDX-License-Identifier: BSD-3-Clause
#include "FreenectCamera.h"

#include <mutex>

#include "drivers.h"
#include <sys/time.h>

// Players of recorded sessions (fakenect) replace the library but lack this.
#pragma weak freenect_set_flag

namespace pointplane
{
namespace
{
constexpr int kWidth = 640, kHeight = 480, kFps = 30;

// The Kinect's optics as its firmware states them: emitter 7.5 cm from the infrared camera, colour
// camera 2.5 cm, 120 mm to the reference plane with 0.1042 mm pixels of 1280 per line.
constexpr double kEmitterBaseline = 0.075;
constexpr double kColourOffset = 0.025;
constexpr double kInfraredFocal_px = 0.5 * 120.0 / 0.1042;
constexpr double kColourFocal_px = 525.0;

/** Depth [mm] of each 11-bit disparity: z = 8 f b / (d0 - raw), disparities in 1/8 px. */
std::vector<std::uint16_t> disparityTable()
{
    constexpr int kNumValues = 2048, kNoReading = 2047;
    constexpr double kMaxDepth_mm = 10000.0;
    constexpr double kZeroDisparity = 1089.4;
    std::vector<std::uint16_t> table(kNumValues, 0);
    for (int raw = 0; raw < kNoReading && raw < kZeroDisparity; ++raw)
    {
        const double z_mm =
            1000.0 * 8.0 * kInfraredFocal_px * kEmitterBaseline / (kZeroDisparity - raw);
        if (z_mm < kMaxDepth_mm)
        {
            table[static_cast<std::size_t>(raw)] = static_cast<std::uint16_t>(z_mm + 0.5);
        }
    }
    return table;
}

std::mutex logMutex;
std::string logText;

void keepError(freenect_context* /*context*/, freenect_loglevel level, const char* message)
{
    if (level <= FREENECT_LOG_ERROR)
    {
        const std::lock_guard<std::mutex> lock(logMutex);
        logText = message;
        logText.erase(logText.find_last_not_of(" \n") + 1);
    }
}

template <class Mode, class Count, class Get, class Fits>
bool findMode(Mode& found, Count count, Get get, Fits fits)
{
    for (int i = 0; i < count(); ++i)
    {
        const Mode mode = get(i);
        if (mode.is_valid != 0 && mode.resolution == FREENECT_RESOLUTION_MEDIUM && fits(mode))
        {
            found = mode;
            return true;
        }
    }
    return false;
}

bool findDepthMode(freenect_frame_mode& found, freenect_depth_format format)
{
    return findMode(
        found,
        freenect_get_depth_mode_count,
        freenect_get_depth_mode,
        [&](const auto& mode) { return mode.depth_format == format; });
}
}  // namespace

FreenectContext::FreenectContext()
{
    if (freenect_init(&context_, nullptr) < 0)
    {
        context_ = nullptr;
        return;
    }
    freenect_set_log_callback(context_, keepError);
    // Cameras only: motor and sound stay free for other programs.
    freenect_select_subdevices(context_, FREENECT_DEVICE_CAMERA);
}

FreenectContext::~FreenectContext()
{
    if (context_ != nullptr)
    {
        freenect_shutdown(context_);
    }
}

std::string FreenectContext::lastError()
{
    const std::lock_guard<std::mutex> lock(logMutex);
    return logText.empty() ? "no reason given by libfreenect" : logText;
}

FreenectCamera::FreenectCamera(
    std::shared_ptr<FreenectContext> context,
    const DeviceInfo& device,
    int index,
    const CameraSettings& settings)
    : context_(std::move(context))
{
    facts_.device = device;
    const auto& wanted = settings.mode;
    if (wanted.width != kWidth || wanted.height != kHeight || wanted.fps != kFps)
    {
        throw InputError(
            "the Kinect has no mode " + toString(wanted) +
            "; it offers: " + toString({kWidth, kHeight, kFps, ""}));
    }
    if (context_->get() == nullptr || freenect_open_device(context_->get(), &device_, index) < 0)
    {
        throw EnvironmentError(
            "cannot open Kinect " + device.uri + ": " + FreenectContext::lastError() +
            " (used by another program or by the kernel's gspca_kinect, or not in group plugdev?)");
    }
    facts_.mode = facts_.colourMode = {kWidth, kHeight, kFps, "RGB888"};
    facts_.hasColour = !settings.depthOnly;
    freenect_set_user(device_, this);
    try
    {
        chooseDepthMode(settings);
        chooseVideoMode(settings);
    }
    catch (...)
    {
        freenect_close_device(device_);
        throw;
    }
}

FreenectCamera::~FreenectCamera()
{
    stop();
    freenect_close_device(device_);
}

void FreenectCamera::chooseDepthMode(const CameraSettings& settings)
{
    const bool wantsRegistered =
        settings.registration != RegistrationChoice::Off && !settings.depthOnly;
    if (wantsRegistered && findDepthMode(depthMode_, FREENECT_DEPTH_REGISTERED))
    {
        facts_.registered = true;
    }
    else if (settings.registration == RegistrationChoice::On)
    {
        throw InputError("this libfreenect cannot register depth to colour");
    }
    else if (!findDepthMode(depthMode_, FREENECT_DEPTH_MM))
    {
        if (!findDepthMode(depthMode_, FREENECT_DEPTH_11BIT))
        {
            throw EnvironmentError("this libfreenect offers no 640x480 depth");
        }
        rawToMm_ = disparityTable();
        facts_.notes.emplace_back("depth from raw disparities with the Kinect's nominal optics");
    }
    if (freenect_set_depth_mode(device_, depthMode_) < 0)
    {
        throw EnvironmentError(
            "the Kinect refuses its depth mode: " + FreenectContext::lastError());
    }
    freenect_set_depth_callback(device_, &FreenectCamera::onDepth);
    facts_.colourFocal_px = kColourFocal_px;
    facts_.depthFocal_px = kInfraredFocal_px;
    facts_.colourOffset = kColourOffset;
}

void FreenectCamera::chooseVideoMode(const CameraSettings& settings)
{
    if (settings.depthOnly)
    {
        return;
    }
    const bool found = findMode(
        videoMode_,
        freenect_get_video_mode_count,
        freenect_get_video_mode,
        [](const auto& mode) { return mode.video_format == FREENECT_VIDEO_RGB; });
    if (!found || freenect_set_video_mode(device_, videoMode_) < 0)
    {
        throw EnvironmentError(
            "the Kinect refuses its colour mode: " + FreenectContext::lastError());
    }
    freenect_set_video_callback(device_, &FreenectCamera::onVideo);
}

void FreenectCamera::start()
{
    streaming_ = true;  // the first may run when the second does not start
    if (freenect_start_depth(device_) < 0 ||
        (facts_.hasColour && freenect_start_video(device_) < 0))
    {
        throw EnvironmentError("the Kinect does not start: " + FreenectContext::lastError());
    }
}

void FreenectCamera::onDepth(freenect_device* device, void* data, std::uint32_t stamp)
{
    auto& self = *static_cast<FreenectCamera*>(freenect_get_user(device));
    cv::Mat pixels = cv::Mat(kHeight, kWidth, CV_16UC1, data).clone();
    if (!self.rawToMm_.empty())
    {
        for (auto it = pixels.begin<std::uint16_t>(); it != pixels.end<std::uint16_t>(); ++it)
        {
            *it = self.rawToMm_[*it & 2047U];
        }
    }
    self.keep(StreamKind::Depth, pixels, stamp);
}

void FreenectCamera::onVideo(freenect_device* device, void* data, std::uint32_t stamp)
{
    auto& self = *static_cast<FreenectCamera*>(freenect_get_user(device));
    self.keep(StreamKind::Colour, cv::Mat(kHeight, kWidth, CV_8UC3, data).clone(), stamp);
}

void FreenectCamera::keep(StreamKind stream, cv::Mat pixels, std::uint32_t stamp)
{
    CameraImage image;
    image.stream = stream;
    image.layout = stream == StreamKind::Depth ? PixelLayout::Depth16 : PixelLayout::Rgb8;
    image.arrival = hostTime();
    image.deviceTime = timestamp_.seconds(stamp);
    image.index = stream == StreamKind::Depth ? depthIndex_++ : colourIndex_++;
    image.pixels = std::move(pixels);
    received_.push_back(std::move(image));
}

Delivery FreenectCamera::wait(CameraImage& image, std::chrono::milliseconds timeout)
{
    const auto deadline = std::chrono::steady_clock::now() + timeout;
    while (received_.empty())
    {
        const auto left = std::chrono::duration_cast<std::chrono::microseconds>(
            deadline - std::chrono::steady_clock::now());
        if (left.count() <= 0)
        {
            return Delivery::Timeout;
        }
        timeval limit{};
        limit.tv_sec = static_cast<time_t>(left.count() / 1'000'000);
        limit.tv_usec = static_cast<suseconds_t>(left.count() % 1'000'000);
        if (freenect_process_events_timeout(context_->get(), &limit) < 0 && received_.empty())
        {
            return Delivery::Disconnected;
        }
    }
    image = std::move(received_.front());
    received_.pop_front();
    return Delivery::Image;
}

bool FreenectCamera::lockFlag(freenect_flag flag)
{
    return freenect_set_flag != nullptr && freenect_set_flag(device_, flag, FREENECT_OFF) == 0;
}

bool FreenectCamera::lockExposure() { return lockFlag(FREENECT_AUTO_EXPOSURE); }

bool FreenectCamera::lockWhiteBalance() { return lockFlag(FREENECT_AUTO_WHITE_BALANCE); }

void FreenectCamera::recordTo(const std::string& oniPath)
{
    throw InputError("'" + oniPath + "': only the driver openni2 writes .oni files");
}

void FreenectCamera::stop()
{
    if (!streaming_)
    {
        return;
    }
    streaming_ = false;
    freenect_stop_depth(device_);
    if (facts_.hasColour)
    {
        freenect_stop_video(device_);
    }
}
}  // namespace pointplane
