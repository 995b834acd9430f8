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
        double varianceFactor{10.0};

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
              "learn from the camera's motion what nobody calibrated: nominal focal length and "
              "principal point; radial distortion of these cameras, and of those whose depth is "
              "bent");
            v("varianceFactor",
              varianceFactor,
              "-",
              "this many frames teach as much as one, because neighbouring frames have the same "
              "errors");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    /** \throws std::invalid_argument naming the key */
    explicit LensCalibrator(const TParams& params);

    /** What the calibration of this camera errs by, as learnt so far; zero for a new camera. */
    [[nodiscard]] CameraVector errors(const PinholeCamera& camera) const;

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

    /** The same with standard deviations. */
    [[nodiscard]] LearntLens learnt(const PinholeCamera& camera) const;

 private:
    [[nodiscard]] bool isLearnt(const PinholeCamera& camera) const;

    TParams params_;
    std::optional<PinholeCamera> camera_;
    LensVector prior_{LensVector::Zero()}, estimate_{LensVector::Zero()};
    LensMatrix cov_{LensMatrix::Zero()};
};
}  // namespace pointplane
