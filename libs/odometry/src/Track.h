// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/Features.h>
#include <pointplane/odometry/OdometryParams.h>
#include <pointplane/odometry/Reference.h>
#include <pointplane/odometry/ReferenceWindow.h>
#include <pointplane/odometry/uncertainty/JointCovariance.h>
#include <pointplane/odometry/uncertainty/MotionModel.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "PoseHistory.h"

namespace pointplane
{
/** What is known of a frame's motion since the previous one before it is measured. */
struct Prediction
{
    double dt{0};           //!< [s] since the previous frame
    MotionGaussian motion;  //!< by velocities as they have been changing
    PoseGaussian pose;      //!< the same, with the chance of a jerk
    MotionPrior prior;      //!< what of both the solver is told
};

/** Where the camera has been so far: poses with their joint covariance, its velocity, and the
 * frames that a new one can be compared with. The previous frame is the latest measured one, the
 * world the first frame. Each frame is one transition: restart(), measure() or predict(). */
class Track
{
 public:
    explicit Track(const OdometryParams& params);

    // What is known

    [[nodiscard]] bool isEmpty() const { return !started_; }

    /** \pre !isEmpty() */
    [[nodiscard]] const Reference& previous() const { return window_.previous(); }

    /** The previous frame first, then the key frames, newest first. */
    [[nodiscard]] std::vector<const Reference*> references() const { return window_.active(); }

    /** Older key frames, which may be recalled. */
    [[nodiscard]] const std::deque<Reference>& places() const { return window_.places(); }

    /** The fraction of the newest key frame's points or planes that was found again, the smaller.
     */
    [[nodiscard]] double overlap(const std::vector<Association>& associations) const
    {
        return window_.overlap(associations);
    }

    [[nodiscard]] bool needsKeyframe(const Eigen::Isometry3d& T_prev_cur, double overlap) const;

    /** Pose in the world of the latest frame, whatever became of it. */
    [[nodiscard]] PoseGaussian pose() const { return history_.pose(); }

    /** Motions to the latest frame (OdometryResult::since). */
    [[nodiscard]] std::vector<PoseGaussian> since() const { return history_.sinceAll(); }

    /** Why a frame cannot be compared with the past, or empty. */
    [[nodiscard]] std::string interruption(double stamp, const PinholeCamera& camera) const;

    /** One frame may come late. A second one in order after it means that the clock has been set,
     * or that the stamps before were wrong; it is not late then. */
    [[nodiscard]] bool isLate(double stamp);

    /** Of the motion from the previous frame. After more than maxGap nothing is known of the
     * velocity any more. */
    [[nodiscard]] Prediction prediction(double stamp);

    /** Covariance of a prediction that does not come from that of the velocity as it was measured.
     */
    [[nodiscard]] Matrix12d motionNoise(double dt) const { return motion_.processNoise(dt); }

    // Transitions

    /** Begins with this frame, or goes on from where it is predicted to be; what was seen before is
     * forgotten. \param frame without id and pose \return the increment */
    PoseGaussian restart(Reference frame, const PinholeCamera& camera);

    /** What a measured frame says. */
    struct Measured
    {
        Reference frame;  //!< without id, pose and velocity
        bool isKeyframe{false};
        MotionGaussian motion;
        double dt{0};  //!< [s] since the previous frame
        JointCovariance::Measurement errors;
        const std::vector<Association>& associations;
    };
    void measure(Measured measured);

    /** Goes on by the motion model alone. The previous frame stays: the next good one is aligned
     * with it over the whole gap. \param unmatched the frame itself, when it has features, without
     * id and pose: if the next one does not match the references either, restartAtUnmatched() goes
     * on from here
     * \return the increment */
    PoseGaussian predict(double stamp, std::optional<Reference> unmatched = {});

    /** The camera is in this place again: the next alignment compares with it, too. */
    void recall(int id) { window_.recall(id); }

    /** Makes the latest frame that matched no reference the only reference.
     * \return false if there is none; nothing has changed then */
    [[nodiscard]] bool restartAtUnmatched();

 private:
    [[nodiscard]] MotionPrior priorFrom(
        const MotionGaussian& motion, const PoseGaussian& pose) const;
    /** \return velocity of the previous frame */
    Vector6d follow(const MotionGaussian& motion, double dt);
    void add(Reference frame, bool isKeyframe);
    [[nodiscard]] std::vector<int> placeIds() const;
    void forgetOthers();

    double maxGap_;
    bool fuses_, isFrameToFrame_;
    MotionModel motion_;
    JointCovariance::TParams calibration_;
    ShutterCalibrator::TParams shutter_;
    PoseHistory history_;
    ReferenceWindow window_;
    std::optional<Reference> unmatched_;  //!< has features, but none that the window knows
    PinholeCamera camera_;
    double latestStamp_{0};
    std::optional<double> lateStamp_;  //!< of the latest frame, when it was not after latestStamp_
    bool started_{false};
};
}  // namespace pointplane
