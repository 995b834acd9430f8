// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

#include <optional>
#include <string>
#include <vector>

namespace pointplane
{
/** What the odometry says about a frame. */
enum class FrameStatus
{
    Tracked,    //!< measured; also where a file does not mark its frames
    Predicted,  //!< by the motion model, because the frame could not be measured
    Lost        //!< the frame could not be used
};

/** Whose poses they are: two trajectories must be of the same body. */
enum class Body
{
    Unknown,  //!< the file does not tell
    Camera,   //!< axes x right, y down, z forward
    Robot     //!< axes x forward, y left, z up
};

/** One pose of a trajectory, as a file gives it. */
struct StampedPose
{
    double stamp{0};                                        //!< [s] since the Unix epoch
    Eigen::Isometry3d pose{Eigen::Isometry3d::Identity()};  //!< T_world_body
    std::optional<Matrix6d> cov{};                          //!< see Trajectory::covs
    std::vector<Matrix6d> sinceCovs{};                      //!< see Trajectory::sinceCovs
    FrameStatus status{FrameStatus::Tracked};
    std::size_t number{0};  //!< see Trajectory::numbers; makeTrajectory() counts them
};

/** Poses of a moving body, ordered by strictly increasing stamps. */
struct Trajectory
{
    std::string name;                      //!< the file it came from, for messages
    Body body{Body::Unknown};              //!< as the file tells
    std::vector<double> stamps;            //!< [s] since the Unix epoch
    std::vector<Eigen::Isometry3d> poses;  //!< T_world_body [m]
    /** Empty, or one 6x6 covariance per pose: left perturbation (expressed in the world frame),
     * tangent order [translation; rotation], units m and rad, as in PoseGaussian. */
    std::vector<Matrix6d> covs;
    /** Empty, or for each pose those of the motions to it from 1, 2, ... poses before it in the
     * file (left perturbation, in the body frame of those), as far back as they were told. */
    std::vector<std::vector<Matrix6d>> sinceCovs;
    std::vector<std::size_t> numbers;  //!< of the poses in the file; empty: they are all here
    std::vector<FrameStatus> status;   //!< empty (all tracked), or one per pose
    /** The file says of every frame of the recording whether it was tracked. Lost frames without a
     * pose are in lostStamps or, if their stamp is of no use, in lostWithoutTime. */
    bool marksFrames{false};
    std::vector<double> lostStamps;  //!< of lost frames without a pose, in order [s]
    std::size_t lostWithoutTime{0};
    std::vector<std::string> warnings;  //!< what the reader left out, for the user
    bool incomplete{false};             //!< the file is damaged; these are the poses before

    [[nodiscard]] std::size_t size() const { return stamps.size(); }
    [[nodiscard]] bool empty() const { return stamps.empty(); }
    [[nodiscard]] double duration() const { return empty() ? 0 : stamps.back() - stamps.front(); }
};

/** Sorts poses by stamp. Of equal stamps the last one wins, as in the TUM scripts; a warning counts
 * the others. Another one counts lost frames whose stamp is not after the one before: their poses
 * are left out, because they are of another time. Poses that are NaN or infinite are left out with
 * a warning; their frames count as lost. Covariances are kept only if every pose has one. */
[[nodiscard]] Trajectory makeTrajectory(std::string name, std::vector<StampedPose> poses);

/** Path length from the first pose to each pose [m]. */
[[nodiscard]] std::vector<double> pathLengths(const Trajectory& trajectory);

/** Sum of the absolute rotation angles from the first pose to each pose [rad]. */
[[nodiscard]] std::vector<double> accumulatedAngles(const Trajectory& trajectory);

/** Rotation angle of R in [0, pi] [rad], by the arc cosine as the TUM scripts do it. */
[[nodiscard]] double rotationAngle(const Eigen::Matrix3d& R);

/** Removes the poses of lost frames, which nobody measured; their stamps become lostStamps. If
 * there are any, sinceCovs go, too, because they count all poses. */
[[nodiscard]] Trajectory withoutLost(Trajectory trajectory);

/** The trajectory of another frame rigidly attached to the moving body: poses * T_body_other. The
 * poses' covariances, being left perturbations, stay. */
[[nodiscard]] Trajectory withBody(Trajectory trajectory, const Eigen::Isometry3d& T_body_other);
}  // namespace pointplane
