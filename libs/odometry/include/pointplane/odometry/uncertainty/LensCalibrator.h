// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/odometry/OdometryResult.h>
#include <pointplane/odometry/uncertainty/camera_errors.h>
#include <pointplane/pose/PoseAnalysis.h>

#include <optional>

namespace pointplane
{
/** Learns what nobody has calibrated of a lens, from the camera's own motion: focal length and
 * principal point if they are nominal; radial distortion, also of cameras whose depth is bent,
 * which looks alike.
 *
 * With a wrong lens, the points that two views show do not lie to each other alike. What the
 * residuals say of that, by each reference alone (PoseAnalysis::cameraByReference), is summed over
 * frames. Features are then corrected to first order; the images are not. Derivation:
 * docs/theory.md, Lens. */
class LensCalibrator
{
 public:
    struct TParams
    {
        bool nominal{false};
        bool selfCalibrate{true};

        template <class V>
        void visit(V&& v)
        {
            v("nominal",
              nominal,
              "-",
              "nobody calibrated this very camera, even if the recording does not say so");
            v("selfCalibrate",
              selfCalibrate,
              "-",
              "learn all intrinsics if they are nominal, and radial distortion if depth is bent");
        }
        void check() const {}
    };

    /** \param varianceFactor this many frames teach as much as one
     * (ShutterCalibrator::TParams::varianceFactor) */
    explicit LensCalibrator(const TParams& params, double varianceFactor = 10)
        : params_(params), varianceFactor_(varianceFactor)
    {
    }

    /** What the calibration of this camera errs by, as learnt so far; zero for a new camera. */
    [[nodiscard]] CameraVector errors(const PinholeCamera& camera) const;

    /** The same for users, with standard deviations. */
    [[nodiscard]] LearntLens learnt(const PinholeCamera& camera) const;

    /** How the error of the estimate changes with a frame: it is gain times the one before, plus
     * noise. */
    struct Change
    {
        LensMatrix gain{LensMatrix::Identity()};
        LensMatrix noise{LensMatrix::Zero()};  //!< its covariance
    };

    /** Learns from a measured frame.
     * \param bend smooth error of depth, as a fraction of it
     * \param variance of its features, over the one by which the solver weighed them */
    Change update(
        const CameraInformation& byReference,
        const PinholeCamera& camera,
        double bend,
        double variance = 1);

 private:
    [[nodiscard]] bool isLearnt(const PinholeCamera& camera) const;

    TParams params_;
    double varianceFactor_;
    std::optional<PinholeCamera> camera_;
    LensVector prior_{LensVector::Zero()}, estimate_{LensVector::Zero()};
    LensMatrix cov_{LensMatrix::Zero()};
};
}  // namespace pointplane
