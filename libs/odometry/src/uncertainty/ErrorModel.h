// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/odometry/OdometryParams.h>
#include <pointplane/odometry/uncertainty/CameraCalibrator.h>
#include <pointplane/odometry/uncertainty/NoiseScale.h>
#include <pointplane/pose/PoseSolver.h>

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include "../Reference.h"
#include "ErrorsByView.h"
#include "JointCovariance.h"

namespace pointplane
{
/** Error budget of a measured pose: how the covariance of a pose comes about. Start here.
 *
 * The solver's estimate is linearised in all that it was made from. The error of the new pose and
 * velocity is then linear in errors that last from frame to frame, which JointCovariance holds as
 * one Gaussian state (stochastic cloning), and in noise that is new. To first order
 * (docs/theory.md, section Window; K_r is H^-1 H_r there, P_r is H^-1 H_P,r, and K_0 is H^-1 H_0),
 *
 *     (xi, nu) = sum_r (K_r (xi_r + zeta - zeta_r) + D_r nu_r + P_r (eta - eta_r) + C_r s_r)
 *                + C s + K_0 (xi + m nu, kappa nu)_prev + B k + e + p
 *
 * The factors K_r, D_r, P_r (by points), C_r, C, K_0 and B are the Jacobians of the solution,
 * members of Sensitivity. xi, nu, eta, zeta, s and k are states; e and p are white. The terms:
 *
 * - xi_r, nu_r: errors of pose and velocity of reference r. A rolling shutter has moved its
 *   features by the velocity.
 * - eta, eta_r: what all points of this frame, and of reference r, err by together, because depth,
 *   lens and scene are not quite what they are modelled as. A Gaussian process over views:
 *   view_errors. Its size follows how far references contradict each other: commonAngle().
 * - zeta, zeta_r: what the planes of this frame, and of reference r, err by together, because their
 *   bends and outlines depend on the view. A process like eta; it moves the pose as the noise of
 *   planes does. Its size is learnt from how residuals grow between unlike views: ErrorsByView.
 * - s, s_r: smooth error of the depth images, by which neighbouring points err together: a scale of
 *   depth in each patch. A part of it is new in each image, the rest is a process like zeta:
 *   ErrorsByView. None with structured light.
 * - (..)_prev: errors of the previous pose and its decayed velocity, where the prediction begins.
 * - p: what white acceleration adds to the predicted motion: MotionModel, which Track owns.
 * - k: errors of the camera that all frames share: vignetting, principal point, focal length,
 *   radial distortion, scale of depth, and the shutter. All are consider states (Schmidt):
 *   camera_errors. The shutter's are also estimated, and those of a lens that nobody calibrated:
 *   CameraCalibrator.
 * - e: noise of the frame's own points and planes, a part of what their residuals show:
 *   NoiseScale, ErrorsByView. And acceleration while the images are exposed: exposure_errors.
 *
 * e and eta are larger in a frame whose image pulls the pose apart: NoiseScale::ofFrame().
 *
 * JointCovariance propagates the covariance of all poses from these. How to calibrate it is in
 * docs/consistency.md. */
class ErrorModel
{
 public:
    explicit ErrorModel(const OdometryParams& params);

    /** Variance of the features, for the solver. */
    [[nodiscard]] NoiseFactors noise() const { return noise_.factors(); }

    /** Variance of the residuals so far, over the propagated one, which they may have at least. */
    [[nodiscard]] NoiseFactors usual() const
    {
        const NoiseFactors residuals = noise_.residuals();
        return {std::max(1.0, residuals.points), std::max(1.0, residuals.planes)};
    }

    /** What was learnt of the camera. */
    [[nodiscard]] const CameraCalibrator& camera() const { return camera_; }

    /** From here on, frames are those of this camera: nothing is known of its noise.
     * \return covariance of its errors */
    [[nodiscard]] CameraMatrix changeCamera(const PinholeCamera& camera);

    /** A measured frame. */
    struct Measured
    {
        std::vector<const Reference*> references;  //!< the previous frame first
        PoseEstimate estimate;
        PoseAnalysis analysis;
        double dt{0};                              //!< [s] since the previous one
        ShutterModel shutter;                      //!< as far as its source knows it
        double bend{0};                            //!< DepthNoise::sigmaRelative
        Matrix12d motionNoise{Matrix12d::Zero()};  //!< MotionModel::processNoise()
        Vector6d acceleration2{Vector6d::Zero()};  //!< MotionModel::acceleration2()
        std::map<int, Matrix6d> velocities;        //!< covariances, of the references
        std::optional<Matrix6d> doubt;             //!< Alignment::doubt
    };

    /** Learns from the frame. \return what its estimate's errors come from */
    JointCovariance::Measurement learn(const Measured& frame);

 private:
    [[nodiscard]] JointCovariance::Measurement errorsOf(
        const Measured& frame, JointCovariance::Views views) const;

    /** Standard deviation of eta, as a turn [rad]: in proportion to how far references contradict
     * each other by more than the frame's own noise makes them. */
    [[nodiscard]] double commonAngle() const;

    /** Covariance that errors of the velocities give to what the frame tells of the times of the
     * shutter: S in docs/theory.md, section Learning the camera. */
    [[nodiscard]] Eigen::Matrix3d timesByVelocities(const Measured& frame) const;

    CovarianceParams params_;
    NoiseScale::TParams noiseParams_;
    bool isJoint_, fuses_;
    NoiseScale noise_;
    ErrorsByView planes_;   //!< variance of e and zeta, by planes
    ErrorsByView patches_;  //!< variance of s, over expectedBend()
    CameraCalibrator camera_;
    double viewAngle_{1};  //!< angle of view of the camera [rad]
};
}  // namespace pointplane
