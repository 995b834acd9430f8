// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/pose/PoseAnalysis.h>
#include <pointplane/sensor/RgbdFrame.h>

namespace pointplane
{
/** Covariance of an estimate by acceleration while the frame's images are exposed. The shutter is
 * corrected for constant velocity. With acceleration a, a row that is exposed s after the frame's
 * instant is off by a s^2 / 2. Points are off by the mean of that over the rows of the colour
 * image, planes by the mean over the rows of the depth image. \param acceleration2 mean square of
 * the acceleration, per axis [m^2/s^4, rad^2/s^4] \param shutter with all times known \return
 * covariance of [left perturbation of the pose; velocity] */
[[nodiscard]] Matrix12d accelerationWhileExposed(
    const Sensitivity& of, const ShutterModel& shutter, const Vector6d& acceleration2);
}  // namespace pointplane
