// SPDX-License-Identifier: BSD-3-Clause
#include "ErrorModel.h"

#include <pointplane/core/covariance.h>
#include <pointplane/odometry/uncertainty/exposure_errors.h>
#include <pointplane/odometry/uncertainty/view_errors.h>

#include <algorithm>
#include <cmath>

#include "views.h"

namespace pointplane
{
namespace
{
/** How large what the features of a frame err by together is, over what is propagated: as their
 * residuals grow with the view, and as the references contradict each other. The geometric mean of
 * points and planes, or that of the only kind that the frame has. */
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
    out.bendVariance = frame.bend * frame.bend;
    out.patches = of.patches;
    out.referencePatches = of.referencePatches;
    out.noise = params_.noise *
                    (ofPoints * white.points * of.points + ofPlanes * white.planes * of.planes) +
                accelerationWhileExposed(of, frame.shutter, frame.acceleration2);
    out.prior = of.prior;
    if (!fuses_)
    {
        out.prior.rightCols<6>().setZero();  // the velocity is a new one for each frame
    }
    out.priorNoise = params_.motion * propagate(of.prior, frame.motionNoise);
    errorsByView(frame, out);
    return out;
}

void ErrorModel::errorsByView(const Measured& frame, JointCovariance::Measurement& out) const
{
    const double level =
        commonLevel(noise_.levels(), variogram_.levels().drift, frame.analysis.sensitivity);
    out.viewSigma = viewSigma(
        params_.viewSigma * std::sqrt(level),
        frame.estimate.infoPoints + frame.estimate.infoPlanes);

    struct View
    {
        Eigen::Isometry3d T_world_cam;
        double stamp;
    };
    std::vector<View> views;
    for (const Reference* reference : frame.references)
    {
        out.views.frames.push_back(reference->id);
        views.push_back({reference->T_world_cam, reference->stamp});
    }
    const View& previous = views.front();
    views.push_back(
        {previous.T_world_cam * frame.estimate.motion.mean.T_prev_cur, previous.stamp + frame.dt});

    const auto n = static_cast<Eigen::Index>(views.size());
    out.views.correlation.resize(n, n);
    for (Eigen::Index i = 0; i < n; ++i)
    {
        for (Eigen::Index k = 0; k < n; ++k)
        {
            const View &a = views[static_cast<size_t>(i)], &b = views[static_cast<size_t>(k)];
            out.views.correlation(i, k) =
                viewCorrelation(a.T_world_cam.inverse() * b.T_world_cam, a.stamp - b.stamp);
        }
    }
}
}  // namespace pointplane
