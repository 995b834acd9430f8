// SPDX-License-Identifier: BSD-3-Clause
#include "PairBuilder.h"

#include <pointplane/core/se3.h>
#include <pointplane/odometry/uncertainty/CameraCalibrator.h>

#include <vector>

#include "ShutterCorrection.h"
#include "matchers.h"
#include "uncertainty/camera_errors.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** A camera with a rolling shutter has seen a point and a plane twice. */
class PairBuilderTest : public testing::Test
{
 protected:
    PairBuilderTest() : calibrator({}, {})
    {
        PinholeCamera& camera = current.frame.camera;
        camera.width = 640;
        camera.height = 480;
        camera.fx = camera.fy = 525;
        camera.cx = 319.5;
        camera.cy = 239.5;
        calibrator.start(camera, calibrationVariances({}, camera));
        current.frame.shutter = reference.shutter = {0.03, 0.03, 0};
        PointFeature point;
        point.uv_px = {400, 100};
        point.p_cam.mean << 0.3, -0.5, 2;
        point.p_cam.cov = 1e-4 * Eigen::Matrix3d::Identity();
        point.theta_m << 0, 0, -0.5;
        reference.points.points.push_back(point);
        PlaneFeature plane;
        plane.plane_cam = {{0.1, 0.2, -0.5}, 1e-4 * Eigen::Matrix3d::Identity()};
        plane.readoutLever = 0.1 * Eigen::Matrix3d::Identity();
        reference.planes.planes.push_back(plane);
        current.planes.planes.push_back(plane);
        PointTrack track;
        track.cur = point;
        association.points.push_back(track);
        association.planes.push_back({0, 0});
        association.reference = &reference;
    }

    void build() { PairBuilder(previous, current, calibrator).build({association}, 15, problem); }

    Reference previous, reference;
    Features current;
    CameraCalibrator calibrator;
    Association association;
    PoseProblem problem;
    const std::vector<PointPair>& points{problem.points};
    const std::vector<PlanePair>& planes{problem.planes};
};
}  // namespace

TEST_F(PairBuilderTest, movesTheReferenceByItsVelocity)
{
    Vector6d velocity;
    velocity << 0.4, -0.3, 0.25, 0.6, 0.8, -0.5;
    reference.velocity = velocity;
    build();
    const ShutterCorrection shutter(reference.shutter, {640, 480});
    const PointFeature& point = reference.points.points.front();
    const PlaneFeature& plane = reference.planes.planes.front();
    EXPECT_THAT(points.front().dRef_dV, test::IsMatrixNear(shutter.pointJacobian(point), 1e-12));
    EXPECT_THAT(
        points.front().ref.mean,
        test::IsMatrixNear(
            Eigen::Vector3d(point.p_cam.mean + shutter.pointJacobian(point) * velocity), 1e-12));
    EXPECT_THAT(points.front().dCur_dV, test::IsMatrixNear(shutter.pointJacobian(point), 1e-12));
    EXPECT_THAT(
        planes.front().ref.theta_m,
        test::IsMatrixNear(
            Eigen::Vector3d(plane.plane_cam.theta_m + shutter.planeJacobian(plane) * velocity),
            1e-12));
    EXPECT_THAT(planes.front().dCur_dV, test::IsMatrixNear(shutter.planeJacobian(plane), 1e-12));
}

/** By finite differences: of where the reference is, in the previous frame. */
TEST_F(PairBuilderTest, knowsHowTheReferenceChangesWithItsVelocity)
{
    reference.T_world_cam = se3Exp((Vector6d() << 0.1, 0, -0.2, 0.3, 0.1, 0.2).finished());
    reference.velocity = Vector6d::Zero();
    build();
    const PointPair point = points.front();
    const PlanePair plane = planes.front();
    constexpr double kStep = 1e-5;
    for (int axis = 0; axis < 6; ++axis)
    {
        reference.velocity = kStep * Vector6d::Unit(axis);
        build();
        const Eigen::Vector3d ofPoint = (points.front().ref.mean - point.ref.mean) / kStep;
        const Eigen::Vector3d ofPlane = (planes.front().ref.theta_m - plane.ref.theta_m) / kStep;
        EXPECT_THAT(ofPoint, test::IsMatrixNear(Eigen::Vector3d(point.dRef_dV.col(axis)), 1e-6));
        EXPECT_THAT(ofPlane, test::IsMatrixNear(Eigen::Vector3d(plane.dRef_dV.col(axis)), 1e-6));
    }
}

/** What is learnt of the lens moves the features as their columns say. */
TEST_F(PairBuilderTest, knowsHowFeaturesChangeWithTheLens)
{
    reference.T_world_cam = se3Exp((Vector6d() << 0.1, 0, -0.2, 0.3, 0.1, 0.2).finished());
    reference.velocity = Vector6d::Zero();
    // Both views agree: the point that both together tell is the measured one.
    PointFeature& cur = association.points.front().cur;
    cur.p_cam.mean = reference.T_world_cam * cur.p_cam.mean;
    current.frame.camera.isNominal = true;
    const auto started = [&]
    {
        CameraCalibrator out({}, {});
        out.start(current.frame.camera, calibrationVariances({}, current.frame.camera));
        return out;
    };
    calibrator = started();
    build();
    PairBuilder(previous, current, calibrator)
        .addCameraErrors({association}, {Eigen::Isometry3d::Identity(), Vector6d::Zero()}, problem);
    const PointPair point = points.front();
    const PlanePair plane = planes.front();
    for (const int error : {kPrincipalPointX, kPrincipalPointY, kFocalLength, kRadial})
    {
        PoseAnalysis frame;
        const double information = 10 / calibrator.cov()(error, error);
        frame.camera.information(error, error) = information;
        frame.camera.gradient[error] = -1e-5 * information;
        frame.cameraByReference = frame.camera;
        calibrator = started();
        (void)calibrator.update(frame, 0, 1, Eigen::Matrix3d::Zero());
        const double learnt = calibrator.errors()[error];
        ASSERT_GT(learnt, 1e-6) << error;
        build();
        const auto expectColumn =
            [&](const Eigen::Vector3d& moved, const Eigen::Vector3d& before, const ByCamera& by)
        {
            EXPECT_THAT(
                Eigen::Vector3d((moved - before) / learnt),
                test::IsMatrixNear(Eigen::Vector3d(by.col(error)), 1e-3 * by.norm()))
                << error;
        };
        expectColumn(points.front().ref.mean, point.ref.mean, point.dRef_dCamera);
        expectColumn(points.front().cur.mean, point.cur.mean, point.dCur_dCamera);
        EXPECT_GT(point.dCur_dCamera.col(error).norm(), 1e-5) << error;
        expectColumn(planes.front().ref.theta_m, plane.ref.theta_m, plane.dRef_dCamera);
        expectColumn(planes.front().cur.theta_m, plane.cur.theta_m, plane.dCur_dCamera);
    }
}

/** A track is displaced by how much darker it is here than in the reference. */
TEST_F(PairBuilderTest, vignettingMovesWhatWasTracked)
{
    reference.T_world_cam = se3Exp((Vector6d() << 0.1, 0, -0.2, 0.3, 0.1, 0.2).finished());
    const Eigen::Vector3d displaced(0.01, -0.02, 0.03);
    association.points.front().cur.ofVignetting_m = displaced;
    reference.points.points.front().ofVignetting_m << 0.4, 0.5, 0.6;  // where it was tracked once
    build();
    PairBuilder(previous, current, calibrator)
        .addCameraErrors({association}, {Eigen::Isometry3d::Identity(), Vector6d::Zero()}, problem);
    EXPECT_EQ(points.front().dCur_dCamera.col(kVignetting), displaced);
    EXPECT_TRUE(points.front().dRef_dCamera.col(kVignetting).isZero(0));
    EXPECT_TRUE(planes.front().dCur_dCamera.col(kVignetting).isZero(0));
}

/** Two images of a camera that moves on as before, in the same rows: they do not show how fast. To
 * take an unknown velocity for none would say that the camera has just started. */
TEST_F(PairBuilderTest, aReferenceOfUnknownVelocityWasAsFastAsTheFrame)
{
    build();
    EXPECT_TRUE(points.front().dCur_dV.isZero(1e-15));
    EXPECT_TRUE(planes.front().dCur_dV.isZero(1e-15));
    EXPECT_EQ(points.front().ref.mean, reference.points.points.front().p_cam.mean);
}

/** Nor do they show how long the shutter takes. */
TEST_F(PairBuilderTest, thenTheShutterIsNotLearntEither)
{
    current.frame.shutter = reference.shutter = ShutterModel{};
    Motion motion;
    motion.velocity << 0.4, -0.3, 0.25, 0.6, 0.8, -0.5;
    const auto byShutter = [&]() -> Eigen::Matrix3d
    {
        build();
        PairBuilder(previous, current, calibrator).addCameraErrors({association}, motion, problem);
        return (points.front().dRef_dCamera - points.front().dCur_dCamera).rightCols<3>();
    };
    EXPECT_TRUE(byShutter().isZero(1e-12));
    reference.velocity = Vector6d::Zero();
    EXPECT_FALSE(byShutter().isZero(1e-3));
}
}  // namespace pointplane
