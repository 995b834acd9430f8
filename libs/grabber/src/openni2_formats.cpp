// SPDX-License-Identifier: BSD-3-Clause
#include "openni2_formats.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace pointplane
{
namespace
{
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
}  // namespace

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

PixelFormatLayout layoutOf(openni::PixelFormat format)
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
}  // namespace pointplane
