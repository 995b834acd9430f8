// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/significance.h>
#include <pointplane/odometry/uncertainty/CalibrationCheck.h>

#include <Eigen/LU>

#include <cmath>

#include "camera_errors.h"

namespace pointplane
{
void CalibrationCheck::start(const PinholeCamera& camera, const CameraVector& calibration)
{
    PinholeCamera calibrated = camera, nominal = camera;
    calibrated.isNominal = false;
    nominal.isNominal = true;
    nominal_ = lensVariances(nominal, 0);
    // Rays are turned by k1 r^2, as much as by a focal length that is wrong.
    calibration_ = calibration + lensVariances(calibrated, std::sqrt(calibration[kFocalLength]));
    sum_ = {};
}

void CalibrationCheck::add(const CameraInformation& frame, const CameraVector& corrected)
{
    sum_.information += frame.information;
    sum_.gradient += frame.gradient - frame.information * corrected;
}

CameraMatrix CalibrationCheck::cov() const
{
    const CameraMatrix prior = nominal_.asDiagonal();
    return (CameraMatrix::Identity() + prior * sum_.information).inverse() * prior;
}

bool CalibrationCheck::isContradicted(const CameraVector& others) const
{
    const CameraVector variances = CameraVector(cov().diagonal()) + calibration_ + others;
    return (errors().array().square() > kNoChanceSigmas * kNoChanceSigmas * variances.array())
        .any();
}
}  // namespace pointplane
