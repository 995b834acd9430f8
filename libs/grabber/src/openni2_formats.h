// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/Camera.h>

#include <string>

#include <OpenNI.h>

namespace pointplane
{
/** "640x480@30 RGB888". */
[[nodiscard]] VideoMode videoModeOf(const openni::VideoMode& mode);

/** The serial number, or empty. */
[[nodiscard]] std::string serialOf(openni::Device& device);

/** One line of OpenNI2's last error. */
[[nodiscard]] std::string openNi2Error();

/** How much a pixel format is wanted; 0 = cannot be used. */
[[nodiscard]] int preference(openni::PixelFormat format);

/** How a pixel format lies in a cv::Mat. */
struct PixelFormatLayout
{
    PixelLayout layout;
    int cvType;
};

[[nodiscard]] PixelFormatLayout layoutOf(openni::PixelFormat format);

/** [px], from the driver's field of view; 0 = it states none. */
[[nodiscard]] double focalLength(const openni::VideoStream& stream, int width);
}  // namespace pointplane
