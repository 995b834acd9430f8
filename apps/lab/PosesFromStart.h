// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Chart.h>
#include <pointplane/evaluation/Trajectory.h>

#include <string>
#include <vector>

namespace pointplane
{
/** An estimate beside the truth at the same stamps, each seen from where it begins. Of the truth
 * the nearest pose counts. */
class PosesFromStart
{
 public:
    /** \param truth, estimate at least one pose each */
    PosesFromStart(const Trajectory& truth, const Trajectory& estimate);

    /** How far the last position is from the truth's [m]. */
    [[nodiscard]] double finalError() const;

    /** [P17, Fig. 5]: position and rotation vector over time, along and about the first camera's
     * axes, the truth dashed. \param name of the features */
    [[nodiscard]] std::vector<Chart> charts(const std::string& name) const;

 private:
    std::vector<double> time_;                           //!< since the first pose [s]
    std::vector<Eigen::Isometry3d> estimates_, truths_;  //!< T_first_camera
};
}  // namespace pointplane
