// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PoseGaussian.h>

#include <deque>
#include <optional>
#include <vector>

#include "uncertainty/JointCovariance.h"

namespace pointplane
{
/** Poses T_world_k of the latest frames, measured or predicted, with their joint covariance. Frames
 * are numbered 1, 2, 3, ... in the order in which they are added. */
class PoseHistory
{
 public:
    /** \param history frames */
    explicit PoseHistory(int history);

    /** The next frames are those of another camera. \param cov of its errors; zero before the first
     * call */
    void changeCamera(const CameraMatrix& cov) { joint_.changeCamera(cov); }

    /** Adds a frame that was not measured: its pose is where the motion leads to. */
    void predict(const Eigen::Isometry3d& T_latest_cur, const JointCovariance::Prediction& errors);

    /** The same by a motion whose error is independent of all others. */
    void predict(const PoseGaussian& increment);

    /** JointCovariance::endCoasting(). */
    void endCoasting() { joint_.endCoasting(); }

    /** Adds a measured frame.
     * \param T_world_prev pose of the previous frame
     * \param decayed its velocity since then
     * \param previousVelocity correction of that, if there is one */
    void measure(
        const Eigen::Isometry3d& T_world_prev,
        const Eigen::Isometry3d& T_prev_cur,
        const DecayedVelocities& decayed,
        const JointCovariance::Measurement& errors,
        const std::optional<MotionModel::Smoothed>& previousVelocity);

    /** From here on, frames are compared with this one and later ones.
     * \param poses frames whose poses stay known, too */
    void restart(int frame, const std::vector<int>& poses = {}) { joint_.restart(frame, poses); }

    /** Forgets all poses but those of the history, of the references and of `poses`. */
    void keep(const std::vector<int>& references, const std::vector<int>& poses);

    [[nodiscard]] const Eigen::Isometry3d& latest() const { return poses_.front(); }
    /** JointCovariance::velocity(). */
    [[nodiscard]] Matrix6d velocityCov(int frame) const { return joint_.velocity(frame); }
    [[nodiscard]] int latestFrame() const { return joint_.latestFrame(); }

    /** T_world_latest. */
    [[nodiscard]] PoseGaussian pose() const;

    /** T_past_latest. \pre that frame is in the history */
    [[nodiscard]] PoseGaussian since(int framesAgo) const;

    /** The same for all frames in the history, the latest first. */
    [[nodiscard]] std::vector<PoseGaussian> sinceAll() const;

 private:
    JointCovariance joint_;
    std::deque<Eigen::Isometry3d> poses_;  //!< latest first; before the first frame, the identity
};
}  // namespace pointplane
