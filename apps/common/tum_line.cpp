// SPDX-License-Identifier: BSD-3-Clause
#include "tum_line.h"

#include <pointplane/mrpt_io/mrpt_poses.h>

#include <cstdio>

namespace pointplane
{
std::string tumLine(mrpt::Clock::time_point stamp, const Eigen::Isometry3d& pose)
{
    const Eigen::Vector3d t = pose.translation();
    const Eigen::Quaterniond q(pose.linear());
    char numbers[256];
    std::snprintf(
        numbers,
        sizeof(numbers),
        " %.9f %.9f %.9f %.9f %.9f %.9f %.9f",
        t.x(),
        t.y(),
        t.z(),
        q.x(),
        q.y(),
        q.z(),
        q.w());
    return stampText(stamp) + numbers;
}
}  // namespace pointplane
