// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/Camera.h>

#include <memory>

namespace pointplane
{
/** Any camera with an OpenNI2 driver library, and .oni recordings. */
[[nodiscard]] std::unique_ptr<CameraDriver> makeOpenNi2Driver();

/** The Kinect for Xbox 360, through libfreenect. */
[[nodiscard]] std::unique_ptr<CameraDriver> makeFreenectDriver();

/** [s] UTC, anchored once to the wall clock: never steps when the wall clock is set. */
[[nodiscard]] double hostTime();
}  // namespace pointplane
