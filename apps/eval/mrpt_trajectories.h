// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>

#include <string>

namespace pointplane
{
/** Trajectory out of a rawlog, with covariances: the CObservationRobotPose of one sensor label
 * (format 2, or inside the sensory frames of format 1); or, where there is none, the composition of
 * format 1's CActionRobotMovement3D at the stamps of their sensory frames.
 *
 * A damaged rawlog gives what can be read, with a warning and `incomplete` set.
 * \param sensorLabel empty: the only one there is
 * \throws InputError naming file and labels: unreadable, no poses, or label unknown or ambiguous */
[[nodiscard]] Trajectory readRawlogTrajectory(
    const std::string& path, const std::string& sensorLabel);

/** Key-frame poses of a .simplemap, with covariances, at the stamps of their first observations.
 * \throws InputError naming the file */
[[nodiscard]] Trajectory readSimplemapTrajectory(const std::string& path);
}  // namespace pointplane
