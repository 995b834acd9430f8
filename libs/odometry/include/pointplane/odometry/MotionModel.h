// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/core/PoseGaussian.h>

namespace pointplane
{
/** Decaying velocity model (Klein & Murray 2007, quoted in [P17, section Pose estimation]): the
 * camera keeps a fraction of its velocity; the velocity's change is white. */
class MotionModel
{
 public:
    struct TParams
    {
        double decay{0.9};
        double sigmaAcceleration{3.0};
        double sigmaAngularAcceleration{10.0};

        template <class V>
        void visit(V&& v)
        {
            v("decay", decay, "-", "of the velocity kept over 1/30 s when a frame is not measured");
            v("sigmaAcceleration", sigmaAcceleration, "m/s^2", "of a hand-held camera, per axis");
            v("sigmaAngularAcceleration", sigmaAngularAcceleration, "rad/s^2", "per axis");
        }
        void check() const;
    };

    explicit MotionModel(const TParams& params) : params_(params) {}

    /** Predicted T_prev_cur over `dt` [s] with its covariance. \pre dt > 0 */
    [[nodiscard]] PoseGaussian predict(double dt) const;

    /** A measured increment. */
    void update(const Eigen::Isometry3d& T_prev_cur, double dt);

    /** No measurement over `dt`: the velocity decays, its uncertainty grows. */
    void coast(double dt);

    /** An increment has been measured since the start or reset(). */
    [[nodiscard]] bool hasVelocity() const { return measured_ > 0; }

    /** Mean body velocity of the latest increment. */
    [[nodiscard]] const Vector6d& velocity() const { return velocity_; }

    void reset();

 private:
    TParams params_;
    Vector6d velocity_{Vector6d::Zero()};
    int measured_{0};     //!< increments in a row
    double coasting_{0};  //!< time since the latest measurement [s]
};
}  // namespace pointplane
