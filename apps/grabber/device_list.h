// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/grabber/Camera.h>

#include <iosfwd>

namespace pointplane
{
/** Cameras, modes and abilities to `out`; without a camera, help to `err`. \return exit code */
int listCameras(const CameraDrivers& drivers, std::ostream& out, std::ostream& err);
}  // namespace pointplane
