// SPDX-License-Identifier: BSD-3-Clause
#include "OpenNi2Camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <thread>

#include "drivers.h"
#include <sys/stat.h>

namespace pointplane
{
namespace
{
constexpr double kMicrosecond = 1e-6;

// PrimeSense's reference design, which Kinect, Xtion and Carmine share: the colour camera sits 25
// mm to the right of the infrared one.
constexpr double kPrimeSenseOffset = 0.025;

std::string pixelFormatName(openni::PixelFormat format)
{
    switch (format)
    {
        case openni::PIXEL_FORMAT_DEPTH_1_MM:
            return "DEPTH_1_MM";
        case openni::PIXEL_FORMAT_DEPTH_100_UM:
            return "DEPTH_100_UM";
        case openni::PIXEL_FORMAT_SHIFT_9_2:
            return "SHIFT_9_2";
        case openni::PIXEL_FORMAT_SHIFT_9_3:
            return "SHIFT_9_3";
        case openni::PIXEL_FORMAT_RGB888:
            return "RGB888";
        case openni::PIXEL_FORMAT_YUV422:
            return "YUV422";
        case openni::PIXEL_FORMAT_YUYV:
            return "YUYV";
        case openni::PIXEL_FORMAT_GRAY8:
            return "GRAY8";
        case openni::PIXEL_FORMAT_GRAY16:
            return "GRAY16";
        case openni::PIXEL_FORMAT_JPEG:
            return "JPEG";
    }
    return "format " + std::to_string(static_cast<int>(format));
}

/** How much a pixel format is wanted; 0 = cannot be used. */
int preference(openni::PixelFormat format)
{
    switch (format)
    {
        case openni::PIXEL_FORMAT_DEPTH_100_UM:
            return 1;
        case openni::PIXEL_FORMAT_DEPTH_1_MM:
            return 2;  // what calibrations of users refer to
        case openni::PIXEL_FORMAT_GRAY8:
            return 1;
        case openni::PIXEL_FORMAT_YUV422:
            return 2;
        case openni::PIXEL_FORMAT_YUYV:
            return 3;
        case openni::PIXEL_FORMAT_RGB888:
            return 4;
        default:
            return 0;
    }
}

struct Layout
{
    PixelLayout layout;
    int cvType;
};

Layout layoutOf(openni::PixelFormat format)
{
    switch (format)
    {
        case openni::PIXEL_FORMAT_RGB888:
            return {PixelLayout::Rgb8, CV_8UC3};
        case openni::PIXEL_FORMAT_YUYV:
            return {PixelLayout::Yuyv, CV_8UC2};
        case openni::PIXEL_FORMAT_YUV422:
            return {PixelLayout::Uyvy, CV_8UC2};
        case openni::PIXEL_FORMAT_GRAY8:
            return {PixelLayout::Gray8, CV_8UC1};
        default:
            return {PixelLayout::Depth16, CV_16UC1};
    }
}

double focalLength(const openni::VideoStream& stream, int width)
{
    const double fov = stream.getHorizontalFieldOfView();
    return fov > 0.1 && fov < 3.0 ? width / (2.0 * std::tan(fov / 2.0)) : 0.0;
}
}  // namespace

VideoMode videoModeOf(const openni::VideoMode& mode)
{
    return {
        mode.getResolutionX(),
        mode.getResolutionY(),
        mode.getFps(),
        pixelFormatName(mode.getPixelFormat())};
}

std::string serialOf(openni::Device& device)
{
    // Drivers write as much as they like: leave room.
    std::array<char, 1024> text{};
    int size = static_cast<int>(text.size()) - 1;
    if (device.getProperty(ONI_DEVICE_PROPERTY_SERIAL_NUMBER, text.data(), &size) !=
        openni::STATUS_OK)
    {
        return {};
    }
    return text.data();
}

std::string openNi2Error()
{
    std::string text = openni::OpenNI::getExtendedError();
    std::replace(text.begin(), text.end(), '\n', ' ');
    std::replace(text.begin(), text.end(), '\t', ' ');
    text.erase(text.find_last_not_of(' ') + 1);
    return text.empty() ? "no reason given by OpenNI2" : text;
}

/** Unplugging and the end of a file, which frames never tell. */
class OpenNi2Camera::Events : public openni::OpenNI::DeviceDisconnectedListener,
                              public openni::OpenNI::DeviceStateChangedListener
{
 public:
    explicit Events(std::string uri) : uri_(std::move(uri))
    {
        openni::OpenNI::addDeviceDisconnectedListener(this);
        openni::OpenNI::addDeviceStateChangedListener(this);
    }
    ~Events()
    {
        openni::OpenNI::removeDeviceDisconnectedListener(this);
        openni::OpenNI::removeDeviceStateChangedListener(this);
    }
    Events(const Events&) = delete;
    Events& operator=(const Events&) = delete;

    void onDeviceDisconnected(const openni::DeviceInfo* info) override
    {
        disconnected = disconnected || uri_ == info->getUri();
    }
    void onDeviceStateChanged(const openni::DeviceInfo* info, openni::DeviceState state) override
    {
        atEnd = atEnd || (state == openni::DEVICE_STATE_EOF && uri_ == info->getUri());
    }

    std::atomic<bool> disconnected{false};
    std::atomic<bool> atEnd{false};

 private:
    const std::string uri_;
};

OpenNi2Camera::OpenNi2Camera(const DeviceInfo& device, const CameraSettings& settings)
    : settings_(settings)
{
    facts_.device = device;
    openDevice();
    openStreams();
    facts_.isFile ? setUpFile() : setUpDevice();
    chooseRegistration();
    describeOptics();
}

OpenNi2Camera::~OpenNi2Camera()
{
    stop();
    depth_.destroy();
    colour_.destroy();
    device_.close();
}

void OpenNi2Camera::openDevice()
{
    const auto& uri = facts_.device.uri;
    const auto status = device_.open(uri.c_str());
    std::error_code error;
    facts_.isFile = std::filesystem::is_regular_file(uri, error);
    if (status != openni::STATUS_OK)
    {
        if (facts_.isFile)
        {
            throw InputError("'" + uri + "' is not a complete .oni recording: " + openNi2Error());
        }
        throw EnvironmentError("cannot open camera " + uri + ": " + openNi2Error());
    }
    // A device opened by a short name reports its full one, which is what events carry.
    const openni::DeviceInfo& info = device_.getDeviceInfo();
    events_ = std::make_unique<Events>(info.getUri());
    facts_.device.name = facts_.isFile ? "recording" : info.getName();
    facts_.device.vendor = info.getVendor();
    facts_.device.serial = serialOf(device_);
}

void OpenNi2Camera::createStream(
    openni::VideoStream& stream, openni::SensorType type, const char* what)
{
    if (!device_.hasSensor(type))
    {
        throw EnvironmentError(
            "camera " + facts_.device.uri + " has no " + what + " stream" +
            (type == openni::SENSOR_COLOR ? "; --depth-only records without it" : ""));
    }
    if (stream.create(device_, type) != openni::STATUS_OK)
    {
        throw EnvironmentError(
            "cannot create the " + std::string(what) + " stream of camera " + facts_.device.uri +
            ": " + openNi2Error());
    }
}

void OpenNi2Camera::openStreams()
{
    createStream(depth_, openni::SENSOR_DEPTH, "depth");
    facts_.hasColour = !settings_.depthOnly;
    if (facts_.hasColour)
    {
        createStream(colour_, openni::SENSOR_COLOR, "colour");
    }
}

void OpenNi2Camera::chooseMode(openni::VideoStream& stream, const char* what)
{
    const auto& supported = stream.getSensorInfo().getSupportedVideoModes();
    const openni::VideoMode* best = nullptr;
    std::string offered;
    for (int i = 0; i < supported.getSize(); ++i)
    {
        const auto& mode = supported[i];
        offered += (offered.empty() ? "" : ", ") + toString(videoModeOf(mode));
        const bool fits = mode.getResolutionX() == settings_.mode.width &&
                          mode.getResolutionY() == settings_.mode.height &&
                          mode.getFps() == settings_.mode.fps &&
                          preference(mode.getPixelFormat()) > 0;
        if (fits && (best == nullptr ||
                     preference(mode.getPixelFormat()) > preference(best->getPixelFormat())))
        {
            best = &mode;
        }
    }
    if (best == nullptr)
    {
        throw InputError(
            "the " + std::string(what) + " camera of " + facts_.device.uri + " has no mode " +
            toString(settings_.mode) + "; it offers: " + offered);
    }
    // A driver with a single mode may refuse to have it set.
    const bool isSet = toString(videoModeOf(stream.getVideoMode())) == toString(videoModeOf(*best));
    if (!isSet && stream.setVideoMode(*best) != openni::STATUS_OK)
    {
        throw EnvironmentError(
            "the " + std::string(what) + " camera of " + facts_.device.uri + " refuses its mode " +
            toString(videoModeOf(*best)) + ": " + openNi2Error());
    }
}

void OpenNi2Camera::setUpFile()
{
    auto* playback = device_.getPlaybackControl();
    if (playback == nullptr)
    {
        throw InputError("'" + facts_.device.uri + "' cannot be played");
    }
    // Speed -1 waits for the reader: at speed 1 frames are lost. Repeat is on by default.
    playback->setSpeed(-1.0F);
    playback->setRepeatEnabled(false);
    // The recording has no date; its file has one. Time stamps in it start at zero.
    struct stat status
    {
    };
    if (::stat(facts_.device.uri.c_str(), &status) == 0)
    {
        facts_.startTime = static_cast<double>(status.st_mtim.tv_sec) +
                           1e-9 * static_cast<double>(status.st_mtim.tv_nsec);
    }
    facts_.notes.emplace_back("time stamps count from the date of the .oni file");
}

void OpenNi2Camera::setUpDevice()
{
    chooseMode(depth_, "depth");
    if (facts_.hasColour)
    {
        chooseMode(colour_, "colour");
        const bool synced =
            settings_.frameSync && device_.setDepthColorSyncEnabled(true) == openni::STATUS_OK;
        facts_.synchronised = synced;
        if (settings_.frameSync && !synced)
        {
            facts_.notes.emplace_back("the camera cannot synchronise depth and colour");
        }
    }
    for (auto* stream : {&depth_, &colour_})
    {
        if (stream->isValid() && stream->setMirroringEnabled(false) != openni::STATUS_OK &&
            stream->getMirroringEnabled())
        {
            throw EnvironmentError(
                "camera " + facts_.device.uri + " delivers mirrored images and cannot stop it");
        }
    }
}

void OpenNi2Camera::chooseRegistration()
{
    if (!facts_.hasColour || settings_.registration == RegistrationChoice::Off)
    {
        device_.setImageRegistrationMode(openni::IMAGE_REGISTRATION_OFF);
        return;
    }
    if (facts_.isFile)
    {
        facts_.registered = true;
        if (settings_.registration == RegistrationChoice::Auto)
        {
            facts_.notes.emplace_back(
                "an .oni file does not say whether depth was registered: taken as registered "
                "(--registration off if not)");
        }
        return;
    }
    constexpr auto kMode = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
    facts_.registered = device_.isImageRegistrationModeSupported(kMode) &&
                        device_.setImageRegistrationMode(kMode) == openni::STATUS_OK;
    if (!facts_.registered && settings_.registration == RegistrationChoice::On)
    {
        throw InputError("camera " + facts_.device.uri + " cannot register depth to colour");
    }
}

void OpenNi2Camera::describeOptics()
{
    const auto mode = depth_.getVideoMode();
    facts_.mode = videoModeOf(mode);
    facts_.depthFocal_px = focalLength(depth_, mode.getResolutionX());
    facts_.colourOffset = kPrimeSenseOffset;
    if (facts_.hasColour)
    {
        const auto colourMode = colour_.getVideoMode();
        facts_.colourFocal_px = focalLength(colour_, colourMode.getResolutionX());
        if (facts_.registered && (colourMode.getResolutionX() != mode.getResolutionX() ||
                                  colourMode.getResolutionY() != mode.getResolutionY()))
        {
            facts_.registered = false;
            facts_.notes.emplace_back("depth and colour differ in size: stored as not registered");
        }
    }
}

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
