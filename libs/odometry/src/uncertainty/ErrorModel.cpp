// SPDX-License-Identifier: BSD-3-Clause
#include "ErrorModel.h"

#include <pointplane/core/covariance.h>

#include "frame_errors.h"
#include "views.h"

namespace pointplane
{
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
    const Matrix6d ofShutter = shutter_.update(
        frame.pairs,
        frame.associations,
        frame.estimate.motion.mean,
        frame.problem.prior,
        frame.problem.noise);
    const JointCovariance::Measurement out = errorsOf(frame, ofShutter);
    noise_.update(frame.analysis, frame.dt);
    return out;
}

JointCovariance::Measurement ErrorModel::errorsOf(const Measured& frame, const Matrix6d& ofShutter)
{
    if (!isJoint_)
    {
        JointCovariance::Measurement out;
        out.prior.topLeftCorner<6, 6>().setIdentity();
        out.noise.topLeftCorner<6, 6>() = frame.estimate.pose().cov + ofShutter;
        return out;
    }
    const double views = numViews(frame.estimate.motion.mean.T_prev_cur);
    variogram_.update(
        frame.analysis, frame.pairs.R_world_prev(), views, frame.dt, noise_.residuals());
    JointCovariance::Measurement out = frameErrors(
        frame.estimate, frame.analysis.sensitivity, variogram_.levels(), views, params_);
    if (!fuses_)
    {
        out.prior.rightCols<6>().setZero();  // the velocity is a new one for each frame
    }
    out.noise.topLeftCorner<6, 6>() += ofShutter;
    out.priorNoise =
        params_.motion * propagate(frame.analysis.sensitivity.prior, frame.motionNoise);
    return out;
}
}  // namespace pointplane
