// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

#include <optional>
#include <string>
#include <vector>

namespace pointplane
{
/** One pose of a trajectory, as a file gives it. */
struct StampedPose
{
    double stamp{0};                                        //!< [s] since the Unix epoch
    Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  //!< T_world_body
    std::optional<Matrix6d> cov{};                          //!< see Trajectory::covs
    std::vector<Matrix6d> sinceCovs{};                      //!< see Trajectory::sinceCovs
};

/** Poses of a moving body, ordered by strictly increasing stamps. */
struct Trajectory
{
    std::string name;                      //!< the file it came from, for messages
    std::vector<double> stamps;            //!< [s] since the Unix epoch
    std::vector<Eigen::Isometry3d> poses;  //!< T_world_body [m]
    /** Empty, or one 6x6 covariance per pose: left perturbation (expressed in the world frame),
     * tangent order [translation; rotation], units m and rad, as in PoseGaussian. */
    std::vector<Matrix6d> covs;
    /** Empty, or for each pose i those of the motions from poses i-1, i-2, ... to it (left
     * perturbation, in the body frame of i-1, i-2, ...), as far back as they were told. */
    std::vector<std::vector<Matrix6d>> sinceCovs;
    std::vector<std::string> warnings;  //!< what the reader left out, for the user
    bool incomplete{false};             //!< the file is damaged; these are the poses before

    [[nodiscard]] std::size_t size() const { return stamps.size(); }
    [[nodiscard]] bool empty() const { return stamps.empty(); }
    [[nodiscard]] double duration() const { return empty() ? 0 : stamps.back() - stamps.front(); }
};

/** Sorts by stamp; of equal stamps the last one wins (as in the TUM scripts) and a warning counts
 * the others. The covariances are kept only if every pose has one. */
[[nodiscard]] Trajectory makeTrajectory(std::string name, std::vector<StampedPose> poses);

/** Path length from the first pose to each pose [m]. */
[[nodiscard]] std::vector<double> pathLengths(const Trajectory& trajectory);

/** Sum of the absolute rotation angles from the first pose to each pose [rad]. */
[[nodiscard]] std::vector<double> accumulatedAngles(const Trajectory& trajectory);

/** Rotation angle of R in [0, pi] [rad], by the arc cosine as the TUM scripts do it. */
[[nodiscard]] double rotationAngle(const Eigen::Matrix3d& R);

/** Time covered by the estimate as a share of the ground truth's duration, in [0, 1]: the sum of
 * the estimate's intervals inside the ground truth's time range, without the gaps, which are
 * intervals longer than five times the median one. \param offset added to the estimate's stamps */
[[nodiscard]] double coverage(
    const Trajectory& groundTruth, const Trajectory& estimate, double offset);

/** Throws std::runtime_error that names both time ranges when the two do not overlap, or when one
 * of them holds fewer than two poses. \param offset added to the estimate's stamps [s] */
void checkOverlap(const Trajectory& groundTruth, const Trajectory& estimate, double offset);

/** Median of the intervals between stamps [s]; 0 for fewer than two poses. */
[[nodiscard]] double medianInterval(const Trajectory& trajectory);
}  // namespace pointplane
