// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/core/range.h>
#include <pointplane/core/significance.h>
#include <pointplane/odometry/uncertainty/CameraCalibrator.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "camera_errors.h"

namespace pointplane
{
namespace
{
constexpr int kNumLensErrors = kDepthScale - kPrincipalPointX;

/** Limit of the keys: longer readouts and delays are not learnt, either [s]. */
constexpr double kMaxTime = 0.05;

/** Who knows the readouts knows when images are exposed. Otherwise the delay comes from time
 * stamps, which tell when they arrived. */
bool tellsExposure(const ShutterModel& source)
{
    return std::isfinite(source.readoutColour) && std::isfinite(source.readoutDepth) &&
           std::isfinite(source.depthDelay);
}

Eigen::Vector3d timesOf(const CameraCalibrator::TShutter& shutter)
{
    return {shutter.readoutColour, shutter.readoutDepth, shutter.depthDelay};
}

/** What a frame says, over the variance of its residuals; of the times, also over what errors of
 * the velocities do to them. */
CameraInformation weighed(
    const PoseAnalysis& frame, double factor, const Eigen::Matrix3d& byVelocities)
{
    CameraInformation learnt;
    const CameraInformation& ofLens = frame.cameraByReference;
    learnt.information.block<kNumLensErrors, kNumLensErrors>(kPrincipalPointX, kPrincipalPointX) =
        ofLens.information.block<kNumLensErrors, kNumLensErrors>(
            kPrincipalPointX, kPrincipalPointX) /
        factor;
    learnt.gradient.segment<kNumLensErrors>(kPrincipalPointX) =
        ofLens.gradient.segment<kNumLensErrors>(kPrincipalPointX) / factor;
    // Its gradient has the covariance factor * ofTimes + byVelocities, not ofTimes.
    const Eigen::Matrix3d ofTimes = frame.camera.information.bottomRightCorner<3, 3>();
    const Eigen::Matrix3d weight =
        (factor * Eigen::Matrix3d::Identity() +
         byVelocities * ofTimes.completeOrthogonalDecomposition().pseudoInverse())
            .inverse();
    const Eigen::Matrix3d information = weight * ofTimes;
    learnt.information.bottomRightCorner<3, 3>() = 0.5 * (information + information.transpose());
    learnt.gradient.tail<3>() = weight * frame.camera.gradient.tail<3>();
    return learnt;
}
}  // namespace

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

void CameraCalibrator::TShutter::check() const
{
    checkRange("readoutColour", readoutColour, -kMaxTime, kMaxTime);
    checkRange("readoutDepth", readoutDepth, -kMaxTime, kMaxTime);
    checkRange("depthDelay", depthDelay, -kMaxTime, kMaxTime);
    checkRange("sigmaPrior", sigmaPrior, 1e-5, kMaxTime);
    checkRange("varianceFactor", varianceFactor, 0.01, 1000);
}

CameraCalibrator::CameraCalibrator(const TShutter& shutter, const TLens& lens)
    : shutter_(shutter), lens_(lens)
{
    shutter_.check();
}

void CameraCalibrator::start(const PinholeCamera& camera, const CameraVector& calibration)
{
    camera_ = camera;
    check_.start(camera, calibration);
    isContradicted_ = false;
    knowsDirection_ = isDirectionTold();
    prior_ = priorVariances(0);
    cov_ = prior_.asDiagonal();
    errors_.setZero();
    if (!knowsDirection_)
    {
        errors_.segment<2>(kReadoutColour) = -timesOf(shutter_).head<2>();
    }
}

/** Or not to be learnt. Who turns images upright may turn them to either side. */
bool CameraCalibrator::isDirectionTold() const
{
    const bool isTurned = shutter_.findDirection || camera_.height > camera_.width;
    return !isTurned || !shutter_.correct || !shutter_.selfCalibrate ||
           timesOf(shutter_).head<2>().isZero(0);
}

/** Of what is to be learnt. What is exact, or only considered, has no variance and stays as it is.
 */
CameraVector CameraCalibrator::priorVariances(double bend) const
{
    CameraVector out = CameraVector::Zero();
    if (lens_.selfCalibrate)
    {
        out = lensVariances(camera_, bend);
    }
    if (shutter_.correct && shutter_.selfCalibrate)
    {
        out.tail<3>().setConstant(sigmaPrior() * sigmaPrior());
        if (!knowsDirection_)
        {
            out.segment<2>(kReadoutColour) += timesOf(shutter_).head<2>().cwiseAbs2();
        }
    }
    return out;
}

CameraCalibrator::Change CameraCalibrator::update(
    const PoseAnalysis& frame, double bend, double variance, const Eigen::Matrix3d& byVelocities)
{
    // The kind of depth camera shows in its images only.
    const CameraVector prior = prior_.cwiseMax(priorVariances(bend));
    const CameraMatrix widening = CameraVector(prior - prior_).asDiagonal();
    prior_ = prior;
    // Frames repeat each other's residuals: each counts as a fraction of one.
    const double factor = shutter_.varianceFactor * variance;
    const CameraInformation learnt = weighed(frame, factor, byVelocities);
    checkCalibration(learnt);
    Change out;
    const CameraMatrix before = cov_ + widening;
    out.gain = (CameraMatrix::Identity() + before * learnt.information).inverse();
    cov_ = out.gain * before;
    cov_ = (0.5 * (cov_ + cov_.transpose())).eval();
    errors_ -= cov_ * learnt.gradient;
    const Eigen::Vector3d told = timesOf(shutter_);
    auto ofShutter = errors_.tail<3>();
    ofShutter = (told + ofShutter).cwiseMax(-kMaxTime).cwiseMin(kMaxTime) - told;
    out.noise = propagate(cov_, learnt.information) + out.gain * widening * out.gain.transpose();
    if (const double direction = knowsDirection_ ? 0 : directionOfReadout(); direction != 0)
    {
        believe(direction, out);
    }
    return out;
}

/** \return 1 if the first row is exposed first, -1 if the last is, 0 if it cannot be told */
double CameraCalibrator::directionOfReadout() const
{
    const Eigen::Vector2d readouts =
        timesOf(shutter_).head<2>() + errors_.segment<2>(kReadoutColour);
    const Eigen::Vector2d sigmas = cov_.diagonal().segment<2>(kReadoutColour).cwiseSqrt();
    for (const int image : {0, 1})
    {
        if (std::abs(readouts[image]) > kNoChanceSigmas * sigmas[image])
        {
            return std::copysign(1.0, readouts[image]);
        }
    }
    return 0;
}

/** Learns the times anew, with a prior that knows the direction: what was learnt without it tells
 * the sign, but makes readouts too short (docs/theory.md, Learning the camera). */
void CameraCalibrator::believe(double direction, Change& change)
{
    const Eigen::Vector2d told = timesOf(shutter_).head<2>();
    knowsDirection_ = true;
    errors_.tail<3>() << direction * told.cwiseAbs() - told, 0;
    const Eigen::Vector3d variances = priorVariances(0).tail<3>();
    prior_.tail<3>() = variances;
    change.gain.bottomRows<3>().setZero();
    for (CameraMatrix* cov : {&cov_, &change.noise})
    {
        cov->bottomRows<3>().setZero();
        cov->rightCols<3>().setZero();
        cov->diagonal().tail<3>() = variances;
    }
}

/** A calibration that does not fit is nominal from the next frame on. The lens is learnt anew then:
 * what frames told under the wrong lens makes its errors too small. */
void CameraCalibrator::checkCalibration(const CameraInformation& learnt)
{
    if (camera_.isNominal || !lens_.selfCalibrate)
    {
        return;
    }
    check_.add(learnt, errors_);
    isContradicted_ = check_.isContradicted(prior_);
    camera_.isNominal = isContradicted_;
}

LearntLens CameraCalibrator::lens() const
{
    return {
        errors_.segment<kNumLensErrors>(kPrincipalPointX),
        cov_.diagonal().segment<kNumLensErrors>(kPrincipalPointX).cwiseSqrt(),
        isContradicted_};
}

ShutterModel CameraCalibrator::complete(const ShutterModel& source) const
{
    if (!shutter_.correct)
    {
        return {0, 0, 0};  // [P17] says nothing of it
    }
    const auto known = [](double a, double b) { return std::isfinite(a) ? a : b; };
    const Eigen::Vector3d estimate = timesOf(shutter_) + errors_.tail<3>();
    return {
        known(source.readoutColour, estimate[0]),
        known(source.readoutDepth, estimate[1]),
        known(source.depthDelay, 0) + (tellsExposure(source) ? 0 : estimate[2])};
}

ShutterModel CameraCalibrator::rootMeanSquare(const ShutterModel& source) const
{
    const ShutterModel mean = complete(source);
    const Eigen::Vector3d variances =
        estimated(source).cwiseProduct(cov_.diagonal().tail<3>().eval());
    const auto rms = [](double time, double variance)
    { return std::copysign(std::sqrt(time * time + variance), time); };
    return {
        rms(mean.readoutColour, variances[0]),
        rms(mean.readoutDepth, variances[1]),
        rms(mean.depthDelay, variances[2])};
}

Eigen::Vector3d CameraCalibrator::estimated(const ShutterModel& source)
{
    return {
        std::isfinite(source.readoutColour) ? 0.0 : 1.0,
        std::isfinite(source.readoutDepth) ? 0.0 : 1.0,
        tellsExposure(source) ? 0.0 : 1.0};
}

}  // namespace pointplane
