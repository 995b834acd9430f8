// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/pose/PoseAnalysis.h>
#include <pointplane/sensor/PinholeCamera.h>

namespace pointplane
{
/** Hypothesis test: are the intrinsics that a recording states those of its camera?
 *
 * Each frame tells how far the lens is off, as it does for nominal intrinsics. The information of
 * all frames is summed. The errors that it shows are compared with those that a calibration may
 * have. Derivation: docs/theory.md, Learning the camera. */
class CalibrationCheck
{
 public:
    /** For another camera.
     * \param calibration variances of what is stated of it (calibrationVariances()) */
    void start(const PinholeCamera& camera, const CameraVector& calibration);

    /** Adds what a frame tells. \param corrected errors of the camera that its features have been
     * corrected by */
    void add(const CameraInformation& frame, const CameraVector& corrected);

    /** \param others variances of what is not stated of the lens, like that of bent depth */
    [[nodiscard]] bool isContradicted(const CameraVector& others) const;

    /** Estimate of the lens's errors, had its intrinsics been nominal; others zero. */
    [[nodiscard]] CameraVector errors() const { return -cov() * sum_.gradient; }
    [[nodiscard]] CameraMatrix cov() const;

 private:
    CameraVector nominal_{CameraVector::Zero()};      //!< variances
    CameraVector calibration_{CameraVector::Zero()};  //!< variances
    CameraInformation sum_;
};
}  // namespace pointplane
