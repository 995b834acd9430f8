// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/Scene.h>
#include <pointplane/simulation/SimulatedSequence.h>
#include <pointplane/simulation/scenes.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
SimulationParams tiny(SimulationParams params = {})
{
    params.width = 160;
    params.height = 120;
    params.exposure = 0;
    return params;
}

/** Area of the n-th largest plane and the number of distinct normals of planes over 2 %. */
struct PlaneCensus
{
    int large{0};
    std::vector<Eigen::Vector3d> normals;
};

PlaneCensus census(const SimulatedSequence& sequence, int frame)
{
    const RgbdFrame rgbd = sequence.frame(frame);
    const TruePlanes planes = sequence.truePlanes(frame);
    PlaneCensus out;
    for (std::size_t i = 0; i < planes.planes_cam.size(); ++i)
    {
        const cv::Mat seen = (planes.labels == static_cast<double>(i + 1)) & (rgbd.depth > 0);
        if (cv::countNonZero(seen) < 0.02 * 160 * 120)
        {
            continue;
        }
        ++out.large;
        const Eigen::Vector3d n = planes.planes_cam[i].n;
        bool isNew = true;
        for (const Eigen::Vector3d& other : out.normals)
        {
            isNew = isNew && std::abs(n.dot(other)) < 0.97;
        }
        if (isNew)
        {
            out.normals.push_back(n);
        }
    }
    return out;
}
}  // namespace

class EveryScene : public testing::TestWithParam<std::string>
{
};

TEST_P(EveryScene, fillsTheViewWhateverTheSeed)
{
    const SimulatedSequence first(GetParam(), tiny(), 0);
    for (std::uint64_t seed = 0; seed < 6; ++seed)
    {
        const SimulatedSequence sequence(first.scene(), tiny(), seed);
        for (int i = 0; i < sequence.numFrames(); i += 45)
        {
            cv::Mat colour;
            const RgbdFrame frame = sequence.frame(i, &colour);
            const double readable = cv::countNonZero(frame.depth > 0) / (160.0 * 120.0);
            EXPECT_GT(readable, GetParam() == "corridor" ? 0.4 : 0.7)
                << "seed " << seed << " frame " << i;
            cv::Mat black;
            cv::inRange(colour, cv::Scalar(0, 0, 0), cv::Scalar(0, 0, 0), black);
            EXPECT_LT(cv::countNonZero(black), 40) << "the scene has a hole: seed " << seed;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    scenes,
    EveryScene,
    testing::Values(
        "corner",
        "desk",
        "room",
        "notexture",
        "cabinet",
        "corridor",
        "corridor_floor",
        "person",
        "push",
        "door",
        "half",
        "seated"),
    [](const auto& scene) { return scene.param; });

TEST(scenes, listAndNamesAgree)
{
    EXPECT_EQ(sceneList().size(), 12U);
    for (const SceneInfo& info : sceneList())
    {
        EXPECT_EQ(makeScene(info.name, 1).name, info.name);
    }
    try
    {
        (void)makeScene("cave", 1);
        FAIL() << "an unknown scene was made";
    }
    catch (const std::invalid_argument& e)
    {
        EXPECT_THAT(
            e.what(), testing::AllOf(testing::HasSubstr("cave"), testing::HasSubstr("desk")));
    }
}

TEST(scenes, cornerShowsExactlyThreePlanesInEveryFrame)
{
    const SimulatedSequence first("corner", tiny(), 0);
    for (std::uint64_t seed = 0; seed < 6; ++seed)
    {
        const SimulatedSequence sequence(first.scene(), tiny(), seed);
        for (int i = 0; i < sequence.numFrames(); i += 30)
        {
            const PlaneCensus c = census(sequence, i);
            EXPECT_EQ(c.large, 3) << "seed " << seed << " frame " << i;
            EXPECT_EQ(c.normals.size(), 3U);
        }
    }
}

TEST(scenes, corridorHasOneDirectionOfPlanesAndWithFloorTwo)
{
    for (int i = 0; i < 540; i += 60)
    {
        EXPECT_EQ(census(SimulatedSequence("corridor", tiny(), 1), i).normals.size(), 1U);
    }
    EXPECT_EQ(census(SimulatedSequence("corridor_floor", tiny(), 1), 0).normals.size(), 2U);
}

TEST(scenes, noTextureIsBlankOnEachPanel)
{
    const SimulatedSequence sequence("notexture", tiny(SimulationParams::ideal()), 1);
    const RgbdFrame frame = sequence.frame(0);
    const TruePlanes planes = sequence.truePlanes(0);
    // Pixels next to an edge are mixtures.
    cv::Mat least, most;
    cv::erode(planes.labels, least, cv::Mat());
    cv::dilate(planes.labels, most, cv::Mat());
    const cv::Mat inside = least == most;
    int compared = 0, largest = 0;
    for (int v = 0; v < 120; ++v)
    {
        for (int u = 1; u < 160; ++u)
        {
            if (inside.at<uchar>(v, u) != 0 && inside.at<uchar>(v, u - 1) != 0)
            {
                const int step = frame.gray.at<uchar>(v, u) - frame.gray.at<uchar>(v, u - 1);
                largest = std::max(largest, std::abs(step));
                ++compared;
            }
        }
    }
    EXPECT_GT(compared, 15000);
    EXPECT_LE(largest, 4) << "only light varies";
}
}  // namespace pointplane
