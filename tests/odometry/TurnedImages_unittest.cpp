// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/Odometry.h>
#include <pointplane/sensor/readout.h>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>

#include <cmath>
#include <vector>

#include "hell_frames.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kNumFrames = 90, kInterval = 10;

/** The image turned clockwise by 90 degrees, and its camera. Nothing is told of its shutter. */
RgbdFrame turned(const RgbdFrame& frame)
{
    RgbdFrame out;
    out.stamp = frame.stamp;
    cv::rotate(frame.gray, out.gray, cv::ROTATE_90_CLOCKWISE);
    cv::rotate(frame.depth, out.depth, cv::ROTATE_90_CLOCKWISE);
    const PinholeCamera& c = frame.camera;
    out.camera = c;
    out.camera.width = c.height;
    out.camera.height = c.width;
    out.camera.fx = c.fy;
    out.camera.fy = c.fx;
    out.camera.cx = c.height - 1 - c.cy;
    out.camera.cy = c.cx;
    return out;
}

/** Error of motions over ten frames [m], root mean square from the second second on.
 * \param numTurns of the images by 90 degrees */
double errorOf(int numTurns, const OdometryParams& params)
{
    test::CachedSequence& desk = test::CachedSequence::desk();
    const Eigen::Isometry3d T_cam_turned(
        Eigen::AngleAxisd(-M_PI_2 * numTurns, Eigen::Vector3d::UnitZ()));
    test::CheckedOdometry odometry(params);
    std::vector<Eigen::Isometry3d> poses;
    double sum = 0;
    int num = 0;
    for (int i = 0; i < kNumFrames; ++i)
    {
        RgbdFrame frame = desk.frame(i);
        frame.shutter = {};
        for (int k = 0; k < numTurns; ++k)
        {
            frame = turned(frame);
        }
        const OdometryResult result = odometry.process(frame);
        poses.push_back(T_cam_turned * result.pose.mean * T_cam_turned.inverse());
        if (i >= kNumFrames / 3 + kInterval)
        {
            const auto from = static_cast<size_t>(i - kInterval);
            const Eigen::Isometry3d motion = poses[from].inverse() * poses.back();
            const Eigen::Isometry3d truth = desk.sequence().trueMotion(i - kInterval, i);
            sum += (truth.inverse() * motion).translation().squaredNorm();
            ++num;
        }
    }
    return std::sqrt(sum / num);
}
}  // namespace

TEST(TurnedImages, linesAreAlongTheLongerSide)
{
    EXPECT_DOUBLE_EQ(readoutFraction({100, 0}, {640, 480}), -0.5);
    EXPECT_DOUBLE_EQ(readoutFraction({100, 360}, {640, 480}), 0.25);
    EXPECT_DOUBLE_EQ(readoutFraction({360, 100}, {480, 640}), 0.25);
    EXPECT_DOUBLE_EQ(readoutFraction({100, 360}, {480, 480}), 0.25);
}

/** A rolling shutter is corrected whichever way its images are turned. */
TEST(TurnedImages, areAsGoodAsUprightOnes)
{
    const double best = errorOf(0, {});
    OdometryParams without;
    without.shutter.correct = false;
    EXPECT_GT(errorOf(0, without), 2 * best) << "else this tests nothing";
    EXPECT_LT(errorOf(1, {}), 1.3 * best) << "upright";
    EXPECT_LT(errorOf(3, {}), 1.3 * best) << "upright, turned to the other side";
    OdometryParams turned;
    turned.shutter.findDirection = true;
    EXPECT_LT(errorOf(2, turned), 1.3 * best) << "upside down";
}
}  // namespace pointplane
