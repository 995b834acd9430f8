// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/Camera.h>

#include <algorithm>
#include <filesystem>

#include "drivers.h"

namespace pointplane
{
std::string toString(const VideoMode& mode)
{
    std::string text = std::to_string(mode.width) + "x" + std::to_string(mode.height) + "@" +
                       std::to_string(mode.fps);
    return mode.pixelFormat.empty() ? text : text + " " + mode.pixelFormat;
}

std::vector<std::string> builtInDrivers()
{
    std::vector<std::string> names;
#ifdef POINTPLANE_HAS_OPENNI2
    names.emplace_back("openni2");
#endif
#ifdef POINTPLANE_HAS_FREENECT
    names.emplace_back("freenect");
#endif
    return names;
}

CameraDrivers makeCameraDrivers(const std::string& which)
{
    const auto names = builtInDrivers();
    if (which != "auto" && std::find(names.begin(), names.end(), which) == names.end())
    {
        std::string list = "auto";
        for (const auto& name : names)
        {
            list += ", " + name;
        }
        throw InputError("no driver '" + which + "' in this build; it has: " + list);
    }
    CameraDrivers drivers;
#ifdef POINTPLANE_HAS_OPENNI2
    if (which == "auto" || which == "openni2")
    {
        drivers.push_back(makeOpenNi2Driver());
    }
#endif
#ifdef POINTPLANE_HAS_FREENECT
    if (which == "auto" || which == "freenect")
    {
        drivers.push_back(makeFreenectDriver());
    }
#endif
    return drivers;
}

namespace
{
bool isRecording(const std::string& choice)
{
    return std::filesystem::path(choice).extension() == ".oni";
}

std::unique_ptr<Camera> openRecording(
    const CameraDrivers& drivers, const std::string& path, const CameraSettings& settings)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
    {
        throw InputError("no such recording: '" + path + "'");
    }
    for (const auto& driver : drivers)
    {
        if (driver->name() == "openni2")
        {
            DeviceInfo device;
            device.driver = driver->name();
            device.uri = path;
            return driver->open(device, settings);
        }
    }
    throw InputError("'" + path + "': .oni recordings need the driver openni2");
}

bool fits(const DeviceInfo& device, std::size_t index, const std::string& choice)
{
    return choice.empty() || choice == device.uri || choice == device.serial ||
           choice == std::to_string(index);
}

/** Cameras that drivers know but do not list, such as OpenNI2's "Dummy". */
std::unique_ptr<Camera> openUnlisted(
    const CameraDrivers& drivers,
    const std::string& uri,
    const CameraSettings& settings,
    std::string& problems)
{
    for (const auto& driver : drivers)
    {
        DeviceInfo device;
        device.driver = driver->name();
        device.uri = uri;
        try
        {
            return driver->open(device, settings);
        }
        catch (const EnvironmentError& e)
        {
            problems += std::string("\n  ") + e.what();
        }
    }
    return nullptr;
}
}  // namespace

std::unique_ptr<Camera> openCamera(
    const CameraDrivers& drivers, const std::string& choice, const CameraSettings& settings)
{
    if (isRecording(choice))
    {
        return openRecording(drivers, choice, settings);
    }
    std::size_t index = 0;
    std::string problems;
    std::string listed;
    for (const auto& driver : drivers)
    {
        for (const auto& device : driver->listDevices())
        {
            const bool chosen = fits(device, index++, choice);
            listed +=
                "\n  " + device.uri + (device.serial.empty() ? "" : " serial " + device.serial);
            if (!chosen)
            {
                continue;
            }
            try
            {
                return driver->open(device, settings);
            }
            catch (const EnvironmentError& e)
            {
                problems += std::string(problems.empty() ? "" : "\n") + e.what();
            }
        }
    }
    if (!problems.empty())
    {
        throw EnvironmentError(problems);
    }
    if (!choice.empty())
    {
        if (auto camera = openUnlisted(drivers, choice, settings, problems))
        {
            return camera;
        }
        const std::string connected = index > 0 ? "; connected:" + listed : "; none is connected";
        throw NoCameraError("no camera '" + choice + "'" + connected + "\ntried:" + problems);
    }
    throw NoCameraError(noCameraHelp(drivers));
}

std::string noCameraHelp(const CameraDrivers& drivers)
{
    std::string text = "no RGB-D camera found. Looked for:\n";
    for (const auto& driver : drivers)
    {
        text += "  " + driver->name() + ": " + driver->description() + "\n";
    }
    const auto names = builtInDrivers();
    const bool hasFreenect = std::find(names.begin(), names.end(), "freenect") != names.end();
    text += hasFreenect ? "" : "  freenect: not in this build (build with libfreenect-dev)\n";
    text +=
        "What each camera needs:\n"
        "  Kinect for Xbox 360      driver freenect: package libfreenect0.5; be in group plugdev\n"
        "                           and unload the kernel's driver: modprobe -r gspca_kinect\n"
        "  Asus Xtion, PrimeSense   driver openni2: package libopenni2-0 (libPS1080)\n"
        "  Orbbec Astra             driver openni2: liborbbec.so of Orbbec's OpenNI2 SDK, copied\n"
        "                           to the folder of drivers above as liborbbec.so.0\n"
        "Check that `lsusb` lists it, that it has its power supply, and that no other program has "
        "it.";
    return text;
}
}  // namespace pointplane
