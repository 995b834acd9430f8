// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/odometry/PointStage.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
class PointStageTest : public testing::TestWithParam<const char*>
{
 protected:
    static const SimulatedSequence& sequence()
    {
        static const SimulatedSequence instance = []
        {
            SimulationParams params = SimulationParams::ideal();
            params.width = 320;
            params.height = 240;
            return SimulatedSequence("corner", params, 2);
        }();
        return instance;
    }

    static PointStage stage()
    {
        PointStage::TParams params;
        params.method = GetParam();
        PointDetector::TParams detector;
        detector.detector = "fast";
        return PointStage(params, {}, detector, {}, {}, {});
    }
};
}  // namespace

TEST_P(PointStageTest, findsPointsWhereTheyAre)
{
    const PointStage stage = PointStageTest::stage();
    const RgbdFrame first = sequence().frame(0), second = sequence().frame(3);
    const Eigen::Isometry3d T_cur_ref = sequence().trueMotion(3, 0);
    const PointReference reference = stage.makeReference(first, stage.prepare(first));
    ASSERT_GT(reference.points.size(), 60U);
    // Predicted from the identity: the search has to do the rest.
    const auto found = stage.correspond(
        reference, second, stage.prepare(second), Eigen::Isometry3d::Identity(), 1);
    ASSERT_GT(found.size(), reference.points.size() / 3);
    std::vector<double> errors_px, errors;
    std::set<int> used;
    for (const PointTrack& track : found)
    {
        ASSERT_GE(track.ref, 0);
        ASSERT_LT(track.ref, static_cast<int>(reference.points.size()));
        EXPECT_TRUE(used.insert(track.ref).second) << "a reference point twice";
        const Eigen::Vector3d expected =
            T_cur_ref * reference.points[static_cast<size_t>(track.ref)].p_cam.mean;
        errors_px.push_back((second.camera.project(expected) - track.cur.uv_px).norm());
        errors.push_back((expected - track.cur.p_cam.mean).norm());
    }
    std::sort(errors.begin(), errors.end());
    std::sort(errors_px.begin(), errors_px.end());
    // Corners by FAST are whole pixels in both images.
    EXPECT_LT(errors_px[errors_px.size() / 2], std::string(GetParam()) == "track" ? 0.3 : 1.0);
    EXPECT_LT(errors[errors.size() / 2], 0.005);
}

TEST_P(PointStageTest, predictionDecidesWhereToLook)
{
    const PointStage stage = PointStageTest::stage();
    const RgbdFrame frame = sequence().frame(0);
    const PreparedPoints prepared = stage.prepare(frame);
    const PointReference reference = stage.makeReference(frame, prepared);
    EXPECT_FALSE(
        stage.correspond(reference, frame, prepared, Eigen::Isometry3d::Identity(), 1).empty());
    // Predicted behind the camera, or where nothing is: nothing is found.
    Eigen::Isometry3d away = Eigen::Isometry3d::Identity();
    away.translation().z() = -20;
    EXPECT_TRUE(stage.correspond(reference, frame, prepared, away, 1).empty());
    away.translation() << 50, 0, 0;
    EXPECT_TRUE(stage.correspond(reference, frame, prepared, away, 1).empty());
}

TEST_P(PointStageTest, framesWithoutImageOrDepthAreNoReferences)
{
    const PointStage stage = PointStageTest::stage();
    const RgbdFrame good = sequence().frame(0);
    const PreparedPoints ofGood = stage.prepare(good);
    const PointReference reference = stage.makeReference(good, ofGood);
    RgbdFrame blind = good, blank = good, noDepth = good;
    blind.gray = cv::Mat();
    blank.gray = cv::Mat(good.gray.size(), CV_8UC1, cv::Scalar(90));
    noDepth.depth = cv::Mat(good.depth.size(), CV_32FC1, cv::Scalar(0));
    for (const RgbdFrame& frame : {blind, blank, noDepth})
    {
        const PreparedPoints prepared = stage.prepare(frame);
        const PointReference none = stage.makeReference(frame, prepared);
        EXPECT_TRUE(none.points.empty());
        const auto found =
            stage.correspond(reference, frame, prepared, Eigen::Isometry3d::Identity(), 1);
        // Tracks need no depth.
        const bool isTracked =
            std::string(GetParam()) == "track" && frame.gray.data == good.gray.data;
        EXPECT_EQ(!found.empty(), isTracked);
        for (const PointTrack& track : found)
        {
            EXPECT_FALSE(track.cur.hasDepth);
        }
        EXPECT_TRUE(stage.correspond(none, good, ofGood, Eigen::Isometry3d::Identity(), 1).empty());
    }
}

TEST_P(PointStageTest, pointsAreFoundWhateverDepthsCount)
{
    const RgbdFrame frame = sequence().frame(0);
    for (const auto& [least, most] :
         {std::pair(0.1, 20.0), std::pair(0.1, 0.5), std::pair(2.0, 5.0)})
    {
        PointStage::TParams params;
        params.method = GetParam();
        PointLifter::TParams lifter;
        lifter.minDepth = least;
        lifter.maxDepth = most;
        EXPECT_TRUE(PointStage(params, {}, {}, {}, lifter, {}).findsPoint(frame)) << most;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Methods,
    PointStageTest,
    testing::Values("track", "match"),
    [](const auto& method) { return std::string(method.param); });

TEST(PointStage, refusesUnknownMethods)
{
    PointStage::TParams params;
    params.method = "guess";
    EXPECT_THROW(params.check(), std::invalid_argument);
}
}  // namespace pointplane
