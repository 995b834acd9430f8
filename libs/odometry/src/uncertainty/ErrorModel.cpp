// SPDX-License-Identifier: BSD-3-Clause
#include "ErrorModel.h"

#include <pointplane/core/covariance.h>
#include <pointplane/odometry/uncertainty/ReferenceErrors.h>
#include <pointplane/odometry/uncertainty/exposure_errors.h>

#include <algorithm>
#include <cmath>

#include "views.h"

namespace pointplane
{
namespace
{
/** How fast what the features of a frame err by together grows with the view, over what is
 * propagated: as their residuals grow, and as the references contradict each other. The geometric
 * mean of points and planes, or that of the only kind that the frame has. */
double commonLevel(const NoiseFactors& noise, const NoiseFactors& drift, const Sensitivity& of)
{
    const double ofPoints = noise.points * drift.points, ofPlanes = noise.planes * drift.planes;
    const bool hasPoints = !of.points.isZero(0), hasPlanes = !of.planes.isZero(0);
    if (hasPoints != hasPlanes)
    {
        return hasPoints ? ofPoints : ofPlanes;
    }
    return std::sqrt(ofPoints * ofPlanes);
}
}  // namespace

ErrorModel::ErrorModel(const OdometryParams& params)
    : params_(params.covariance),
      isJoint_(params.covariance.isJoint()),
      fuses_(params.pipeline.fuses()),
      noise_(params.noiseScale),
      shutter_(params.shutter)
{
}

JointCovariance::Measurement ErrorModel::learn(const Measured& frame)
{
    const NoiseFactors usual = noise_.residuals();
    noise_.update(frame.analysis, frame.dt);
    if (isJoint_)
    {
        variogram_.update(
            frame.analysis,
            frame.references.front()->T_world_cam.linear(),
            numViews(frame.estimate.motion.mean.T_prev_cur),
            frame.dt,
            noise_.residuals());
    }
    JointCovariance::Measurement out = errorsOf(frame, usual);
    const ShutterCalibrator::Change shutter =
        shutter_.update(frame.analysis.camera, noise_.overCautious());
    out.cameraGain.bottomRightCorner<3, 3>() = shutter.gain;
    out.cameraNoise.bottomRightCorner<3, 3>() = shutter.noise;
    return out;
}

/** \param usual variance of the residuals in the frames before */
JointCovariance::Measurement ErrorModel::errorsOf(
    const Measured& frame, const NoiseFactors& usual) const
{
    JointCovariance::Measurement out;
    if (!isJoint_)
    {
        out.prior.topLeftCorner<6, 6>().setIdentity();
        out.noise.topLeftCorner<6, 6>() = frame.estimate.pose().cov;
        return out;
    }
    const Sensitivity& of = frame.analysis.sensitivity;
    const NoiseFactors white = variogram_.levels().white;
    // A frame whose residuals are larger than usual is blurred, or not where it should be.
    const double ofPoints = std::max(1.0, frame.analysis.pointVariance / usual.points);
    const double ofPlanes = std::max(1.0, frame.analysis.planeVariance / usual.planes);
    out.references = of.references;
    out.camera = of.camera;
    out.noise = params_.noise *
                    (ofPoints * white.points * of.points + ofPlanes * white.planes * of.planes) +
                accelerationWhileExposed(of, frame.shutter, frame.acceleration2);
    out.prior = of.prior;
    if (!fuses_)
    {
        out.prior.rightCols<6>().setZero();  // the velocity is a new one for each frame
    }
    out.priorNoise = params_.motion * propagate(of.prior, frame.motionNoise);
    drift(frame, out);
    return out;
}

/** What the references err by, seen from the current frame rather than from the previous one. */
void ErrorModel::drift(const Measured& frame, JointCovariance::Measurement& out) const
{
    const double level =
        commonLevel(noise_.levels(), variogram_.levels().drift, frame.analysis.sensitivity);
    out.drift = driftPerView(
        params_.driftSigma * std::sqrt(level),
        frame.estimate.infoPoints + frame.estimate.infoPlanes);
    const Reference& previous = *frame.references.front();
    const Eigen::Isometry3d& T_prev_cur = frame.estimate.motion.mean.T_prev_cur;
    for (const Reference* reference : frame.references)
    {
        const Eigen::Isometry3d T_ref_prev =
            reference->T_world_cam.inverse() * previous.T_world_cam;
        const double age = previous.stamp - reference->stamp;
        out.steps[reference->id] = driftStep(
            viewsBetween(T_ref_prev, age),
            viewsBetween(T_ref_prev * T_prev_cur, age + frame.dt),
            viewsBetween(T_prev_cur, frame.dt));
    }
}
}  // namespace pointplane
