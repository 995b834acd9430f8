// SPDX-License-Identifier: BSD-3-Clause
#include <charconv>
#include <optional>
#include <string_view>

#include "FreenectCamera.h"
#include "drivers.h"

// Players of recorded sessions (fakenect) replace the library but lack these.
#pragma weak freenect_list_device_attributes
#pragma weak freenect_free_device_attributes

namespace pointplane
{
namespace
{
constexpr std::string_view kUriPrefix = "freenect://";

/** 2 of "freenect://2". */
std::optional<int> indexOfCamera(const std::string& uri)
{
    int index = -1;
    if (uri.rfind(kUriPrefix, 0) == 0)
    {
        const char* const end = uri.data() + uri.size();
        const auto result = std::from_chars(uri.data() + kUriPrefix.size(), end, index);
        index = result.ptr == end ? index : -1;
    }
    return index < 0 ? std::nullopt : std::optional<int>(index);
}

class FreenectDriver : public CameraDriver
{
 public:
    [[nodiscard]] std::string name() const override { return "freenect"; }

    [[nodiscard]] std::vector<DeviceInfo> listDevices() override
    {
        std::vector<DeviceInfo> devices;
        if (context_->get() == nullptr)
        {
            return devices;
        }
        const int count = freenect_num_devices(context_->get());
        auto serials = serialNumbers();
        // Kinects that do not open have none: then nobody knows whose the others are.
        serials.resize(static_cast<int>(serials.size()) == count ? serials.size() : 0);
        for (int i = 0; i < count; ++i)
        {
            DeviceInfo info;
            info.driver = name();
            info.uri = std::string(kUriPrefix) + std::to_string(i);
            info.vendor = "Microsoft";
            info.name = "Kinect for Xbox 360";
            const auto n = static_cast<std::size_t>(i);
            info.serial = n < serials.size() ? serials[n] : "";
            info.depthModes = {{640, 480, 30, "DEPTH_1_MM"}};
            info.colourModes = {{640, 480, 30, "RGB888"}};
            info.canRegister = true;
            devices.push_back(info);
        }
        return devices;
    }

    [[nodiscard]] std::unique_ptr<Camera> open(
        const DeviceInfo& device, const CameraSettings& settings) override
    {
        const auto index = indexOfCamera(device.uri);
        if (!index)
        {
            throw EnvironmentError("'" + device.uri + "' is no Kinect");
        }
        return std::make_unique<FreenectCamera>(context_, device, *index, settings);
    }

    [[nodiscard]] std::string description() override
    {
        return context_->get() != nullptr ? "Kinect for Xbox 360 on USB, with libfreenect"
                                          : "Kinect for Xbox 360: no access to USB";
    }

 private:
    [[nodiscard]] std::vector<std::string> serialNumbers() const
    {
        std::vector<std::string> serials;
        freenect_device_attributes* list = nullptr;
        if (freenect_list_device_attributes == nullptr ||
            freenect_list_device_attributes(context_->get(), &list) < 0)
        {
            return serials;
        }
        for (const auto* item = list; item != nullptr; item = item->next)
        {
            serials.emplace_back(item->camera_serial != nullptr ? item->camera_serial : "");
        }
        freenect_free_device_attributes(list);
        return serials;
    }

    std::shared_ptr<FreenectContext> context_{std::make_shared<FreenectContext>()};
};
}  // namespace

std::unique_ptr<CameraDriver> makeFreenectDriver() { return std::make_unique<FreenectDriver>(); }
}  // namespace pointplane
