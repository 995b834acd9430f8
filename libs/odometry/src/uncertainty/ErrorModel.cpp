// SPDX-License-Identifier: BSD-3-Clause
#include "ErrorModel.h"

#include <pointplane/core/covariance.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "camera_errors.h"
#include "exposure_errors.h"
#include "view_errors.h"

namespace pointplane
{
namespace
{
/** How alike the views of the references and of the frame are. */
JointCovariance::Views viewsOf(const ErrorModel::Measured& frame, double distance, double viewAngle)
{
    JointCovariance::Views out;
    std::vector<Eigen::Isometry3d> poses;
    for (const Reference* reference : frame.references)
    {
        out.frames.push_back(reference->id);
        poses.push_back(reference->T_world_cam);
    }
    poses.push_back(poses.front() * frame.estimate.motion.mean.T_prev_cur);
    const auto n = static_cast<Eigen::Index>(poses.size());
    out.ofPoints = out.ofPlanes = Eigen::MatrixXd::Identity(n, n);
    for (size_t i = 0; i < poses.size(); ++i)
    {
        for (size_t k = 0; k < i; ++k)
        {
            const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(k);
            const Eigen::Isometry3d motion = poses[i].inverse() * poses[k];
            out.ofPoints(row, column) = out.ofPoints(column, row) =
                viewCorrelation(motion, distance, viewAngle);
            out.ofPlanes(row, column) = out.ofPlanes(column, row) =
                planeViewCorrelation(motion, distance, viewAngle);
        }
    }
    return out;
}

/** Angle of view [rad], of the geometric mean of both sides of the image. */
double viewAngle(const PinholeCamera& camera)
{
    const double area = camera.width / camera.fx * (camera.height / camera.fy);
    return 2 * std::atan(std::sqrt(std::abs(area)) / 2);
}

double distanceOf(const ErrorModel::Measured& frame)
{
    return featureDistance(frame.estimate.infoPoints + frame.estimate.infoPlanes);
}

/** Variance of s (the scale of depth in a patch) that is expected to be new in each image. As much
 * is expected to be the view's. */
double expectedBend(const ErrorModel::Measured& frame) { return frame.bend * frame.bend / 2; }

std::vector<ReferenceVariance> overExpectedBend(const ErrorModel::Measured& frame)
{
    std::vector<ReferenceVariance> out = frame.analysis.patchResiduals;
    for (ReferenceVariance& of : out)
    {
        of.variance /= expectedBend(frame);
    }
    return out;
}

/** The symmetric R with R R^T = S. */
Matrix6d rootOf(const Matrix6d& S)
{
    const Eigen::SelfAdjointEigenSolver<Matrix6d> es(S);
    return es.eigenvectors() * es.eigenvalues().cwiseMax(0).cwiseSqrt().asDiagonal() *
           es.eigenvectors().transpose();
}
}  // namespace

ErrorModel::ErrorModel(const OdometryParams& params)
    : params_(params.covariance),
      noiseParams_(params.noiseScale),
      isJoint_(params.covariance.isJoint()),
      fuses_(params.pipeline.fuses()),
      noise_(params.noiseScale),
      planes_(params.noiseScale.timeConstant),
      patches_(params.noiseScale.timeConstant),
      camera_(params.shutter, params.lens)
{
}

CameraMatrix ErrorModel::changeCamera(const PinholeCamera& camera)
{
    noise_ = NoiseScale(noiseParams_);
    planes_ = patches_ = ErrorsByView(noiseParams_.timeConstant);
    const CameraVector calibration = calibrationVariances(params_, camera);
    camera_.start(camera, calibration);
    viewAngle_ = viewAngle(camera);
    const CameraVector learnt = camera_.cov().diagonal();
    return calibration.cwiseMax(learnt).asDiagonal();
}

JointCovariance::Measurement ErrorModel::learn(const Measured& frame)
{
    JointCovariance::Views views = viewsOf(frame, distanceOf(frame), viewAngle_);
    std::map<int, double> correlation;  // of zeta and zeta_r, by the id of r
    for (size_t k = 0; k < views.frames.size(); ++k)
    {
        correlation[views.frames[k]] = views.ofPlanes.rightCols<1>()[static_cast<Eigen::Index>(k)];
    }
    const bool isMinimum = !frame.doubt;  // else residuals of its pairs do not tell their noise
    noise_.update(frame.analysis, frame.dt, isMinimum);
    if (noiseParams_.adaptive && isMinimum)
    {
        const PlaneResiduals& ofPlanes = frame.analysis.planeResiduals;
        planes_.update(ofPlanes.references, correlation, frame.dt, ofPlanes.followed);
        patches_.update(overExpectedBend(frame), correlation, frame.dt);
    }
    views.ofPatches = patches_.byView() * views.ofPlanes;
    views.ofPatches.diagonal().array() += patches_.own();
    views.ofPatches /= patches_.own() + patches_.byView();
    JointCovariance::Measurement out = errorsOf(frame, std::move(views));
    if (isMinimum)
    {
        out.camera = camera_.update(
            frame.analysis, frame.bend, noise_.overCautious(), timesByVelocities(frame));
    }
    return out;
}

JointCovariance::Measurement ErrorModel::errorsOf(
    const Measured& frame, JointCovariance::Views views) const
{
    JointCovariance::Measurement out;
    out.views = std::move(views);
    const Matrix6d doubt = frame.doubt.value_or(Matrix6d::Zero());
    if (!isJoint_)
    {
        // Each increment errs by itself: its error adds to that of the previous pose.
        out.factors.prior.topLeftCorner<6, 6>().setIdentity();
        out.noise.topLeftCorner<6, 6>() = frame.estimate.pose().cov + doubt;
        return out;
    }
    const Sensitivity& of = frame.analysis.sensitivity;
    const NoiseScale::TypicalPoints points = noise_.typicalPoints();
    const ShutterModel shutter = camera_.rootMeanSquare(frame.shutter);
    out.factors = of;
    if (!fuses_)
    {
        out.factors.prior.rightCols<6>().setZero();  // the velocity is a new one for each frame
    }
    out.noise = noise_.ofFrame() *
                    (params_.noise * points.residuals * of.points + planes_.own() * of.planes) +
                accelerationWhileExposed(of, shutter, frame.acceleration2);
    out.noise.topLeftCorner<6, 6>() += doubt;
    out.noise += propagate(of.prior, frame.motionNoise);
    if (!of.points.isZero(0))
    {
        out.views.pointSigma = viewSigma(commonAngle(), distanceOf(frame), shutter);
    }
    out.views.planeRoot = rootOf(planes_.byView() * Matrix6d(of.planes.topLeftCorner<6, 6>()));
    out.views.patchSigma = std::sqrt(expectedBend(frame) * (patches_.own() + patches_.byView()));
    return out;
}

Eigen::Matrix3d ErrorModel::timesByVelocities(const Measured& frame) const
{
    Eigen::Matrix3d out = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 6> all = Eigen::Matrix<double, 3, 6>::Zero();
    for (const auto& [reference, change] : frame.analysis.cameraByVelocity)
    {
        const Eigen::Matrix<double, 3, 6> ofTimes = change.bottomRows<3>();
        all += ofTimes;
        if (const auto cov = frame.velocities.find(reference); cov != frame.velocities.end())
        {
            out += propagate(ofTimes, cov->second);
        }
    }
    if (!camera_.knowsDirection())
    {
        // The frame's own features move as those of all references do, the other way. Once the
        // readouts are known, the solution follows its velocity.
        out += propagate(all, Matrix6d(frame.estimate.motion.cov.bottomRightCorner<6, 6>()));
    }
    return out;
}

double ErrorModel::commonAngle() const
{
    const NoiseScale::TypicalPoints points = noise_.typicalPoints();
    const double unexplained = std::max(0.0, points.disagreement - params_.noise);
    return params_.viewNoise *
           std::sqrt(noise_.ofFrame() * points.residuals * unexplained * points.turnVariance);
}
}  // namespace pointplane
