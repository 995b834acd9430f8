// SPDX-License-Identifier: BSD-3-Clause
#include "ErrorModel.h"

#include <pointplane/core/covariance.h>
#include <pointplane/odometry/uncertainty/camera_errors.h>
#include <pointplane/odometry/uncertainty/exposure_errors.h>
#include <pointplane/odometry/uncertainty/view_errors.h>

#include <cmath>

namespace pointplane
{
namespace
{
/** How large what the features of a frame err by together is, over what is propagated: as their
 * residuals are, and as the references contradict each other. The mean of points and planes, or
 * that of the only kind that the frame has. */
double commonLevel(const NoiseFactors& residuals, const NoiseFactors& levels, const Sensitivity& of)
{
    const double ofPoints = levels.points * residuals.points;
    const double ofPlanes = levels.planes * residuals.planes;
    const bool hasPoints = !of.points.isZero(0), hasPlanes = !of.planes.isZero(0);
    if (hasPoints != hasPlanes)
    {
        return hasPoints ? ofPoints : ofPlanes;
    }
    return (ofPoints + ofPlanes) / 2;
}

/** How alike the views of the references and of the frame are. */
JointCovariance::Views viewsOf(const ErrorModel::Measured& frame)
{
    JointCovariance::Views out;
    std::vector<Eigen::Isometry3d> poses;
    std::vector<double> stamps;
    for (const Reference* reference : frame.references)
    {
        out.frames.push_back(reference->id);
        poses.push_back(reference->T_world_cam);
        stamps.push_back(reference->stamp);
    }
    poses.push_back(poses.front() * frame.estimate.motion.mean.T_prev_cur);
    stamps.push_back(stamps.front() + frame.dt);
    const auto n = static_cast<Eigen::Index>(poses.size());
    out.correlation = Eigen::MatrixXd::Identity(n, n);
    for (size_t i = 0; i < poses.size(); ++i)
    {
        for (size_t k = 0; k < i; ++k)
        {
            const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(k);
            out.correlation(row, column) = out.correlation(column, row) =
                viewCorrelation(poses[i].inverse() * poses[k], stamps[i] - stamps[k]);
        }
    }
    return out;
}
}  // namespace

ErrorModel::ErrorModel(const OdometryParams& params)
    : params_(params.covariance),
      isJoint_(params.covariance.isJoint()),
      fuses_(params.pipeline.fuses()),
      noise_(params.noiseScale),
      camera_(params.shutter, params.lens)
{
}

CameraMatrix ErrorModel::changeCamera(const PinholeCamera& camera)
{
    camera_.start(camera);
    const CameraVector learnt = camera_.cov().diagonal();
    return calibrationVariances(params_, camera).cwiseMax(learnt).asDiagonal();
}

JointCovariance::Measurement ErrorModel::learn(const Measured& frame)
{
    noise_.update(frame.analysis, frame.dt);
    JointCovariance::Measurement out = errorsOf(frame);
    const CameraCalibrator::Change change =
        camera_.update(frame.analysis, frame.bend, noise_.overCautious());
    out.cameraGain = change.gain;
    out.cameraNoise = change.noise;
    return out;
}

JointCovariance::Measurement ErrorModel::errorsOf(const Measured& frame) const
{
    JointCovariance::Measurement out;
    if (!isJoint_)
    {
        out.prior.topLeftCorner<6, 6>().setIdentity();
        out.noise.topLeftCorner<6, 6>() = frame.estimate.pose().cov;
        return out;
    }
    const Sensitivity& of = frame.analysis.sensitivity;
    const NoiseFactors residuals = noise_.residuals();
    out.references = of.references;
    out.camera = of.camera;
    out.bendVariance = frame.bend * frame.bend;
    out.patches = of.patches;
    out.referencePatches = of.referencePatches;
    out.noise = params_.noise * noise_.ofFrame() *
                    (residuals.points * of.points + residuals.planes * of.planes) +
                accelerationWhileExposed(of, frame.shutter, frame.acceleration2);
    out.prior = of.prior;
    if (!fuses_)
    {
        out.prior.rightCols<6>().setZero();  // the velocity is a new one for each frame
    }
    out.priorNoise = params_.motion * propagate(of.prior, frame.motionNoise);
    const double level = noise_.ofFrame() * commonLevel(residuals, noise_.levels(), of);
    out.viewSigma = viewSigma(
        params_.viewSigma * std::sqrt(level),
        frame.estimate.infoPoints + frame.estimate.infoPlanes);
    out.views = viewsOf(frame);
    return out;
}
}  // namespace pointplane
