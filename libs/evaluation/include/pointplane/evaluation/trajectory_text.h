// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>

#include <string>

namespace pointplane
{
/** Reads a trajectory from text, in one of two formats told apart by the number of columns:
 * - 8: TUM, `stamp tx ty tz qx qy qz qw`;
 * - 7: MRPT's CPose3DInterpolator, `stamp x y z yaw pitch roll` [m, rad].
 *
 * As the TUM scripts read it: commas and tabs count as spaces, lines that start with '#' (or MRPT's
 * '%') and empty lines are skipped, lines with NaN or a zero quaternion are left out (each kind
 * counted in the warnings, with its first line) and their frames are lost, quaternions are
 * normalised (those whose norm is off by more than 1 % are counted, too), the last of equal stamps
 * wins. But more columns, which the scripts ignore, are refused: they are of other formats.
 * Comments that name the axes tell the body: "x right, y down" the camera, "x forward, y left" the
 * robot. Two others count:
 * `# pointplane-status STAMP lost: ...` is a frame without a pose, and `... predicted: ...` one
 * whose pose nobody measured.
 * \throws std::runtime_error naming the file and, if one is malformed, the line */
[[nodiscard]] Trajectory readTrajectoryText(const std::string& path);
}  // namespace pointplane
