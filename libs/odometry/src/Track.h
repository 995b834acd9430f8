// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/OdometryParams.h>

#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "Features.h"
#include "PoseHistory.h"
#include "Reference.h"
#include "ReferenceWindow.h"
#include "uncertainty/JointCovariance.h"
#include "uncertainty/MotionModel.h"

namespace pointplane
{
/** What is known of a frame's motion since the previous one before it is measured. */
struct Prediction
{
    double dt{0};                //!< [s] since the previous frame
    bool followsMeasured{true};  //!< the latest frame was measured: it is the previous one
    MotionGaussian motion;       //!< if velocities change as they did so far
    PoseGaussian pose;           //!< T_prev_cur, uncertain also by a sudden acceleration
    MotionPrior prior;           //!< what the solver uses: pose, and velocity given it by motion
};

/** Where the camera has been so far: poses with their joint covariance, its velocity, and the
 * frames that a new one can be compared with. The previous frame is the latest measured one,
 * or the one at which comparing began anew; the world is the first frame. Each frame ends in one
 * transition: restart(), measure() or predict(). Before it, recall() and restartAtUnmatched() may
 * change what it is compared with. */
class Track
{
 public:
    explicit Track(const OdometryParams& params);

    // What is known

    [[nodiscard]] bool isEmpty() const { return window_.empty(); }

    /** \pre !isEmpty() */
    [[nodiscard]] const Reference& previous() const { return window_.previous(); }

    /** T_cur_world of a frame by its motion since the previous one. \pre !isEmpty() */
    [[nodiscard]] Eigen::Isometry3d fromWorld(const Eigen::Isometry3d& T_prev_cur) const
    {
        return T_prev_cur.inverse() * previous().T_world_cam.inverse();
    }

    /** The previous frame first, then the key frames, newest first. */
    [[nodiscard]] std::vector<const Reference*> references() const { return window_.active(); }

    /** Older key frames, which may be recalled. */
    [[nodiscard]] const std::deque<Reference>& places() const { return window_.places(); }

    /** ReferenceWindow::overlap(). */
    [[nodiscard]] double overlap(
        const std::vector<Association>& associations, const Features& current) const
    {
        return window_.overlap(associations, {!current.frame.gray.empty(), current.hasDepth});
    }

    [[nodiscard]] bool needsKeyframe(const Eigen::Isometry3d& T_prev_cur, double overlap) const;

    /** Pose in the world of the latest frame, measured or not. */
    [[nodiscard]] PoseGaussian pose() const { return history_.pose(); }

    /** Motions to the latest frame (OdometryResult::since). */
    [[nodiscard]] std::vector<PoseGaussian> since() const { return history_.sinceAll(); }

    /** Whether the latest frames are those of this camera. */
    [[nodiscard]] bool isOf(const PinholeCamera& camera) const;

    /** Predicts the motion from the previous frame. */
    [[nodiscard]] Prediction prediction(double stamp) const;

    /** MotionModel::processNoise(). */
    [[nodiscard]] Matrix12d motionNoise(double dt, const Matrix6d& open) const
    {
        return motion_.processNoise(dt, open);
    }

    /** Covariance of the velocity of each reference that has one, by its id. */
    [[nodiscard]] std::map<int, Matrix6d> velocityCovs() const;

    /** MotionModel::acceleration2(). */
    [[nodiscard]] const Vector6d& acceleration2() const { return motion_.acceleration2(); }

    // Transitions

    /** \return whether a frame's stamp is not after the latest one. One frame may be late. If a
     * second one follows it in order, the clock has been set, or the stamps before were wrong: it
     * is not late */
    [[nodiscard]] bool noteLate(double stamp);

    /** A frame is to be compared: after more than maxGap the velocity is unknown. */
    void noteGap(double stamp);

    /** Where noteLate() found that the clock was set, the time since the frames so far is unknown:
     * they count as kLongestStep old. \return whether it was set */
    bool followClock(double stamp);

    /** From here on, frames are those of this camera. The next one is one for restart().
     * \param cov of its errors (ErrorModel::changeCamera()) */
    void changeCamera(const PinholeCamera& camera, const CameraMatrix& cov);

    /** Begins with this frame or, later, goes on from its predicted pose. Earlier frames are not
     * compared with any more. \param frame without id and pose \return the increment */
    PoseGaussian restart(Reference frame);

    /** What was measured of the camera's speed so far is not to be believed. */
    void forgetVelocity();

    /** A measured frame. */
    struct Measured
    {
        Reference frame;  //!< without id, pose and velocity
        bool isKeyframe{false};
        /** It is not where any acceleration leads: the velocity is unknown. */
        bool isJump{false};
        MotionGaussian motion;
        double dt{0};  //!< [s] since the previous frame
        JointCovariance::Measurement errors;
    };
    void measure(Measured measured, const std::vector<Association>& associations);

    /** Goes on by the motion model alone. The previous frame stays, so the next good frame is
     * aligned with it over the whole gap. \param unmatched the frame itself, if it has features,
     * without id and pose. If the next frame does not match the references either,
     * restartAtUnmatched() goes on from this one \return the increment */
    PoseGaussian predict(double stamp, std::optional<Reference> unmatched = {});

    /** Makes a place a key frame again, with which the next frame is compared. */
    void recall(int id) { window_.recall(id); }

    /** Makes the latest frame that matched no reference the only reference.
     * \return false if there is none; nothing has changed then */
    [[nodiscard]] bool restartAtUnmatched();

 private:
    /** To a frame whose motion was not measured. */
    PoseGaussian coast(double stamp);
    /** A late frame does not move the camera on. Its pose is the latest one, uncertain by as far as
     * a camera gets in the time between, if the stamps tell that. */
    PoseGaussian stay(double stamp);
    [[nodiscard]] MotionPrior priorFrom(
        const MotionGaussian& motion, const PoseGaussian& pose) const;
    void noteWhichPointsAreFound(const std::vector<Association>& associations);
    /** \return velocity of the previous frame */
    std::optional<MotionModel::Smoothed> updateMotion(const MotionGaussian& motion, double dt);
    void add(Reference frame, bool isKeyframe);
    [[nodiscard]] std::vector<int> placeIds() const;
    void forgetOthers();

    double maxGap_;
    bool fuses_, isFrameToFrame_;
    MotionModel motion_;
    PoseHistory history_;
    ReferenceWindow window_;
    std::optional<Reference> unmatched_;  //!< has features, but none that the window knows
    PinholeCamera camera_;
    double latestStamp_{std::numeric_limits<double>::quiet_NaN()};  //!< NaN: none
    std::optional<double> lateStamp_;  //!< of the latest frame, when it was not after latestStamp_
    bool wasLost_{false};              //!< there were frames before the first good one
    bool isPreviousMeasured_{false};   //!< it is not the first frame, nor one that matched none
    bool isVelocityKnown_{false};      //!< measured, and not forgotten since
};
}  // namespace pointplane
