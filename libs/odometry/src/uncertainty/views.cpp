// SPDX-License-Identifier: BSD-3-Clause
#include "views.h"

#include <pointplane/core/se3.h>

#include <cmath>

namespace pointplane
{
double numViews(const Eigen::Isometry3d& motion)
{
    constexpr double kDistance = 0.15;          // [m]
    constexpr double kAngle = 10 * M_PI / 180;  // [rad]
    return motion.translation().norm() / kDistance + so3Log(motion.linear()).norm() / kAngle;
}
}  // namespace pointplane
