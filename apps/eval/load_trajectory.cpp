// SPDX-License-Identifier: BSD-3-Clause
#include "load_trajectory.h"

#include <pointplane/evaluation/trajectory_text.h>

#include <ostream>

namespace pointplane
{
Trajectory loadTrajectory(const std::string& path, std::ostream& err)
{
    Trajectory trajectory = readTrajectoryText(path);
    for (const std::string& warning : trajectory.warnings)
    {
        err << "warning: " << warning << "\n";
    }
    return trajectory;
}
}  // namespace pointplane
