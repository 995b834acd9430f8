// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/covariance.h>
#include <pointplane/odometry/PairBuilder.h>
#include <pointplane/odometry/ShutterCorrection.h>
#include <pointplane/odometry/uncertainty/ShutterCalibrator.h>
#include <pointplane/odometry/uncertainty/camera_errors.h>
#include <pointplane/pose/residuals.h>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
/** Corners of several references that are found so close to each other are the same one. */
constexpr double kSameCorner = 6;  // [px]

/** Number of the cell of the image that the pixel is in. */
int cellOf(const Eigen::Vector2d& uv_px)
{
    constexpr int kCellsPerRow = 10000;
    return static_cast<int>(std::floor(uv_px.y() / kSameCorner)) * kCellsPerRow +
           static_cast<int>(std::floor(uv_px.x() / kSameCorner));
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
}  // namespace

void PairBuilder::build(
    const std::vector<Association>& associations,
    const ShutterCalibrator& shutter,
    std::vector<PointPair>& points,
    std::vector<PlanePair>& planes) const
{
    points.clear();
    planes.clear();
    const PinholeCamera& camera = current_.frame.camera;
    const ShutterCorrection current(shutter.complete(current_.frame.shutter), camera.height);
    for (const Association& association : associations)
    {
        const Reference& reference = *association.reference;
        const ShutterCorrection past(shutter.complete(reference.shutter), camera.height);
        const Eigen::Isometry3d T_prev_ref =
            previous_.T_world_cam.inverse() * reference.T_world_cam;
        for (const PlaneMatch& match : association.planes)
        {
            const PlaneFeature& ref = reference.planes.planes[static_cast<size_t>(match.ref)];
            const PlaneFeature& cur = current_.planes.planes[static_cast<size_t>(match.cur)];
            PlaneGaussian past_ref = ref.plane_cam;
            past_ref.theta_m += past.planeJacobian(ref) * reference.velocity;
            planes.push_back(
                {transformed(T_prev_ref, past_ref),
                 cur.plane_cam,
                 current.planeJacobian(cur),
                 transformJacobian(T_prev_ref, past_ref.theta_m) *
                     planeByCamera(past_ref.theta_m, camera),
                 planeByCamera(cur.plane_cam.theta_m, camera),
                 reference.id,
                 match.ref,
                 match.cur});
        }
        for (const PointTrack& track : association.points)
        {
            const PointFeature& ref = reference.points.points[static_cast<size_t>(track.ref)];
            const PointFeature& cur = track.cur;
            PointPair pair;
            pair.ref.mean =
                T_prev_ref * (ref.p_cam.mean + past.pointJacobian(ref) * reference.velocity);
            pair.ref.cov = propagate(T_prev_ref.linear(), ref.p_cam.cov);
            pair.cur = cur.p_cam;
            pair.dCur_dV = current.pointJacobian(cur);
            pair.dRef_dCamera = T_prev_ref.linear() * pointByCamera(ref.p_cam.mean, camera);
            pair.dCur_dCamera = pointByCamera(cur.p_cam.mean, camera);
            pair.dCur_dCamera.col(0) = cur.ofVignetting_m;
            pair.reference = reference.id;
            pair.inReference = track.ref;
            pair.feature = cellOf(cur.uv_px);
            if (current_.bend > 0)
            {
                pair.refPatch = patchOf(ref.uv_px, camera);
                pair.curPatch = patchOf(cur.uv_px, camera);
            }
            points.push_back(pair);
        }
    }
}

void PairBuilder::addShutterErrors(
    const std::vector<Association>& associations,
    const ShutterCalibrator& shutter,
    const Vector6d& velocity,
    std::vector<PointPair>& points,
    std::vector<PlanePair>& planes) const
{
    const int height = current_.frame.camera.height;
    const ShutterCorrection current(shutter.complete(current_.frame.shutter), height);
    const Eigen::Matrix3d ofCurrent = shutter.estimated(current_.frame.shutter).asDiagonal();
    auto point = points.begin();
    auto plane = planes.begin();
    for (const Association& association : associations)
    {
        const Reference& reference = *association.reference;
        const ShutterCorrection past(shutter.complete(reference.shutter), height);
        const Eigen::Matrix3d ofReference = shutter.estimated(reference.shutter).asDiagonal();
        const Eigen::Isometry3d T_prev_ref =
            previous_.T_world_cam.inverse() * reference.T_world_cam;
        for (const PlaneMatch& match : association.planes)
        {
            const PlaneFeature& ref = reference.planes.planes[static_cast<size_t>(match.ref)];
            const PlaneFeature& cur = current_.planes.planes[static_cast<size_t>(match.cur)];
            const Eigen::Vector3d theta_m =
                ref.plane_cam.theta_m + past.planeJacobian(ref) * reference.velocity;
            plane->dRef_dCamera.rightCols<3>() = transformJacobian(T_prev_ref, theta_m) *
                                                 past.planeByShutter(ref, reference.velocity) *
                                                 ofReference;
            plane->dCur_dCamera.rightCols<3>() = current.planeByShutter(cur, velocity) * ofCurrent;
            ++plane;
        }
        for (const PointTrack& track : association.points)
        {
            const PointFeature& ref = reference.points.points[static_cast<size_t>(track.ref)];
            point->dRef_dCamera.rightCols<3>() =
                T_prev_ref.linear() * past.pointByShutter(ref, reference.velocity) * ofReference;
            point->dCur_dCamera.rightCols<3>() =
                current.pointByShutter(track.cur, velocity) * ofCurrent;
            ++point;
        }
    }
}
}  // namespace pointplane
