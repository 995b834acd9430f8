// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/JointCovariance.h>
#include <pointplane/odometry/NoiseScale.h>
#include <pointplane/odometry/OdometryParams.h>
#include <pointplane/odometry/OdometryResult.h>
#include <pointplane/odometry/PairBuilder.h>
#include <pointplane/odometry/ResidualVariogram.h>
#include <pointplane/odometry/ShutterCalibrator.h>

#include <vector>

namespace pointplane
{
/** Pose estimation and its validation [P17, section Pose estimation], and all that is learnt from
 * measured frames: the motion, the shutter, the noise. */
class PoseStage
{
 public:
    explicit PoseStage(const OdometryParams& params);

    struct Prediction
    {
        MotionGaussian motion;  //!< by velocities as they have been changing
        PoseGaussian pose;      //!< the same, with the chance of a jerk
        MotionPrior prior;      //!< what of both the solver is told
    };

    /** What the motion model says of a frame `dt` [s] after the previous measured one. */
    [[nodiscard]] Prediction predict(double dt);

    /** \return the prediction where there is too little to estimate from */
    [[nodiscard]] PoseEstimate estimate(
        const PairBuilder& pairs,
        const std::vector<Association>& associations,
        const Prediction& predicted,
        FrameDiagnostics& diagnostics) const;

    /** Sets status and reason: is the estimate to be believed? */
    void judge(
        const PoseEstimate& estimate, const Prediction& predicted, OdometryResult& result) const;

    /** What a believed estimate says. */
    struct Measured
    {
        Eigen::Isometry3d T_prev_cur;
        Vector6d velocity, previousVelocity;  //!< of this and of the previous measured frame
        JointCovariance::Measurement errors;
    };

    /** Learns from a believed estimate, `dt` [s] after the previous measured frame. */
    Measured accept(
        const PoseEstimate& estimate,
        const Prediction& predicted,
        const PairBuilder& pairs,
        const std::vector<Association>& associations,
        double dt);

    /** A frame without measurement. \return the predicted motion over it */
    PoseGaussian coast(double dt);

 private:
    [[nodiscard]] JointCovariance::Measurement errorsOf(
        const PoseEstimate& estimate,
        const PairBuilder& pairs,
        const Matrix6d& ofShutter,
        double dt);
    [[nodiscard]] bool fuses() const { return pipeline_.degeneracy == "fuse"; }
    [[nodiscard]] int minMatches() const;
    [[nodiscard]] MotionPrior priorFrom(
        const MotionGaussian& motion, const PoseGaussian& pose) const;

    PipelineParams pipeline_;
    JointCovariance::TParams covariance_;
    PoseSolver solver_;
    MotionModel motion_;
    NoiseScale noise_;
    ResidualVariogram variogram_;
    ShutterCalibrator shutter_;
    bool isFrameToFrame_;
};
}  // namespace pointplane
