// SPDX-License-Identifier: BSD-3-Clause
// An OpenNI2 driver library: one RGB-D camera that plays the frames of a file and misbehaves as its
// settings say. Loaded by the real OpenNI2 runtime; VirtualCamera.h sets it up.
#include <new>
// The driver interface expects these of its user.
#define XN_NEW(type, argument) new type(argument)
#define XN_DELETE(pointer) delete (pointer)
#ifndef FALSE
#define FALSE 0
#define TRUE 1
#endif
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include "frame_file.h"
#include <Driver/OniDriverAPI.h>

namespace
{
using pointplane::test::FrameFile;
using Clock = std::chrono::steady_clock;
constexpr int kPeriod_us = 33333;
constexpr int kFps = 30;

/** Text file of `key value` lines, named by the environment. */
class Settings
{
 public:
    Settings()
    {
        const char* path = std::getenv("POINTPLANE_VIRTUAL_CAMERA");
        std::ifstream file(path != nullptr ? path : "");
        std::string key, value;
        while (file >> key >> value)
        {
            values_[key] = value;
        }
    }
    [[nodiscard]] int number(const std::string& key, int fallback) const
    {
        const auto it = values_.find(key);
        return it == values_.end() ? fallback : std::atoi(it->second.c_str());
    }
    [[nodiscard]] std::string text(const std::string& key) const
    {
        const auto it = values_.find(key);
        return it == values_.end() ? "" : it->second;
    }

 private:
    std::map<std::string, std::string> values_;
};

/** What streams share: settings, frames, and the moment when the camera started. */
struct CameraState
{
    Settings settings;
    FrameFile frames{settings.text("frames")};
    std::atomic<bool> unplugged{false};
    void (*unplug)() = nullptr;
};

class VirtualStream : public oni::driver::StreamBase
{
 public:
    VirtualStream(OniSensorType type, CameraState& state) : type_(type), state_(state)
    {
        const bool isDepth = type == ONI_SENSOR_DEPTH;
        mode_.pixelFormat = isDepth ? ONI_PIXEL_FORMAT_DEPTH_1_MM : ONI_PIXEL_FORMAT_RGB888;
        mode_.resolutionX = state.frames.width();
        mode_.resolutionY = state.frames.height();
        mode_.fps = kFps;
    }
    ~VirtualStream() override { stop(); }
    VirtualStream(const VirtualStream&) = delete;
    VirtualStream& operator=(const VirtualStream&) = delete;

    OniBool isPropertySupported(int id) override
    {
        for (const int supported : kProperties)
        {
            if (id == supported)
            {
                return TRUE;
            }
        }
        return FALSE;
    }

    OniStatus getProperty(int id, void* data, int* size) override
    {
        const int width = mode_.resolutionX, height = mode_.resolutionY;
        const auto f = static_cast<float>(state_.frames.focal_px());
        const bool isDepth = type_ == ONI_SENSOR_DEPTH;
        switch (id)
        {
            case ONI_STREAM_PROPERTY_VIDEO_MODE:
                return put(data, size, mode_);
            case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
                return put(data, size, 2.0F * std::atan(static_cast<float>(width) / (2.0F * f)));
            case ONI_STREAM_PROPERTY_VERTICAL_FOV:
                return put(data, size, 2.0F * std::atan(static_cast<float>(height) / (2.0F * f)));
            case ONI_STREAM_PROPERTY_MAX_VALUE:
                return put(data, size, isDepth ? 10000 : 255);
            case ONI_STREAM_PROPERTY_MIN_VALUE:
                return put(data, size, 0);
            case ONI_STREAM_PROPERTY_STRIDE:
                return put(data, size, width * bytesPerPixel());
            case ONI_STREAM_PROPERTY_MIRRORING:
                return put(data, size, mirrored_);
            // Without it in an .oni file the player drops every frame.
            case ONI_STREAM_PROPERTY_CROPPING:
                return put(data, size, OniCropping{FALSE, 0, 0, width, height});
            default:
                return ONI_STATUS_NOT_SUPPORTED;
        }
    }

    OniStatus setProperty(int id, const void* data, int size) override
    {
        if (id == ONI_STREAM_PROPERTY_MIRRORING && size == sizeof(OniBool))
        {
            if (state_.settings.number("claimsMirrored", 0) == 0)
            {
                std::memcpy(&mirrored_, data, sizeof(OniBool));
            }
            return ONI_STATUS_OK;
        }
        if (id != ONI_STREAM_PROPERTY_VIDEO_MODE || size != sizeof(OniVideoMode))
        {
            return ONI_STATUS_NOT_SUPPORTED;
        }
        OniVideoMode mode;
        std::memcpy(&mode, data, sizeof(mode));
        const bool same = mode.resolutionX == mode_.resolutionX &&
                          mode.resolutionY == mode_.resolutionY && mode.fps == mode_.fps &&
                          mode.pixelFormat == mode_.pixelFormat;
        return same ? ONI_STATUS_OK : ONI_STATUS_NOT_SUPPORTED;
    }

    void notifyAllProperties() override
    {
        for (const int id : kProperties)
        {
            char value[sizeof(OniVideoMode) + sizeof(OniCropping)];
            int size = id == ONI_STREAM_PROPERTY_VIDEO_MODE ? int{sizeof(OniVideoMode)}
                       : id == ONI_STREAM_PROPERTY_CROPPING ? int{sizeof(OniCropping)}
                                                            : 4;
            if (getProperty(id, value, &size) == ONI_STATUS_OK)
            {
                raisePropertyChanged(id, value, size);
            }
        }
    }

    OniStatus start() override
    {
        if (!running_.exchange(true))
        {
            thread_ = std::thread([this] { play(); });
        }
        return ONI_STATUS_OK;
    }

    void stop() override
    {
        running_ = false;
        if (thread_.joinable())
        {
            thread_.join();
        }
    }

 private:
    static constexpr int kProperties[] = {
        ONI_STREAM_PROPERTY_VIDEO_MODE,
        ONI_STREAM_PROPERTY_HORIZONTAL_FOV,
        ONI_STREAM_PROPERTY_VERTICAL_FOV,
        ONI_STREAM_PROPERTY_MAX_VALUE,
        ONI_STREAM_PROPERTY_MIN_VALUE,
        ONI_STREAM_PROPERTY_STRIDE,
        ONI_STREAM_PROPERTY_MIRRORING,
        ONI_STREAM_PROPERTY_CROPPING};

    template <class T>
    static OniStatus put(void* data, int* size, const T& value)
    {
        if (*size != static_cast<int>(sizeof(T)))
        {
            return ONI_STATUS_BAD_PARAMETER;
        }
        std::memcpy(data, &value, sizeof(T));
        return ONI_STATUS_OK;
    }

    [[nodiscard]] int bytesPerPixel() const { return type_ == ONI_SENSOR_DEPTH ? 2 : 3; }

    void play()
    {
        const auto& set = state_.settings;
        const bool isDepth = type_ == ONI_SENSOR_DEPTH;
        const int skew_us = isDepth ? 0 : set.number("skewUs", 0);
        const int dropEvery = set.number(isDepth ? "dropDepthEvery" : "dropColourEvery", 0);
        const int period_us = set.number("periodUs", kPeriod_us);
        const bool silent = set.number(isDepth ? "silentDepth" : "silentColour", 0) != 0;
        const int unplugAt = isDepth ? set.number("unplugAt", 0) : 0;
        const int first = isDepth ? 1 : set.number("firstColour", 1);
        const int loseBothEvery = set.number("loseBothEvery", 0);
        const bool countsDelivered = set.number("countsDelivered", 0) != 0;
        const bool hasClock = set.number("constantStamps", 0) == 0;
        int numDelivered = 0;
        // A camera's clock, not the host's: all stamps are multiples of its own period.
        const auto begin = Clock::now() + std::chrono::milliseconds(set.number("startDelayMs", 0));
        for (int k = 1; running_; ++k)
        {
            const std::int64_t time_us = std::int64_t{period_us} * k + skew_us;
            std::this_thread::sleep_until(begin + std::chrono::microseconds(time_us));
            if (k == unplugAt)
            {
                state_.unplugged = true;
                state_.unplug();
            }
            const bool isLost = k < first || (dropEvery > 0 && k % dropEvery == 0) ||
                                (loseBothEvery > 0 && k % loseBothEvery == 0);
            if (!state_.unplugged && !silent && !isLost)
            {
                const int index = countsDelivered ? ++numDelivered : k;
                deliver(k, index, hasClock ? time_us * set.number("ticksPerUs", 1) : 5);
            }
        }
    }

    /** Again and again, or forth and back, which keeps a motion steady. */
    [[nodiscard]] int frameNumber(int k) const
    {
        const int count = state_.frames.numFrames();
        if (state_.settings.number("forthAndBack", 0) == 0 || count < 2)
        {
            return k % count;
        }
        const int phase = k % (2 * count - 2);
        return phase < count ? phase : 2 * count - 2 - phase;
    }

    void deliver(int k, int index, std::int64_t stamp)
    {
        OniFrame* frame = getServices().acquireFrame();
        if (frame == nullptr)
        {
            return;
        }
        const auto& file = state_.frames;
        frame->frameIndex = index;
        frame->videoMode = mode_;
        frame->width = file.width();
        frame->height = file.height();
        frame->cropOriginX = frame->cropOriginY = 0;
        frame->croppingEnabled = FALSE;
        frame->sensorType = type_;
        frame->timestamp = static_cast<std::uint64_t>(stamp);
        frame->stride = file.width() * bytesPerPixel();
        frame->dataSize = frame->stride * file.height();
        const int n = frameNumber(k - 1);
        const void* pixels = type_ == ONI_SENSOR_DEPTH ? file.depth(n) : file.colour(n);
        std::memcpy(frame->data, pixels, static_cast<std::size_t>(frame->dataSize));
        raiseNewFrame(frame);
        getServices().releaseFrame(frame);
    }

    const OniSensorType type_;
    CameraState& state_;
    OniVideoMode mode_{};
    OniBool mirrored_{TRUE};  // as real cameras: users must turn it off
    std::atomic<bool> running_{false};
    std::thread thread_;
};

class VirtualDevice : public oni::driver::DeviceBase
{
 public:
    explicit VirtualDevice(CameraState& state) : state_(state)
    {
        const int width = state.frames.width(), height = state.frames.height();
        depthMode_ = {ONI_PIXEL_FORMAT_DEPTH_1_MM, width, height, kFps};
        colourMode_ = {ONI_PIXEL_FORMAT_RGB888, width, height, kFps};
        sensors_[0] = {ONI_SENSOR_DEPTH, 1, &depthMode_};
        sensors_[1] = {ONI_SENSOR_COLOR, 1, &colourMode_};
    }

    OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override
    {
        *sensors = sensors_;
        *count = state_.settings.number("noColour", 0) != 0 ? 1 : 2;
        return ONI_STATUS_OK;
    }
    oni::driver::StreamBase* createStream(OniSensorType type) override
    {
        return new VirtualStream(type, state_);
    }
    void destroyStream(oni::driver::StreamBase* stream) override { delete stream; }

    OniBool isPropertySupported(int id) override
    {
        return id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER ||
               id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION;
    }
    OniStatus getProperty(int id, void* data, int* size) override
    {
        if (id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER)
        {
            static const char kSerial[] = "VC-0000000000000000000012345";  // longer than 16
            *size = std::min(*size, int{sizeof(kSerial)});
            std::memcpy(data, kSerial, static_cast<std::size_t>(*size));
            return ONI_STATUS_OK;
        }
        if (id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION && *size == sizeof(registration_))
        {
            std::memcpy(data, &registration_, sizeof(registration_));
            return ONI_STATUS_OK;
        }
        return ONI_STATUS_NOT_SUPPORTED;
    }
    OniStatus setProperty(int id, const void* data, int size) override
    {
        if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION || size != sizeof(registration_))
        {
            return ONI_STATUS_NOT_SUPPORTED;
        }
        std::memcpy(&registration_, data, sizeof(registration_));
        return ONI_STATUS_OK;
    }
    OniBool isImageRegistrationModeSupported(OniImageRegistrationMode mode) override
    {
        return mode == ONI_IMAGE_REGISTRATION_OFF ||
               state_.settings.number("noRegistration", 0) == 0;
    }

 private:
    CameraState& state_;
    OniVideoMode depthMode_{}, colourMode_{};
    OniSensorInfo sensors_[2]{};
    int registration_{0};
};

class VirtualDriver;
VirtualDriver* theDriver = nullptr;

class VirtualDriver : public oni::driver::DriverBase
{
 public:
    explicit VirtualDriver(OniDriverServices* services) : DriverBase(services)
    {
        theDriver = this;
        state_.unplug = [] { theDriver->deviceDisconnected(&theDriver->info_); };
        std::strcpy(info_.uri, "virtual://0");
        std::strcpy(info_.vendor, "pointplane");
        std::strcpy(info_.name, "Virtual RGB-D");
    }
    ~VirtualDriver() override
    {
        if (appearing_.joinable())
        {
            appearing_.join();
        }
    }

    OniStatus initialize(
        oni::driver::DeviceConnectedCallback connected,
        oni::driver::DeviceDisconnectedCallback disconnected,
        oni::driver::DeviceStateChangedCallback stateChanged,
        void* cookie) override
    {
        DriverBase::initialize(connected, disconnected, stateChanged, cookie);
        if (state_.settings.number("noDevice", 0) != 0)
        {
            return ONI_STATUS_OK;
        }
        if (const int delay = state_.settings.number("appearAfterMs", 0); delay > 0)
        {
            appearing_ = std::thread(
                [this, delay]
                {
                    std::this_thread::sleep_for(std::chrono::milliseconds(delay));
                    deviceConnected(&info_);
                });
            return ONI_STATUS_OK;
        }
        deviceConnected(&info_);
        return ONI_STATUS_OK;
    }
    oni::driver::DeviceBase* deviceOpen(const char* uri, const char* /*mode*/) override
    {
        return std::strcmp(uri, info_.uri) == 0 ? new VirtualDevice(state_) : nullptr;
    }
    void deviceClose(oni::driver::DeviceBase* device) override { delete device; }
    void shutdown() override {}
    OniStatus tryDevice(const char* /*uri*/) override { return ONI_STATUS_ERROR; }
    void* enableFrameSync(oni::driver::StreamBase** /*streams*/, int /*count*/) override
    {
        return this;
    }

 private:
    CameraState state_;
    OniDeviceInfo info_{};
    std::thread appearing_;
};
}  // namespace

ONI_EXPORT_DRIVER(VirtualDriver)
