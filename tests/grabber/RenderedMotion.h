// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/VisualOdometry.h>
#include <pointplane/mrpt_io/mrpt_poses.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <algorithm>
#include <vector>

#include "grabber_testing.h"
#include <gtest/gtest.h>

namespace pointplane::test
{
/** A Kinect in motion before a desk, rendered with its noise and with the true motion. */
class RenderedMotion
{
 public:
    static constexpr double kFocal_px = 525.0;

    explicit RenderedMotion(int numFrames, int width = 640, int height = 480)
        : sequence_("desk", params(numFrames, width, height), 3)
    {
        for (int k = 0; k < numFrames; ++k)
        {
            PlainFrame plain;
            cv::Mat depth = sequence_.frame(k, &plain.colour).depth.clone();
            cv::patchNaNs(depth, 0.0);
            depth.convertTo(plain.depth, CV_16U, 1000.0);
            frames_.push_back(plain);
        }
    }

    [[nodiscard]] const std::vector<PlainFrame>& frames() const { return frames_; }

    /** Runs the odometry on a recording of these frames, in any order that the camera can play.
     * \param tolerance of the position at every frame [m] */
    void expectOdometryFinds(
        const std::vector<mrpt::obs::CObservation3DRangeScan::Ptr>& scans, double tolerance) const
    {
        VisualOdometry odometry;
        const Eigen::Isometry3d T_robot_cam = opticalInBody();
        const int first = frameOf(*scans.front());
        ASSERT_GE(first, 0);
        double farthest = 0.0;
        for (const auto& scan : scans)
        {
            const RobotMotion motion = odometry.process(*scan);
            EXPECT_TRUE(
                motion.status == TrackingStatus::Tracked ||
                (scan == scans.front() && motion.status == TrackingStatus::First))
                << motion.reason;
            const int frame = frameOf(*scan);
            ASSERT_GE(frame, 0);
            const Eigen::Isometry3d truth = sequence_.trueMotion(first, frame);
            const Eigen::Isometry3d estimate =
                T_robot_cam.inverse() * fromMrpt(motion.pose.mean) * T_robot_cam;
            EXPECT_LT((truth.inverse() * estimate).translation().norm(), tolerance)
                << "frame " << frame << " after " << first;
            farthest = std::max(farthest, truth.translation().norm());
        }
        EXPECT_GT(farthest, 2.0 * tolerance) << "the test needs a motion";
    }

 private:
    static SimulationParams params(int numFrames, int width, int height)
    {
        SimulationParams p;
        p.width = width;
        p.height = height;
        p.focalLengthPx = kFocal_px;  // of an image 640 px wide
        p.duration = (numFrames + 1) / p.fps;
        return p;
    }

    /** Which rendered frame this is, by its colours, which no driver changes. */
    [[nodiscard]] int frameOf(const mrpt::obs::CObservation3DRangeScan& scan) const
    {
        for (std::size_t k = 0; k < frames_.size(); ++k)
        {
            if (samePixels(scan.intensityImage.asCvMatRef(), frames_[k].colour))
            {
                return static_cast<int>(k);
            }
        }
        return -1;
    }

    SimulatedSequence sequence_;
    std::vector<PlainFrame> frames_;
};
}  // namespace pointplane::test
