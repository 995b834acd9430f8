// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include "OpenNi2Camera.h"
#include "OpenNi2Events.h"
#include "openni2_formats.h"
#include <sys/stat.h>

namespace pointplane
{
namespace
{
// PrimeSense's reference design, which Kinect, Xtion and Carmine share: the colour camera sits 25
// mm to the right of the infrared one.
constexpr double kPrimeSenseOffset = 0.025;

/** Whether two neighbouring pixels have one colour: such images cannot be turned by pixels. */
bool sharesColour(const openni::VideoStream& stream)
{
    const auto layout = layoutOf(stream.getVideoMode().getPixelFormat()).layout;
    return layout == PixelLayout::Yuyv || layout == PixelLayout::Uyvy;
}
}  // namespace

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
    for (auto* stream : {&depth_, &colour_})
    {
        if (stream->isValid() && preference(stream->getVideoMode().getPixelFormat()) == 0)
        {
            throw InputError(
                "'" + facts_.device.uri + "': its " + (stream == &depth_ ? "depth" : "colour") +
                " stream, " + toString(videoModeOf(stream->getVideoMode())) +
                ", is in a format that is not supported" +
                (stream == &depth_ ? "" : "; --depth-only leaves it out"));
        }
        if (stream->isValid() && stream->getMirroringEnabled() && sharesColour(*stream))
        {
            throw InputError(
                "'" + facts_.device.uri + "': its colour stream, " +
                toString(videoModeOf(stream->getVideoMode())) +
                ", is mirrored, which can be undone for RGB888 only; --depth-only leaves it out");
        }
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
    facts_.notes.emplace_back(
        "time stamps count from the date of the .oni file, which is that of its end");
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
        facts_.colourMode = videoModeOf(colourMode);
        facts_.colourFocal_px = focalLength(colour_, colourMode.getResolutionX());
        if (facts_.registered && (colourMode.getResolutionX() != mode.getResolutionX() ||
                                  colourMode.getResolutionY() != mode.getResolutionY()))
        {
            facts_.registered = false;
            facts_.notes.emplace_back("depth and colour differ in size: stored as not registered");
        }
    }
}
}  // namespace pointplane
