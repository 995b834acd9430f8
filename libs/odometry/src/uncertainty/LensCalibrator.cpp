// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/uncertainty/LensCalibrator.h>

#include <Eigen/LU>

#include <iomanip>
#include <sstream>

#include "../frame_checks.h"

namespace pointplane
{
std::string describe(const LearntLens& lens)
{
    std::ostringstream out;
    const auto add = [&](const char* name, int k, double factor, int digits, const char* unit)
    {
        if (lens.sigmas[k] > 0)
        {
            out << (out.tellp() > 0 ? ", " : "") << name << std::setprecision(digits)
                << std::showpos << factor * lens.errors[k] << std::noshowpos << " +- "
                << factor * lens.sigmas[k] << unit;
        }
    };
    out << std::fixed;
    add("focal length ", 2, 100, 2, " %");
    add("principal point x ", 0, 1, 1, " px");
    add("y ", 1, 1, 1, " px");
    add("radial distortion ", 3, 1, 4, "");
    return out.str();
}

CameraVector LensCalibrator::errors(const PinholeCamera& camera) const
{
    CameraVector out = CameraVector::Zero();
    out.segment<kNumLensErrors>(kPrincipalPointX) = learnt(camera).errors;
    return out;
}

LearntLens LensCalibrator::learnt(const PinholeCamera& camera) const
{
    return isLearnt(camera) ? LearntLens{estimate_, cov_.diagonal().cwiseSqrt()} : LearntLens();
}

bool LensCalibrator::isLearnt(const PinholeCamera& camera) const
{
    return camera_ && sameCamera(*camera_, camera);
}

LensCalibrator::Change LensCalibrator::update(
    const CameraInformation& byReference, const PinholeCamera& camera, double bend, double variance)
{
    Change out;
    if (!params_.selfCalibrate)
    {
        return out;
    }
    if (!isLearnt(camera))
    {
        camera_ = camera;
        prior_ = lensVariances(camera, 0);
        cov_ = prior_.asDiagonal();
        estimate_.setZero();
    }
    // The kind of depth camera shows in its images only.
    const LensVector prior = prior_.cwiseMax(lensVariances(camera, bend));
    const LensMatrix widening = LensVector(prior - prior_).asDiagonal();
    prior_ = prior;
    // Frames repeat each other's residuals: each counts as a fraction of one.
    const double factor = varianceFactor_ * variance;
    const LensMatrix information = byReference.information.block<kNumLensErrors, kNumLensErrors>(
                                       kPrincipalPointX, kPrincipalPointX) /
                                   factor;
    const LensVector gradient =
        byReference.gradient.segment<kNumLensErrors>(kPrincipalPointX) / factor;
    // What is exact has no variance and stays as it is.
    const LensMatrix before = cov_ + widening;
    out.gain = (LensMatrix::Identity() + before * information).inverse();
    cov_ = out.gain * before;
    cov_ = (0.5 * (cov_ + cov_.transpose())).eval();
    estimate_ -= cov_ * gradient;
    out.noise = cov_ * information * cov_ + out.gain * widening * out.gain.transpose();
    return out;
}
}  // namespace pointplane
