// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/PinholeCamera.h>

#include <mrpt/img/TCamera.h>

namespace pointplane
{
/** k1 to k3, p1 and p2 of plumb bob distortion; other distortion is left out. Whether the camera is
 * usable, its problem() says. */
[[nodiscard]] PinholeCamera fromMrpt(const mrpt::img::TCamera& from);
}  // namespace pointplane
