// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/OdometryParams.h>
#include <pointplane/odometry/PairBuilder.h>
#include <pointplane/odometry/uncertainty/JointCovariance.h>
#include <pointplane/odometry/uncertainty/NoiseScale.h>
#include <pointplane/odometry/uncertainty/ResidualVariogram.h>
#include <pointplane/odometry/uncertainty/ShutterCalibrator.h>
#include <pointplane/pose/PoseSolver.h>

#include <vector>

namespace pointplane
{
/** Where errors of a measured pose come from, and how large they are, as learnt from the frames so
 * far:
 *
 * - the frame's own points and planes are noisy (NoiseScale for the solver's weights,
 *   ResidualVariogram and frame_errors for the covariance that is told);
 * - what a reference says drifts as it is seen from elsewhere (ResidualVariogram, frame_errors);
 * - the camera's calibration and shutter are not what they are modelled as (camera_errors,
 *   ShutterCalibrator);
 * - the motion that was predicted is uncertain (MotionModel, owned by Track).
 *
 * JointCovariance keeps account of how the errors of poses depend on these and on each other. */
class ErrorModel
{
 public:
    explicit ErrorModel(const OdometryParams& params);

    /** Variance of the features, for the solver. */
    [[nodiscard]] NoiseFactors noise() const { return noise_.factors(); }

    [[nodiscard]] const ShutterCalibrator& shutter() const { return shutter_; }

    /** A measured frame. */
    struct Measured
    {
        const PairBuilder& pairs;
        const std::vector<Association>& associations;
        const PoseProblem& problem;
        const PoseEstimate& estimate;
        const PoseAnalysis& analysis;
        double dt;              //!< [s] since the previous one
        Matrix12d motionNoise;  //!< of its prediction, by what the motion model adds in dt
    };

    /** Learns from the frame. \return what its estimate's errors come from */
    JointCovariance::Measurement learn(const Measured& frame);

 private:
    [[nodiscard]] JointCovariance::Measurement errorsOf(
        const Measured& frame, const Matrix6d& ofShutter);

    JointCovariance::TParams params_;
    bool isJoint_, fuses_;
    NoiseScale noise_;
    ResidualVariogram variogram_;
    ShutterCalibrator shutter_;
};
}  // namespace pointplane
