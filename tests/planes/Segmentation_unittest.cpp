// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/PlaneExtractor.h>
#include <pointplane/simulation/SimulatedSequence.h>

#include <opencv2/core.hpp>

#include "segmentation_score.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
using test::scoreSegmentation;
using test::SegmentationScore;

/** A label image of vertical stripes of ten columns. */
cv::Mat stripes(const std::vector<int>& labels)
{
    cv::Mat out(10, 10 * static_cast<int>(labels.size()), CV_8UC1);
    for (size_t i = 0; i < labels.size(); ++i)
    {
        out.colRange(10 * static_cast<int>(i), 10 * static_cast<int>(i) + 10).setTo(labels[i]);
    }
    return out;
}

SegmentationScore score(const std::vector<int>& truth, const std::vector<int>& found)
{
    const cv::Mat valid(10, 10 * static_cast<int>(truth.size()), CV_8UC1, cv::Scalar(255));
    return scoreSegmentation(stripes(truth), stripes(found), valid, 0.8, 100);
}

/** Frames spread over a sequence of a Kinect's depth at half resolution. */
SegmentationScore scoreScene(const char* scene, int numFrames)
{
    SimulationParams params;
    params.width = 320;
    params.height = 240;
    params.exposure = 0;
    const SimulatedSequence sequence(scene, params, 1);
    PlaneExtractor extractor({}, {});
    SegmentationScore total;
    for (int k = 0; k < numFrames; ++k)
    {
        const int i = k * (sequence.numFrames() - 1) / numFrames;
        const RgbdFrame frame = sequence.frame(i);
        const cv::Mat valid = frame.depth > 0;
        total += scoreSegmentation(
            sequence.truePlanes(i).labels,
            extractor.extract(frame.depth, frame.camera).labels,
            valid,
            0.8,
            frame.depth.rows * frame.depth.cols / 50);
    }
    return total;
}
}  // namespace

TEST(SegmentationScore, byHand)
{
    const SegmentationScore same = score({1, 1, 2, 2, 0}, {2, 2, 1, 1, 0});
    EXPECT_EQ(same.correct, 2);
    EXPECT_EQ(same.numTrue, 2);
    EXPECT_EQ(same.over + same.under + same.missed + same.spurious, 0);

    const SegmentationScore over = score({1, 1, 1, 1, 2}, {1, 1, 3, 3, 2});
    EXPECT_EQ(over.correct, 1);
    EXPECT_EQ(over.over, 1);
    EXPECT_EQ(over.missed + over.spurious, 0);

    const SegmentationScore under = score({1, 1, 2, 2, 3}, {1, 1, 1, 1, 2});
    EXPECT_EQ(under.correct, 1);
    EXPECT_EQ(under.under, 1);
    EXPECT_EQ(under.missed + under.spurious, 0);

    const SegmentationScore missed = score({1, 1, 2, 2, 0}, {1, 1, 0, 0, 3});
    EXPECT_EQ(missed.correct, 1);
    EXPECT_EQ(missed.missed, 1);
    EXPECT_EQ(missed.spurious, 1);
    // 80 % is enough, less is not.
    EXPECT_EQ(score({1, 1, 1, 1, 1}, {1, 1, 1, 1, 0}).correct, 1);
    EXPECT_EQ(score({1, 1, 1, 1, 0}, {1, 1, 1, 0, 0}).missed, 1);
    // Regions that are too small are nobody's fault.
    const cv::Mat all(10, 20, CV_8UC1, cv::Scalar(255));
    const SegmentationScore small =
        scoreSegmentation(stripes({1, 2}), stripes({1, 1}), all, 0.8, 101);
    EXPECT_EQ(small.numTrue, 0);
    EXPECT_EQ(small.numFound, 0);
}

TEST(Segmentation, ofSimulatedRooms)
{
    const SegmentationScore corner = scoreScene("corner", 12);
    EXPECT_GE(corner.correct, 0.9 * corner.numTrue);
    EXPECT_LE(corner.spurious, 0.1 * corner.numFound);
    const SegmentationScore zigzag = scoreScene("notexture", 12);
    EXPECT_GE(zigzag.correct, 0.8 * zigzag.numTrue);
    const SegmentationScore cabinet = scoreScene("cabinet", 12);
    EXPECT_GE(cabinet.correct, 0.7 * cabinet.numTrue);
}
}  // namespace pointplane
