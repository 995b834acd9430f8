// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/CameraImage.h>
#include <pointplane/mrpt_io/errors.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

namespace pointplane
{
struct VideoMode
{
    int width{640}, height{480};  //!< [px]
    int fps{30};                  //!< nominal [Hz]
    std::string pixelFormat;      //!< as the driver calls it; empty in a request = any
};

/** "640x480@30", with the pixel format if there is one. */
[[nodiscard]] std::string toString(const VideoMode& mode);

/** What a driver says about a device before it streams. */
struct DeviceInfo
{
    std::string driver;  //!< "openni2" or "freenect"
    std::string uri;
    std::string serial;  //!< empty when the device has none
    std::string vendor, name;
    std::vector<VideoMode> depthModes, colourModes;
    bool canRegister{false};  //!< depth to colour in hardware or by the driver
    std::string problem;      //!< why it cannot be opened, or empty
};

enum class RegistrationChoice
{
    Auto,  //!< if the camera offers it; recordings of unknown state are taken as registered
    On,    //!< refuse a camera that does not offer it; recordings are taken as registered
    Off
};

/** What the user wants of a camera. */
struct CameraSettings
{
    VideoMode mode;
    RegistrationChoice registration{RegistrationChoice::Auto};
    bool frameSync{true};
    bool depthOnly{false};
};

/** Properties of an opened camera. */
struct CameraFacts
{
    DeviceInfo device;
    VideoMode mode;                  //!< in use, of depth
    VideoMode colourMode;            //!< the same if depth is registered
    bool isFile{false};              //!< a recording: delivered as fast as it is read, without loss
    bool hasColour{true};            //!< false in depth-only mode
    bool registered{false};          //!< depth pixels lie on the colour image
    bool synchronised{false};        //!< shutters coupled in hardware
    double depthFocal_px{0};         //!< from the driver's field of view; 0 = unknown
    double colourFocal_px{0};        //!< likewise
    double colourOffset{0};          //!< [m] colour camera right of the depth camera
    double startTime{0};             //!< [s] UTC of device time 0, for recordings only
    std::vector<std::string> notes;  //!< what the user should know about how it was opened
};

enum class Delivery
{
    Image,
    Timeout,
    EndOfFile,
    Disconnected
};

/** An opened RGB-D camera. Everything but the constructor runs in one thread. */
class Camera
{
 public:
    virtual ~Camera() = default;

    [[nodiscard]] virtual const CameraFacts& facts() const = 0;

    /** \throws EnvironmentError if a stream does not start */
    virtual void start() = 0;

    /** Waits for the next image of either stream. After Image, `image` owns its pixels. */
    [[nodiscard]] virtual Delivery wait(CameraImage& image, std::chrono::milliseconds timeout) = 0;

    /** Freeze exposure and white balance at their present values. Only while streaming.
     * \return false if the camera cannot */
    virtual bool lockExposure() = 0;
    virtual bool lockWhiteBalance() = 0;  //!< \sa lockExposure

    /** Before start(): prepares an .oni file of the streams, which is made anew.
     * \throws InputError if this driver cannot \throws EnvironmentError if the file fails */
    virtual void recordTo(const std::string& oniPath) = 0;

    /** Writes to that file until stop(). Call it when all images of a frame have come: in the file,
     * the stamps of both streams begin at 0.
     * \return false if others came before it began: call it after their frame
     * \throws EnvironmentError if that does not end */
    [[nodiscard]] virtual bool startRecording() { return true; }

    virtual void stop() = 0;
};

/** A driver through which cameras are reached. */
class CameraDriver
{
 public:
    virtual ~CameraDriver() = default;

    [[nodiscard]] virtual std::string name() const = 0;

    /** Connected devices, those in use by others included (DeviceInfo::problem). */
    [[nodiscard]] virtual std::vector<DeviceInfo> listDevices() = 0;

    /** \param device one of listDevices(), or only a uri that the driver may know (a file)
     * \throws InputError for a mode that the device does not have or a damaged recording
     * \throws EnvironmentError if the device cannot be opened */
    [[nodiscard]] virtual std::unique_ptr<Camera> open(
        const DeviceInfo& device, const CameraSettings& settings) = 0;

    /** What it looks for, and with which library: for the message that there is no device. */
    [[nodiscard]] virtual std::string description() = 0;
};

/** The built-in drivers, in the order in which they are asked. \param which "auto" or a name
 * \throws InputError for a driver that does not exist or was not built in */
[[nodiscard]] std::vector<std::unique_ptr<CameraDriver>> makeCameraDrivers(
    const std::string& which);

/** "openni2 freenect": the names that makeCameraDrivers() accepts. */
[[nodiscard]] std::vector<std::string> builtInDrivers();

/** No camera at all, or none that fits the choice; a camera may appear later. */
class NoCameraError : public EnvironmentError
{
 public:
    using EnvironmentError::EnvironmentError;
};

using CameraDrivers = std::vector<std::unique_ptr<CameraDriver>>;

/** Finds a camera by URI, serial number, index in the list (from 0) or .oni file; empty = the first
 * that can be opened. A choice that is none of these is tried as a URI by each driver.
 * \throws NoCameraError \throws InputError for an unusable recording or mode
 * \throws EnvironmentError if the camera is there but cannot be opened */
[[nodiscard]] std::unique_ptr<Camera> openCamera(
    const CameraDrivers& drivers, const std::string& choice, const CameraSettings& settings);

/** Several lines: what was looked for, what is installed, and what to install for which camera. */
[[nodiscard]] std::string noCameraHelp(const CameraDrivers& drivers);
}  // namespace pointplane
