// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/odometry/PairBuilder.h>
#include <pointplane/odometry/ShutterCorrection.h>
#include <pointplane/odometry/uncertainty/CameraCalibrator.h>
#include <pointplane/odometry/uncertainty/camera_errors.h>
#include <pointplane/pose/residuals.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

#include "surfaces.h"

namespace pointplane
{
namespace
{
cv::Size sizeOf(const PinholeCamera& camera) { return {camera.width, camera.height}; }

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
    pair.surface = surfaceAt(camera.depthPixel(cur.uv_px), features.planes);
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
}  // namespace

void PairBuilder::build(
    const std::vector<Association>& associations,
    int windowPx,
    std::vector<PointPair>& points,
    std::vector<PlanePair>& planes) const
{
    points.clear();
    planes.clear();
    const PinholeCamera& camera = current_.frame.camera;
    const CurrentView current{
        current_,
        {learnt_.complete(current_.frame.shutter), sizeOf(camera)},
        learnt_,
        0.5 * windowPx};
    for (const Association& association : associations)
    {
        const Reference& reference = *association.reference;
        const ReferenceView past{
            reference,
            {learnt_.complete(reference.shutter), sizeOf(camera)},
            previous_.T_world_cam.inverse() * reference.T_world_cam};
        for (const PlaneMatch& match : association.planes)
        {
            planes.push_back(planePair(past, current, match));
        }
        for (const PointTrack& track : association.points)
        {
            points.push_back(pointPair(past, current, track));
        }
    }
}

void PairBuilder::addCameraErrors(
    const std::vector<Association>& associations,
    const Motion& motion,
    std::vector<PointPair>& points,
    std::vector<PlanePair>& planes) const
{
    const PinholeCamera& camera = current_.frame.camera;
    const ShutterCorrection current(learnt_.complete(current_.frame.shutter), sizeOf(camera));
    const Eigen::Matrix3d ofCurrent = learnt_.estimated(current_.frame.shutter).asDiagonal();
    auto point = points.begin();
    auto plane = planes.begin();
    for (const Association& association : associations)
    {
        const Reference& reference = *association.reference;
        const ShutterCorrection past(learnt_.complete(reference.shutter), sizeOf(camera));
        const ShutterCorrection most(learnt_.rootMeanSquare(reference.shutter), sizeOf(camera));
        const Eigen::Matrix3d ofReference = learnt_.estimated(reference.shutter).asDiagonal();
        const Eigen::Isometry3d T_prev_ref =
            previous_.T_world_cam.inverse() * reference.T_world_cam;
        const Eigen::Isometry3d T_ref_prev = T_prev_ref.inverse();
        const Vector6d velocity = reference.velocity.value_or(motion.velocity);
        for (const PlaneMatch& match : association.planes)
        {
            const PlaneFeature& ref = reference.planes.planes[static_cast<size_t>(match.ref)];
            const PlaneFeature& cur = current_.planes.planes[static_cast<size_t>(match.cur)];
            const Eigen::Vector3d theta_m =
                ref.plane_cam.theta_m + past.planeJacobian(ref) * velocity;
            ByCamera ofRef = planeByCamera(theta_m, camera);
            ofRef.rightCols<3>() = past.planeByShutter(ref, velocity) * ofReference;
            const Eigen::Matrix3d toPrevious = transformJacobian(T_prev_ref, theta_m);
            plane->dRef_dV = toPrevious * most.planeJacobian(ref);
            plane->dRef_dCamera = toPrevious * ofRef;
            plane->dCur_dCamera = planeByCamera(cur.plane_cam.theta_m, camera);
            plane->dCur_dCamera.rightCols<3>() =
                current.planeByShutter(cur, motion.velocity) * ofCurrent;
            ++plane;
        }
        for (const PointTrack& track : association.points)
        {
            const PointFeature& ref = reference.points.points[static_cast<size_t>(track.ref)];
            const FusedPoint fused(*point, motion);
            ByCamera ofRef = pointByCamera(T_ref_prev * fused.inPrevious, camera);
            ofRef.rightCols<3>() = past.pointByShutter(ref, velocity) * ofReference;
            point->dRef_dV = T_prev_ref.linear() * most.pointJacobian(ref);
            point->dRef_dCamera = T_prev_ref.linear() * ofRef;
            point->dCur_dCamera = pointByCamera(fused.inCurrent, camera);
            point->dCur_dCamera.col(kVignetting) = track.cur.ofVignetting_m;
            point->dCur_dCamera.rightCols<3>() =
                current.pointByShutter(track.cur, motion.velocity) * ofCurrent;
            ++point;
        }
    }
}
}  // namespace pointplane
