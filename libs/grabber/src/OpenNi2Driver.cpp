// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <filesystem>

#include "OpenNi2Camera.h"
#include "drivers.h"
#include "openni2_formats.h"
#include <dlfcn.h>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;

/** Where the loaded libOpenNI2 looks for its driver libraries: beside itself. */
fs::path driverFolder()
{
    Dl_info info{};
    if (dladdr(reinterpret_cast<void*>(&oniInitialize), &info) == 0 || info.dli_fname == nullptr)
    {
        return {};
    }
    return fs::path(info.dli_fname).parent_path() / "OpenNI2" / "Drivers";
}

std::string installedDrivers(const fs::path& folder)
{
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error))
    {
        const auto name = entry.path().filename().string();
        if (name.find(".so") != std::string::npos)
        {
            names.push_back(name);
        }
    }
    std::sort(names.begin(), names.end());
    std::string list;
    for (const auto& name : names)
    {
        list += (list.empty() ? "" : ", ") + name;
    }
    return list.empty() ? "none" : list;
}

std::vector<VideoMode> modesOf(openni::Device& device, openni::SensorType type)
{
    std::vector<VideoMode> modes;
    if (const auto* sensor = device.getSensorInfo(type))
    {
        const auto& supported = sensor->getSupportedVideoModes();
        for (int i = 0; i < supported.getSize(); ++i)
        {
            modes.push_back(videoModeOf(supported[i]));
        }
    }
    return modes;
}

class OpenNi2Driver : public CameraDriver
{
 public:
    OpenNi2Driver()
    {
        if (openni::OpenNI::initialize() != openni::STATUS_OK)
        {
            problem_ = openNi2Error();
        }
    }
    ~OpenNi2Driver() override { openni::OpenNI::shutdown(); }
    OpenNi2Driver(const OpenNi2Driver&) = delete;
    OpenNi2Driver& operator=(const OpenNi2Driver&) = delete;

    [[nodiscard]] std::string name() const override { return "openni2"; }

    [[nodiscard]] std::vector<DeviceInfo> listDevices() override
    {
        std::vector<DeviceInfo> devices;
        openni::Array<openni::DeviceInfo> found;
        openni::OpenNI::enumerateDevices(&found);
        for (int i = 0; i < found.getSize(); ++i)
        {
            DeviceInfo info;
            info.driver = name();
            info.uri = found[i].getUri();
            info.vendor = found[i].getVendor();
            info.name = found[i].getName();
            addDetails(info);
            devices.push_back(info);
        }
        return devices;
    }

    [[nodiscard]] std::unique_ptr<Camera> open(
        const DeviceInfo& device, const CameraSettings& settings) override
    {
        if (!problem_.empty())
        {
            throw EnvironmentError("OpenNI2 does not start: " + problem_);
        }
        return std::make_unique<OpenNi2Camera>(device, settings);
    }

    [[nodiscard]] std::string description() override
    {
        const auto folder = driverFolder();
        std::string text = "devices of the driver libraries in " + folder.string() + ": " +
                           installedDrivers(folder);
        return problem_.empty() ? text : text + " (does not start: " + problem_ + ")";
    }

 private:
    static void addDetails(DeviceInfo& info)
    {
        openni::Device device;
        if (device.open(info.uri.c_str()) != openni::STATUS_OK)
        {
            info.problem = openNi2Error();
            return;
        }
        info.serial = serialOf(device);
        info.depthModes = modesOf(device, openni::SENSOR_DEPTH);
        info.colourModes = modesOf(device, openni::SENSOR_COLOR);
        info.canRegister =
            device.isImageRegistrationModeSupported(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR);
        device.close();
    }

    std::string problem_;
};
}  // namespace

std::unique_ptr<CameraDriver> makeOpenNi2Driver() { return std::make_unique<OpenNi2Driver>(); }
}  // namespace pointplane
