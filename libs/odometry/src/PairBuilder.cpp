// SPDX-License-Identifier: BSD-3-Clause
#include "PairBuilder.h"

#include <pointplane/core/covariance.h>
#include <pointplane/odometry/uncertainty/CameraCalibrator.h>
#include <pointplane/pose/residuals.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

#include "ShutterCorrection.h"
#include "surfaces.h"
#include "uncertainty/camera_errors.h"

namespace pointplane
{
namespace
{
/** Number of the cell of the image that the pixel is in. \param side_px of the cells */
int cellOf(const Eigen::Vector2d& uv_px, double side_px, const PinholeCamera& camera)
{
    const int cellsPerRow = static_cast<int>(std::ceil(camera.width / side_px));
    return static_cast<int>(std::floor(uv_px.y() / side_px)) * cellsPerRow +
           static_cast<int>(std::floor(uv_px.x() / side_px));
}

/** Number of the patch of the image that the pixel is in. */
int patchOf(const Eigen::Vector2d& uv_px, const PinholeCamera& camera)
{
    const auto part = [](double at_px, int size_px)
    {
        return std::clamp(
            static_cast<int>(kPatchesPerSide * (at_px + 0.5) / size_px), 0, kPatchesPerSide - 1);
    };
    return kPatchesPerSide * part(uv_px.y(), camera.height) + part(uv_px.x(), camera.width);
}

/** Moves a feature of a reference to where it is at the frame's instant. If nobody knows how fast
 * the reference was, it was as fast as the current frame: then their difference depends on V.
 * \param byVelocity how the feature moves with the velocity */
void applyVelocity(
    const Reference& reference,
    const Matrix36d& byVelocity,
    Eigen::Vector3d& feature,
    Matrix36d& dCur_dV)
{
    if (reference.velocity)
    {
        feature += byVelocity * *reference.velocity;
    }
    else
    {
        dCur_dV -= byVelocity;
    }
}

/** The frame, and what its features are corrected by. */
struct CurrentView
{
    const Features& features;
    const ShutterCorrection shutter;
    const CameraCalibrator& learnt;
    const double cellPx;  //!< side of the cells in which corners count as one

    /** \param byCamera how the feature moves with errors of the camera */
    template <class ByCamera>
    void correct(Eigen::Vector3d& feature, ByCamera byCamera) const
    {
        feature += byCamera(feature, features.frame.camera) * learnt.errors();
    }
};

/** A reference, what its features are corrected by, and where they go. */
struct ReferenceView
{
    const Reference& reference;
    const ShutterCorrection shutter;
    const Eigen::Isometry3d T_prev_ref;
};

ReferenceView viewOf(
    const Reference& reference,
    const Reference& previous,
    const CameraCalibrator& learnt,
    cv::Size size)
{
    return {
        reference,
        {learnt.complete(reference.shutter), size},
        previous.T_world_cam.inverse() * reference.T_world_cam};
}

PlanePair planePair(const ReferenceView& past, const CurrentView& current, const PlaneMatch& match)
{
    const PlaneFeature& ref = past.reference.planes.planes[static_cast<size_t>(match.ref)];
    const PlaneFeature& cur = current.features.planes.planes[static_cast<size_t>(match.cur)];
    PlaneGaussian past_ref = ref.plane_cam;
    const Matrix36d byVelocity = past.shutter.planeJacobian(ref);
    PlanePair pair;
    pair.dCur_dV = current.shutter.planeJacobian(cur);
    applyVelocity(past.reference, byVelocity, past_ref.theta_m, pair.dCur_dV);
    current.correct(past_ref.theta_m, planeByCamera);
    pair.dRef_dV = transformJacobian(past.T_prev_ref, past_ref.theta_m) * byVelocity;
    pair.ref = transformed(past.T_prev_ref, past_ref);
    pair.cur = cur.plane_cam;
    current.correct(pair.cur.theta_m, planeByCamera);
    pair.reference = past.reference.id;
    pair.feature = match.cur;
    return pair;
}

PointPair pointPair(const ReferenceView& past, const CurrentView& current, const PointTrack& track)
{
    const Features& features = current.features;
    const PinholeCamera& camera = features.frame.camera;
    const PointFeature& ref = past.reference.points.points[static_cast<size_t>(track.ref)];
    const PointFeature& cur = track.cur;
    PointPair pair;
    const Matrix36d byVelocity = past.shutter.pointJacobian(ref);
    Eigen::Vector3d past_ref = ref.p_cam.mean;
    pair.dCur_dV = current.shutter.pointJacobian(cur);
    applyVelocity(past.reference, byVelocity, past_ref, pair.dCur_dV);
    current.correct(past_ref, pointByCamera);
    pair.dRef_dV = past.T_prev_ref.linear() * byVelocity;
    pair.ref.mean = past.T_prev_ref * past_ref;
    pair.ref.cov = propagate(past.T_prev_ref.linear(), ref.p_cam.cov);
    pair.cur = cur.p_cam;
    current.correct(pair.cur.mean, pointByCamera);
    pair.reference = past.reference.id;
    pair.feature = cellOf(cur.uv_px, current.cellPx, camera);
    pair.hasDepth = cur.hasDepth;
    pair.directions = cur.directions;
    pair.surface = planeAt(camera.depthPixel(cur.uv_px), features.planes);
    if (features.bend > 0)
    {
        pair.refPatch = patchOf(ref.uv_px, camera);
        pair.curPatch = patchOf(cur.uv_px, camera);
    }
    return pair;
}

/** Where both views together put the point of a pair: with noise that is independent of the
 * residual. With the measured points, a camera that shrinks all residuals would seem right. */
struct FusedPoint
{
    FusedPoint(const PointPair& pair, const Motion& motion)
    {
        const Residual residual = pointResidual(pair, motion);
        const Eigen::Vector3d share = residual.cov.ldlt().solve(residual.r);
        inPrevious = pair.ref.mean - pair.ref.cov * share;
        inCurrent = pair.cur.mean + pair.cur.cov * motion.T_prev_cur.linear().transpose() * share;
    }
    Eigen::Vector3d inPrevious, inCurrent;
};

/** The frame's motion, and what its features change by with errors of the camera. */
struct CurrentErrors
{
    const Features& features;
    const Motion& motion;
    const ShutterCorrection shutter;
    const Eigen::Matrix3d estimated;  //!< 1 where a time of the shutter is learnt
};

/** What the features of a reference change by with errors of the camera. */
struct ReferenceErrors : ReferenceView
{
    const ShutterCorrection rootMeanSquare;
    const Eigen::Matrix3d estimated;
    const Vector6d velocity;
};

void addPlaneErrors(
    const ReferenceErrors& past,
    const CurrentErrors& current,
    const PlaneMatch& match,
    PlanePair& pair)
{
    const PinholeCamera& camera = current.features.frame.camera;
    const PlaneFeature& ref = past.reference.planes.planes[static_cast<size_t>(match.ref)];
    const PlaneFeature& cur = current.features.planes.planes[static_cast<size_t>(match.cur)];
    const Eigen::Vector3d theta_m =
        ref.plane_cam.theta_m + past.shutter.planeJacobian(ref) * past.velocity;
    ByCamera ofRef = planeByCamera(theta_m, camera);
    ofRef.rightCols<3>() = past.shutter.planeByShutter(ref, past.velocity) * past.estimated;
    const Eigen::Matrix3d toPrevious = transformJacobian(past.T_prev_ref, theta_m);
    pair.dRef_dV = toPrevious * past.rootMeanSquare.planeJacobian(ref);
    pair.dRef_dCamera = toPrevious * ofRef;
    pair.dCur_dCamera = planeByCamera(cur.plane_cam.theta_m, camera);
    pair.dCur_dCamera.rightCols<3>() =
        current.shutter.planeByShutter(cur, current.motion.velocity) * current.estimated;
}

void addPointErrors(
    const ReferenceErrors& past,
    const CurrentErrors& current,
    const PointTrack& track,
    PointPair& pair)
{
    const PinholeCamera& camera = current.features.frame.camera;
    const PointFeature& ref = past.reference.points.points[static_cast<size_t>(track.ref)];
    const FusedPoint fused(pair, current.motion);
    ByCamera ofRef = pointByCamera(past.T_prev_ref.inverse() * fused.inPrevious, camera);
    ofRef.rightCols<3>() = past.shutter.pointByShutter(ref, past.velocity) * past.estimated;
    pair.dRef_dV = past.T_prev_ref.linear() * past.rootMeanSquare.pointJacobian(ref);
    pair.dRef_dCamera = past.T_prev_ref.linear() * ofRef;
    pair.dCur_dCamera = pointByCamera(fused.inCurrent, camera);
    pair.dCur_dCamera.col(kVignetting) = track.cur.ofVignetting_m;
    pair.dCur_dCamera.rightCols<3>() =
        current.shutter.pointByShutter(track.cur, current.motion.velocity) * current.estimated;
}
}  // namespace

void PairBuilder::build(
    const std::vector<Association>& associations, int windowPx, PoseProblem& problem) const
{
    problem.points.clear();
    problem.planes.clear();
    const cv::Size size(current_.frame.camera.width, current_.frame.camera.height);
    const CurrentView current{
        current_, {learnt_.complete(current_.frame.shutter), size}, learnt_, 0.5 * windowPx};
    for (const Association& association : associations)
    {
        const ReferenceView past = viewOf(*association.reference, previous_, learnt_, size);
        for (const PlaneMatch& match : association.planes)
        {
            problem.planes.push_back(planePair(past, current, match));
        }
        for (const PointTrack& track : association.points)
        {
            problem.points.push_back(pointPair(past, current, track));
        }
    }
}

void PairBuilder::addCameraErrors(
    const std::vector<Association>& associations, const Motion& motion, PoseProblem& problem) const
{
    const cv::Size size(current_.frame.camera.width, current_.frame.camera.height);
    const CurrentErrors current{
        current_,
        motion,
        {learnt_.complete(current_.frame.shutter), size},
        learnt_.estimated(current_.frame.shutter).asDiagonal()};
    auto point = problem.points.begin();
    auto plane = problem.planes.begin();
    for (const Association& association : associations)
    {
        const Reference& reference = *association.reference;
        const ReferenceErrors past{
            viewOf(reference, previous_, learnt_, size),
            {learnt_.rootMeanSquare(reference.shutter), size},
            learnt_.estimated(reference.shutter).asDiagonal(),
            reference.velocity.value_or(motion.velocity)};
        for (const PlaneMatch& match : association.planes)
        {
            addPlaneErrors(past, current, match, *plane++);
        }
        for (const PointTrack& track : association.points)
        {
            addPointErrors(past, current, track, *point++);
        }
    }
}
}  // namespace pointplane
