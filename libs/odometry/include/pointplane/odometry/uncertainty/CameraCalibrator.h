// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/odometry/OdometryResult.h>
#include <pointplane/odometry/uncertainty/CalibrationCheck.h>
#include <pointplane/pose/PoseAnalysis.h>
#include <pointplane/sensor/RgbdFrame.h>

namespace pointplane
{
/** Learns what nobody has calibrated of a camera, from its own motion: the times of its shutter;
 * focal length and principal point if they are nominal; radial distortion, also of cameras whose
 * depth is bent, which looks alike. Intrinsics that do not fit the images are taken for nominal
 * (CalibrationCheck).
 *
 * Errors of the camera are constants with a Gaussian prior. The residuals at the estimated pose
 * depend on them. The motion is eliminated from what they tell (Schur complement,
 * CameraInformation), and the rest is summed over frames as in an information filter. Features are
 * then corrected to first order; the images are not.
 *
 * Of images that were turned, the last row may be exposed first. Until that is known, the readout
 * is taken for zero, with an error of its own size: motions that are corrected in the wrong
 * direction agree with that direction.
 *
 * Derivation: docs/theory.md, Learning the camera. */
class CameraCalibrator
{
 public:
    struct TShutter
    {
        bool correct{true};
        double readoutColour{0.02};
        double readoutDepth{0.02};
        double depthDelay{0};
        bool selfCalibrate{true};
        bool findDirection{false};
        double sigmaPrior{0.01};
        double varianceFactor{10.0};

        template <class V>
        void visit(V&& v)
        {
            v("correct",
              correct,
              "-",
              "correct for the camera's motion while it takes an image, row by row; false: all "
              "rows count as taken at once, whatever the recording says (as in the paper)");
            v("readoutColour",
              readoutColour,
              "s",
              "time from the first to the last row of the colour image, if the recording does "
              "not say (in upright images: column)");
            v("readoutDepth", readoutDepth, "s", "the same of the depth image");
            v("depthDelay",
              depthDelay,
              "s",
              "time from the exposure of colour to that of depth, on top of what the "
              "recording's time stamps say");
            v("selfCalibrate",
              selfCalibrate,
              "-",
              "learn from the camera's motion what the recording does not say");
            v("findDirection",
              findDirection,
              "-",
              "true: the images were turned, so learn also whether the first or the last row is "
              "exposed first; always so if they are upright");
            v("sigmaPrior",
              sigmaPrior,
              "s",
              "how uncertain the three times above are at first (standard deviation)");
            v("varianceFactor",
              varianceFactor,
              "-",
              "this many frames count as one when shutter and lens are learnt, because "
              "neighbouring frames have the same errors");
        }
        /** \throws std::invalid_argument naming the key */
        void check() const;
    };

    struct TLens
    {
        bool nominal{false};
        bool selfCalibrate{true};

        template <class V>
        void visit(V&& v)
        {
            v("nominal",
              nominal,
              "-",
              "true: the intrinsics are nominal (nobody calibrated this very camera), even if the "
              "recording does not say so");
            v("selfCalibrate",
              selfCalibrate,
              "-",
              "learn all intrinsics if they are nominal or do not fit the images, and radial "
              "distortion if depth is bent");
        }
        void check() const {}
    };

    /** \throws std::invalid_argument naming the key */
    CameraCalibrator(const TShutter& shutter, const TLens& lens);

    /** From here on, frames are those of this camera, of which nothing is learnt yet.
     * \param calibration variances of what is stated of it (calibrationVariances()) */
    void start(const PinholeCamera& camera, const CameraVector& calibration);

    /** How the error of the estimate changes with a frame: it is gain times the one before, plus
     * noise. */
    struct Change
    {
        CameraMatrix gain{CameraMatrix::Identity()};
        CameraMatrix noise{CameraMatrix::Zero()};  //!< its covariance
    };

    /** Learns from a measured frame: of the shutter by all references together
     * (PoseAnalysis::camera), of the lens by each alone (PoseAnalysis::cameraByReference).
     * \param bend smooth error of depth, as a fraction of it (DepthNoise::sigmaRelative)
     * \param variance of its features, over the one by which the solver weighed them
     * \param byVelocities covariance that errors of the velocities add to the gradient for the
     * times of the shutter: a wrong velocity looks like a wrong time */
    Change update(
        const PoseAnalysis& frame,
        double bend,
        double variance,
        const Eigen::Matrix3d& byVelocities);

    /** What the true camera has more than recording and parameters say, in the order and units of
     * CameraError. Zero where it is not learnt, as vignetting and the scale of depth. */
    [[nodiscard]] const CameraVector& errors() const { return errors_; }

    /** Their covariance; zero where nothing is to be learnt. */
    [[nodiscard]] const CameraMatrix& cov() const { return cov_; }

    /** The lens's errors, for users. */
    [[nodiscard]] LearntLens lens() const;

    /** The source's values where it knows them, else the estimate [s]. A delay that comes from time
     * stamps is a part of the true one: the estimate is added. All zero if `correct` is off. */
    [[nodiscard]] ShutterModel complete(const ShutterModel& source) const;

    /** complete(), but with the root mean square of each time that is estimated, by its mean and
     * its variance: a time that may be long moves features, even if its mean is zero. */
    [[nodiscard]] ShutterModel rootMeanSquare(const ShutterModel& source) const;

    /** Whether it is known which of the rows is exposed first. */
    [[nodiscard]] bool knowsDirection() const { return knowsDirection_; }

    /** 1 for each of the three times that is estimated, 0 for each that the source knows. */
    [[nodiscard]] static Eigen::Vector3d estimated(const ShutterModel& source);

    /** How far the times of a source that does not know them may be off [s]. */
    [[nodiscard]] double sigmaPrior() const { return shutter_.sigmaPrior; }

 private:
    [[nodiscard]] CameraVector priorVariances(double bend) const;
    [[nodiscard]] bool isDirectionTold() const;
    [[nodiscard]] double directionOfReadout() const;
    void believe(double direction, Change& change);
    void checkCalibration(const CameraInformation& learnt);

    TShutter shutter_;
    TLens lens_;
    PinholeCamera camera_;
    CameraVector prior_{CameraVector::Zero()}, errors_{CameraVector::Zero()};
    CameraMatrix cov_{CameraMatrix::Zero()};
    CalibrationCheck check_;
    bool isContradicted_{false};  //!< by check_
    bool knowsDirection_{true};   //!< whether the first or the last row is exposed first
};
}  // namespace pointplane
