// SPDX-License-Identifier: BSD-3-Clause
#include "local_surface.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** A plane n . P = d in view of a camera. */
RgbdFrame slantedWall(const Eigen::Vector3d& n, double d)
{
    RgbdFrame out;
    out.depth.create(480, 640, CV_32FC1);
    for (int v = 0; v < 480; ++v)
    {
        for (int u = 0; u < 640; ++u)
        {
            const Eigen::Vector3d ray = out.camera.normalised(Eigen::Vector2d(u, v)).homogeneous();
            out.depth.at<float>(v, u) = static_cast<float>(d / n.dot(ray));
        }
    }
    return out;
}

PointFeature pointAt(const RgbdFrame& frame, int u, int v)
{
    PointFeature out;
    out.uv_px << u, v;
    out.p_cam.mean = static_cast<double>(frame.depth.at<float>(v, u)) *
                     frame.camera.normalised(out.uv_px).homogeneous();
    out.theta_m = localSurface(frame, out);
    return out;
}
}  // namespace

TEST(LocalSurface, IsTheWall)
{
    const Eigen::Vector3d n = Eigen::Vector3d(0.5, -0.3, 1).normalized();
    RgbdFrame frame = slantedWall(n, 2);
    const PointFeature point = pointAt(frame, 200, 300);
    EXPECT_NEAR(point.theta_m.dot(point.p_cam.mean), -1, 1e-12);
    EXPECT_NEAR((point.theta_m + n / 2).norm(), 0, 0.01 * 0.5);
    // Another surface beside it does not count.
    frame.depth(cv::Rect(203, 0, 437, 480)).setTo(3);
    EXPECT_NEAR((pointAt(frame, 200, 300).theta_m + n / 2).norm(), 0, 0.03 * 0.5);
}

TEST(LocalSurface, JacobianIsThatOfTheWall)
{
    const RgbdFrame frame = slantedWall(Eigen::Vector3d(0.5, -0.3, 1).normalized(), 2);
    for (const auto& [u, v] : {std::pair{100, 80}, std::pair{320, 240}, std::pair{600, 400}})
    {
        const auto J = surfaceJacobian(frame.camera, pointAt(frame, u, v));
        for (int k = 0; k < 2; ++k)
        {
            const int du = k == 0 ? 1 : 0, dv = 1 - du;
            const Eigen::Vector3d numeric = (pointAt(frame, u + du, v + dv).p_cam.mean -
                                             pointAt(frame, u - du, v - dv).p_cam.mean) /
                                            2;
            EXPECT_NEAR((J.col(k) - numeric).norm(), 0, 0.02 * numeric.norm()) << u << ' ' << k;
        }
    }
}

/** Against the wall's neighbouring pixels, seen from a camera that has turned and moved. */
TEST(LocalSurface, WarpIsThatOfTheWall)
{
    const RgbdFrame frame = slantedWall(Eigen::Vector3d(0.5, -0.3, 1).normalized(), 2);
    Eigen::Isometry3d T_cur_ref = Eigen::Isometry3d::Identity();
    T_cur_ref.linear() =
        Eigen::AngleAxisd(0.2, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
    T_cur_ref.translation() << 0.1, -0.2, 0.3;
    for (const auto& [u, v] : {std::pair{100, 80}, std::pair{320, 240}, std::pair{600, 400}})
    {
        const auto seen = [&, x = u, y = v](int du, int dv)
        { return frame.camera.project(T_cur_ref * pointAt(frame, x + du, y + dv).p_cam.mean); };
        Eigen::Matrix2d numeric;
        numeric << (seen(1, 0) - seen(-1, 0)) / 2, (seen(0, 1) - seen(0, -1)) / 2;
        const Eigen::Matrix2d A = surfaceWarp(frame.camera, pointAt(frame, u, v), T_cur_ref);
        EXPECT_NEAR((A - numeric).norm(), 0, 0.01) << u;
        EXPECT_GT((A - Eigen::Matrix2d::Identity()).norm(), 0.2) << u;
    }
}

TEST(LocalSurface, WithoutReadingsItIsTakenForLevel)
{
    RgbdFrame frame = slantedWall({0, 0, 1}, 2);
    PointFeature point = pointAt(frame, 300, 200);
    frame.depth.setTo(0);
    point.theta_m = localSurface(frame, point);
    const auto J = surfaceJacobian(frame.camera, point);
    EXPECT_NEAR(J(0, 0), 2 / frame.camera.fx, 1e-6);
    EXPECT_EQ(J(2, 0), 0);
}

TEST(LocalSurface, DepthJumpsAreSeenFromNinePixels)
{
    RgbdFrame frame = slantedWall({0, 0, 1}, 2);
    frame.depth(cv::Rect(310, 0, 330, 480)).setTo(3);
    EXPECT_TRUE(isNearDepthJump(frame, pointAt(frame, 303, 240)));
    EXPECT_FALSE(isNearDepthJump(frame, pointAt(frame, 300, 240)));
    frame.depth(cv::Rect(310, 0, 330, 480)).setTo(0);  // no reading is no jump
    EXPECT_FALSE(isNearDepthJump(frame, pointAt(frame, 303, 240)));
    EXPECT_FALSE(isNearDepthJump(frame, pointAt(frame, 0, 0)));
}
}  // namespace pointplane
