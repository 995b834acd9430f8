// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/odometry/uncertainty/CameraCalibrator.h>
#include <pointplane/pose/PoseAnalysis.h>

#include <optional>
#include <vector>

#include "JointGaussian.h"
#include "MotionModel.h"

namespace pointplane
{
/** Joint covariance of the error state: errors that last from frame to frame, of the latest poses
 * (clones), of velocities, of the camera, and of the views and depth images of the references.
 *
 * Frames are compared with the same references again and again. So their errors do not add up as
 * those of independent increments would. The method is stochastic cloning (Roumeliotis and Burdick
 * 2002), with one common error per frame (view_errors.h) instead of one per feature. Each frame is
 * a step of linear covariance propagation, A Sigma A^T + Q: measure() or predict(). There is no
 * Kalman update, because the solver has already fused all that a frame tells.
 *
 * Errors of poses are left perturbations in the world frame [m, rad]; that of the velocity is in
 * the body frame [m/s, rad/s]. Derivation: docs/theory.md, Window. */
class JointCovariance
{
 public:
    /** Errors by the view (view_errors.h) of points, planes and patches: eta, zeta and s. */
    struct Views
    {
        std::vector<int> frames;  //!< ids of the references
        /** How errors of these frames and, as the last row and column, of the new one correlate. */
        Eigen::MatrixXd ofPoints{Eigen::MatrixXd::Identity(1, 1)};
        Eigen::MatrixXd ofPlanes{Eigen::MatrixXd::Identity(1, 1)};
        Eigen::MatrixXd ofPatches{Eigen::MatrixXd::Identity(1, 1)};
        Vector12d pointSigma{Vector12d::Zero()};  //!< standard deviations of eta
        Matrix6d planeRoot{Matrix6d::Zero()};     //!< zeta is this times unit noise
        double patchSigma{0};                     //!< standard deviation of s
    };

    /** Linear model of the error of a measured frame: of its pose (left perturbation in the
     * previous frame) and velocity, in m, rad, m/s, rad/s. Letters are those of docs/theory.md,
     * section Window. */
    struct Measurement
    {
        Sensitivity factors;                 //!< Jacobians with respect to the errors
        Matrix12d noise{Matrix12d::Zero()};  //!< covariance of e + p
        Views views;
        CameraCalibrator::Change camera;  //!< of k, by this frame
    };

    /** \param history so many frames back, poses stay known */
    explicit JointCovariance(int history) : history_(history) {}

    /** Starts with the first frame, a reference. Later ones count on from its number.
     * \param cov of its pose (left, world) */
    void start(int frame, const Matrix6d& cov);

    /** From here on, frames are those of another camera. \param cov of its errors; zero before the
     * first call */
    void changeCamera(const CameraMatrix& cov);

    /** The motion of a frame that was not measured. */
    struct Prediction
    {
        DecayedVelocities after;              //!< what became of the velocity before it
        Matrix6d velocity{Matrix6d::Zero()};  //!< covariance of the velocity before it
        /** Covariance of the motion and of the velocity after it, given that velocity. */
        Matrix12d noise{Matrix12d::Zero()};
    };

    /** Adds a frame that was not measured. The error of the velocity stays that of the frame
     * before, if that was not measured either. \param T_world_latest pose of the frame before (the
     * motion and the velocity are left perturbations in its frame) */
    void predict(const Eigen::Isometry3d& T_world_latest, const Prediction& prediction);

    /** In the next frame that is not measured, the error of the velocity is a new one. */
    void endCoasting() { dropCoasting(); }

    /** Makes a known frame the previous one and the only reference.
     * \param poses frames whose poses stay known, too */
    void restart(int frame, const std::vector<int>& poses = {});

    /** Adds a measured frame, which becomes the previous one and a reference.
     * \param T_world_prev pose of the previous frame
     * \param decayed what has become of the previous frame's velocity
     * \param previousVelocity correction of that velocity, if there is one */
    void measure(
        const Eigen::Isometry3d& T_world_prev,
        const DecayedVelocities& decayed,
        const Measurement& measurement,
        const std::optional<MotionModel::Smoothed>& previousVelocity = {});

    /** Forgets errors of other references than these, and poses older than the history. Kept are
     * the poses of the references, of the previous frame, and of `poses`. */
    void keep(const std::vector<int>& references, const std::vector<int>& poses = {});

    /** Covariance of the latest pose (left, world); positive semidefinite. */
    [[nodiscard]] Matrix6d latest() const;
    [[nodiscard]] int latestFrame() const { return latest_; }
    [[nodiscard]] int history() const { return history_; }

    /** Covariance of the velocity of a frame [m/s, rad/s]; zero if it is not known. */
    [[nodiscard]] Matrix6d velocity(int frame) const;

    /** Covariance of the motion from a frame in the history to the latest one (left perturbation in
     * frame `from`); positive semidefinite. \param T_world_from pose of that frame
     * \throws std::invalid_argument if the frame is not known */
    [[nodiscard]] Matrix6d relative(int from, const Eigen::Isometry3d& T_world_from) const;

 private:
    using Kind = JointGaussian::Kind;
    using Block = JointGaussian::Block;

    void dropCoasting(int kept = 0);
    void smooth(int frame, const Matrix6d& Ad, const MotionModel::Smoothed& velocity);
    [[nodiscard]] Eigen::Index newest() const { return find(Kind::Pose, latest_); }
    [[nodiscard]] bool has(Kind kind, int frame) const { return errors_.has(kind, frame); }
    [[nodiscard]] Eigen::Index find(Kind kind, int frame) const
    {
        return errors_.find(kind, frame);
    }
    [[nodiscard]] Matrix6d at(Eigen::Index row, Eigen::Index column) const;
    void addViews(
        int frame, Kind kind, const std::vector<int>& references, const Eigen::MatrixXd& C);
    [[nodiscard]] Eigen::MatrixXd dependence(
        int frame,
        const Matrix6d& Ad,
        const DecayedVelocities& decayed,
        const Measurement& measurement) const;

    int history_;           //!< frames
    JointGaussian errors_;  //!< poses newest first
    int latest_{0};         //!< frame
    int previous_{0};       //!< Track::previous()
    /** The previous frame before that, and the adjoint of its pose. */
    struct Earlier
    {
        int frame;
        Matrix6d Ad;
    };
    std::optional<Earlier> earlier_;
};
}  // namespace pointplane
