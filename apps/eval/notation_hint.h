// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Trajectory.h>

#include <string>

namespace pointplane
{
/** \return a hint for the user if one of the files seems to have positions in millimetres, or
 * quaternions as qw qx qy qz: read in that way, motions of both are alike. Otherwise empty
 * \param offset added to the estimate's stamps [s]
 * \param scale multiplies the estimate's translations */
[[nodiscard]] std::string hintAtNotation(
    const Trajectory& truth, const Trajectory& estimate, double offset, double scale);
}  // namespace pointplane
