// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/core/types.h>
#include <pointplane/pose/pairs.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace pointplane
{
/** Errors of the latest poses, of the velocity, and of what the reference frames say about a pose,
 * as one Gaussian (stochastic cloning of Roumeliotis and Burdick 2002, with what the features of a
 * reference have in common in place of the features).
 *
 * Frames are compared with the same references again and again: their errors do not grow from frame
 * to frame as those of independent increments would. All errors are left perturbations in the world
 * frame [m, rad], the velocity's in the body frame [m/s, rad/s]. Derivation in docs/theory.md. */
class JointCovariance
{
 public:
    struct TParams
    {
        std::string model{"joint"};
        double noise{0.92};
        double drift{0.21};
        double driftSigma{0.0005};
        double motion{0.07};
        double vignetting{0.15};
        double principalPoint{0.2};
        double focalLength{0.0004};
        int history{1};

        template <class V>
        void visit(V&& v)
        {
            v("model",
              model,
              "-",
              "joint (with the errors of the references) or independent (each increment as the "
              "solver has it, as in the paper)");
            v("noise",
              noise,
              "-",
              "variance of one frame's own error, over what the change of the residuals from frame "
              "to frame makes of its points and planes");
            v("drift",
              drift,
              "-",
              "variance that what planes say of a reference gains until another view (0.15 m or 10 "
              "deg), over what the residuals gain; 33 times as much for points");
            v("driftSigma",
              driftSigma,
              "m",
              "standard deviation that it gains besides in every direction (and half as many rad), "
              "for features 1 m away whose residuals gain as much as was propagated; with their "
              "distance to the power of 1.5");
            v("motion",
              motion,
              "-",
              "variance of how the motion changes, over what the solver is told of it, which is to "
              "believe a jerk");
            v("vignetting",
              vignetting,
              "-",
              "standard deviation of what the image's corners are darker than its centre; where "
              "shading tells the motion, it looks like one");
            v("principalPoint",
              principalPoint,
              "px",
              "standard deviation of the camera's cx and cy: how well it is calibrated");
            v("focalLength",
              focalLength,
              "-",
              "standard deviation of the camera's fx and fy together, over them");
            v("history", history, "frames", "how far back motions are told with their covariances");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
        [[nodiscard]] bool isJoint() const;  //!< or of independent increments
    };

    /** On what pose (left perturbation in the previous measured frame) and
     * velocity of a measured frame depend. */
    struct Measurement
    {
        std::map<int, Matrix126d> references;     //!< change with the pose of each reference
        Matrix12d prior{Matrix12d::Zero()};       //!< change with that of the predicted motion
        Matrix12d noise{Matrix12d::Zero()};       //!< of the frame's own features
        Matrix12d priorNoise{Matrix12d::Zero()};  //!< of the predicted motion, without the velocity
        Matrix124d camera{Matrix124d::Zero()};    //!< change with errors of the camera
        Matrix6d drift{Matrix6d::Zero()};  //!< gained by each reference since the previous frame
    };

    explicit JointCovariance(const TParams& params);

    /** The first frame, a reference. \param cov of its pose */
    void start(int frame, const Matrix6d& cov);

    /** A frame that was not measured. \param T_world_latest pose of the frame before
     * \param cov of the motion from there (left perturbation in its frame) */
    void predict(int frame, const Eigen::Isometry3d& T_world_latest, const Matrix6d& cov);

    /** A frame whose pose is known becomes the previous one and a reference.
     * \param references that stay, too */
    void restart(int frame, const std::vector<int>& references = {});

    /** A measured frame: the next previous one, and a reference.
     * \param T_world_prev pose of the previous measured frame \param dt [s] since that */
    void measure(
        int frame,
        const Eigen::Isometry3d& T_world_prev,
        double dt,
        const Measurement& measurement);

    /** Forgets all other references, and poses beyond the history but the previous and `pose`. */
    void keep(const std::vector<int>& references, std::optional<int> pose = {});

    /** Of the latest pose; positive semidefinite. */
    [[nodiscard]] Matrix6d latest() const;

    /** Whether relative() knows the frame. */
    [[nodiscard]] bool knows(int frame) const;

    /** Of the motion from a frame in the history to the latest (left perturbation in its frame);
     * positive semidefinite. \param T_world_from its pose */
    [[nodiscard]] Matrix6d relative(int from, const Eigen::Isometry3d& T_world_from) const;

 private:
    enum class Kind
    {
        Pose,
        Velocity,
        Camera,  //!< the first of its rows; they stay what they are
        Reference
    };
    struct Block
    {
        Kind kind;
        int frame;
    };

    [[nodiscard]] Eigen::Index find(Kind kind, int frame) const;
    [[nodiscard]] Matrix6d at(Eigen::Index row, Eigen::Index column) const;
    [[nodiscard]] Eigen::MatrixXd dependence(
        const Matrix6d& Ad, double dt, const Measurement& measurement) const;
    void prepend(
        const std::vector<Block>& blocks, const Eigen::MatrixXd& A, const Eigen::MatrixXd& Q);
    void select(const std::vector<std::size_t>& kept);

    TParams params_;
    std::vector<Block> blocks_;  //!< poses newest first
    Eigen::MatrixXd cov_;        //!< six rows per block
    int previous_{0};
};
}  // namespace pointplane
