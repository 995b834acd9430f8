// SPDX-License-Identifier: BSD-3-Clause
#include "ShutterCorrection.h"

#include <pointplane/core/se3.h>
#include <pointplane/planes/PlaneExtractor.h>

#include <opencv2/core/mat.hpp>

#include <cmath>
#include <limits>

#include "matchers.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kWidth = 320, kHeight = 240;
const cv::Size kSize(kWidth, kHeight);

/** A Kinect in a moving hand. */
ShutterModel kinect() { return {0.027, 0.024, -0.010}; }

Vector6d handVelocity()
{
    Vector6d v;
    v << 0.4, -0.3, 0.25, 0.6, 0.8, -0.5;
    return v;
}

PinholeCamera camera()
{
    PinholeCamera out;
    out.width = kWidth;
    out.height = kHeight;
    out.fx = out.fy = 262.5;
    out.cx = 159.5;
    out.cy = 119.5;
    return out;
}

double colourTime(const ShutterModel& s, double row)
{
    return (row / kHeight - 0.5) * s.readoutColour;
}

double depthTime(const ShutterModel& s, double row)
{
    return s.depthDelay + (row / kHeight - 0.5) * s.readoutDepth;
}

/** Where the point, given at the stamp, is in the camera at time s after it. */
Eigen::Vector3d seenAt(const Eigen::Vector3d& P, double s, const Vector6d& V)
{
    return se3Exp(-s * V) * P;
}

Eigen::Vector3d correctedPoint(
    const ShutterCorrection& correction, const PointFeature& point, const Vector6d& V)
{
    return point.p_cam.mean + correction.pointJacobian(point) * V;
}

PointFeature pointOn(const Eigen::Vector3d& P, const Eigen::Vector3d& theta, double row)
{
    PointFeature out;
    out.uv_px.y() = row;
    out.p_cam.mean = P;
    out.theta_m = theta;
    return out;
}

/** The plane through P with the normal's direction, theta . P + 1 = 0. */
Eigen::Vector3d through(const Eigen::Vector3d& P, const Eigen::Vector3d& direction)
{
    return -direction / direction.dot(P);
}

Eigen::Vector3d correctedPlane(
    const ShutterCorrection& correction, const PlaneFeature& plane, const Vector6d& V)
{
    return plane.plane_cam.theta_m + correction.planeJacobian(plane) * V;
}

/** What the camera reports of a static point on a surface: its pixel in the colour image, whose row
 * is exposed when the point crosses it, and the depth of that pixel in the depth image of another
 * instant, when it sees another part of the surface. */
PointFeature observe(
    const Eigen::Vector3d& P_stamp,
    const Eigen::Vector3d& theta_stamp,
    const ShutterModel& shutter,
    const Vector6d& V)
{
    double row = camera().project(P_stamp).y();
    Eigen::Vector3d inColour = P_stamp;
    for (int i = 0; i < 50; ++i)  // the row that is exposed when the point is on it
    {
        inColour = seenAt(P_stamp, colourTime(shutter, row), V);
        row = camera().project(inColour).y();
    }
    const Eigen::Isometry3d T_depth_stamp = se3Exp(-depthTime(shutter, row) * V);
    const Eigen::Vector3d theta = minimalForm(transformed(T_depth_stamp, hessianForm(theta_stamp)));
    return pointOn(-inColour / theta.dot(inColour), theta, row);
}

/** Depth image of a static plane, row by row, each row at its own time. */
cv::Mat rollingDepth(const Eigen::Vector3d& theta, const ShutterModel& shutter, const Vector6d& V)
{
    const PinholeCamera c = camera();
    const Plane atStamp = hessianForm(theta);
    cv::Mat depth(kHeight, kWidth, CV_32FC1);
    for (int v = 0; v < kHeight; ++v)
    {
        const Eigen::Isometry3d T_row_stamp = se3Exp(-depthTime(shutter, v) * V);
        const Eigen::Vector3d m = minimalForm(transformed(T_row_stamp, atStamp));
        for (int u = 0; u < kWidth; ++u)
        {
            const Eigen::Vector3d ray((u - c.cx) / c.fx, (v - c.cy) / c.fy, 1);
            depth.at<float>(v, u) = static_cast<float>(-1 / m.dot(ray));
        }
    }
    return depth;
}
}  // namespace

TEST(ShutterCorrection, pointByHand)
{
    // Half an image below the middle: 10 ms late. Forward at 1 m/s: it was 1 cm nearer when seen.
    ShutterModel shutter{0.02, 0.02, 0};
    Vector6d V = Vector6d::Zero();
    V[2] = 1;
    const ShutterCorrection correction(shutter, kSize);
    EXPECT_THAT(
        correctedPoint(correction, pointOn({0.1, 0.4, 1.99}, {0, 0, -1 / 1.99}, kHeight), V),
        test::IsMatrixNear(Eigen::Vector3d(0.1, 0.4, 2), 1e-12));
    EXPECT_THAT(
        correctedPoint(correction, pointOn({0.1, 0.4, 2}, {0, 0, -0.5}, 0.5 * kHeight), V),
        test::IsMatrixNear(Eigen::Vector3d(0.1, 0.4, 2), 1e-12));
}

TEST(ShutterCorrection, depthOfASlopeByHand)
{
    // Depth 10 ms before colour, turning at 10 rad/s: the ray has moved by 0.1 rad since, along a
    // wall at 45 deg, Z = 2 + X, whose depth grows by 2 m per rad there.
    const ShutterCorrection correction({0, 0, -0.010}, kSize);
    Vector6d V = Vector6d::Zero();
    V[4] = 10;
    const Eigen::Vector3d P(0, 0, 2);
    const PointFeature point = pointOn(P, through(P, {-1, 0, 1}), 0.5 * kHeight);
    const Eigen::Vector3d corrected = correctedPoint(correction, point, V);
    EXPECT_THAT(corrected, test::IsMatrixNear(Eigen::Vector3d(0, 0, 2.2), 1e-12));
}

TEST(ShutterCorrection, pointOfAStaticWorld)
{
    const ShutterCorrection correction(kinect(), kSize);
    const Vector6d V = handVelocity();
    for (const Eigen::Vector3d& direction :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.6, 0, 1), Eigen::Vector3d(0.1, -0.8, 1)})
    {
        for (const double x : {-0.5, 0.0, 0.4})
        {
            for (const double y : {-0.4, 0.1, 0.5})
            {
                const Eigen::Vector3d P(2 * x, 2 * y, 2);
                const PointFeature seen = observe(P, through(P, direction), kinect(), V);
                const double before = (seen.p_cam.mean - P).norm();
                // First order in time: what remains is a twentieth.
                EXPECT_GT(before, 4e-3);
                EXPECT_LT((correctedPoint(correction, seen, V) - P).norm(), 0.05 * before)
                    << P.transpose() << ", " << direction.transpose();
            }
        }
    }
}

TEST(ShutterCorrection, pointErrorIsOfSecondOrder)
{
    const ShutterCorrection correction(kinect(), kSize);
    const Eigen::Vector3d P(0.6, 0.7, 2.2);
    const auto remaining = [&](double scale)
    {
        const Vector6d V = scale * handVelocity();
        const PointFeature seen = observe(P, through(P, {0.5, -0.7, 1}), kinect(), V);
        return (correctedPoint(correction, seen, V) - P).norm();
    };
    EXPECT_NEAR(remaining(1) / remaining(0.25), 16, 3);
}

TEST(ShutterCorrection, planeOfAStaticWorld)
{
    const Vector6d V = handVelocity();
    const ShutterCorrection correction(kinect(), kSize);
    PlaneExtractor extractor({}, {});
    for (const Eigen::Vector3d& theta :
         {Eigen::Vector3d(0, 0, -0.5),
          Eigen::Vector3d(0.2, 0.1, -0.5),
          Eigen::Vector3d(-0.1, -0.3, -0.4)})
    {
        const PlaneSet still = extractor.extract(rollingDepth(theta, {0, 0, 0}, V), camera());
        ASSERT_EQ(still.planes.size(), 1U);
        EXPECT_THAT(still.planes[0].plane_cam.theta_m, test::IsMatrixNear(theta, 1e-5));

        const PlaneSet rolling = extractor.extract(rollingDepth(theta, kinect(), V), camera());
        ASSERT_EQ(rolling.planes.size(), 1U);
        const double before = (rolling.planes[0].plane_cam.theta_m - theta).norm();
        const Eigen::Vector3d corrected = correctedPlane(correction, rolling.planes[0], V);
        EXPECT_GT(before, 2e-3);
        EXPECT_LT((corrected - theta).norm(), 0.05 * before) << theta.transpose();
    }
}

TEST(ShutterCorrection, planeSeenByAPartOfTheImage)
{
    // Only the lower half: the delay of its rows dominates.
    const Eigen::Vector3d theta(0.1, 0.2, -0.5);
    const Vector6d V = handVelocity();
    cv::Mat depth = rollingDepth(theta, kinect(), V);
    depth.rowRange(0, kHeight / 2).setTo(std::numeric_limits<float>::quiet_NaN());
    const PlaneSet set = PlaneExtractor({}, {}).extract(depth, camera());
    ASSERT_EQ(set.planes.size(), 1U);
    const double before = (set.planes[0].plane_cam.theta_m - theta).norm();
    const ShutterCorrection correction(kinect(), kSize);
    const Eigen::Vector3d corrected = correctedPlane(correction, set.planes[0], V);
    EXPECT_LT((corrected - theta).norm(), 0.05 * before);
}

TEST(ShutterCorrection, nothingToCorrect)
{
    const Eigen::Vector3d P(0.3, -0.2, 1.5);
    const PointFeature point = pointOn(P, through(P, {0.5, 0.2, 1}), 17);
    PlaneFeature plane;
    plane.plane_cam.theta_m << 0.1, 0.2, -0.4;
    plane.readoutLever = 0.1 * Eigen::Matrix3d::Ones();
    const Eigen::Vector3d& theta = plane.plane_cam.theta_m;
    // A still camera, a global shutter, an unknown one.
    const ShutterCorrection still(kinect(), kSize);
    EXPECT_THAT(correctedPoint(still, point, Vector6d::Zero()), test::IsMatrixNear(P, 1e-15));
    EXPECT_EQ(correctedPlane(still, plane, Vector6d::Zero()), theta);
    for (const ShutterModel& shutter : {ShutterModel{0, 0, 0}, ShutterModel{}})
    {
        const ShutterCorrection none(shutter, kSize);
        EXPECT_THAT(correctedPoint(none, point, handVelocity()), test::IsMatrixNear(P, 1e-15));
        EXPECT_THAT(correctedPlane(none, plane, handVelocity()), test::IsMatrixNear(theta, 1e-15));
    }
}

/** Both corrections are linear in the three times. */
TEST(ShutterCorrection, changesWithTheShutter)
{
    PointFeature point = pointOn({0.4, -0.3, 1.7}, {0.1, -0.2, -0.5}, 31);
    PlaneFeature plane;
    plane.plane_cam.theta_m << 0.2, -0.4, 0.6;
    plane.readoutLever << 0.1, -0.2, 0.05, 0.3, 0.1, 0, -0.1, 0.2, 0.15;
    const Vector6d V = handVelocity();
    const auto at = [&](int k, double by)
    {
        ShutterModel shutter = kinect();
        (k == 0 ? shutter.readoutColour : k == 1 ? shutter.readoutDepth : shutter.depthDelay) += by;
        return ShutterCorrection(shutter, kSize);
    };
    constexpr double kStep = 1e-3;
    Eigen::Matrix3d ofPoint, ofPlane;
    for (int k = 0; k < 3; ++k)
    {
        const ShutterCorrection after = at(k, kStep), before = at(k, -kStep);
        ofPoint.col(k) =
            (after.pointJacobian(point) - before.pointJacobian(point)) * V / (2 * kStep);
        ofPlane.col(k) =
            (after.planeJacobian(plane) - before.planeJacobian(plane)) * V / (2 * kStep);
    }
    const ShutterCorrection correction(kinect(), kSize);
    EXPECT_THAT(correction.pointByShutter(point, V), test::IsMatrixNear(ofPoint, 1e-9));
    EXPECT_THAT(correction.planeByShutter(plane, V), test::IsMatrixNear(ofPlane, 1e-9));
    EXPECT_GT(ofPoint.col(0).norm(), 0.1);
}
}  // namespace pointplane
