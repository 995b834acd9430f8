// SPDX-License-Identifier: BSD-3-Clause
#include "OverlaySink.h"

#include <limits>
#include <string>

#include "TempDir.h"
#include "rawlog_samples.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
[[nodiscard]] OutputItem itemAt(double stamp, double x, TrackingStatus status)
{
    OutputItem out;
    out.source.converted.emplace();
    out.source.converted->frame.stamp = stamp;
    out.source.converted->frame.gray = cv::Mat(240, 320, CV_8UC1, cv::Scalar(90));
    out.frame.emplace();
    out.frame->motion.status = status;
    out.frame->motion.diagnostics.observableDirections = 6;
    out.frame->motion.cameraPose.mean.translation().x() = x;
    return out;
}

/** Of the last one of these frames. */
[[nodiscard]] std::string pictureAfter(const std::vector<OutputItem>& items)
{
    const test::TempDir dir;
    OverlaySink sink(dir / "pictures", 1);
    for (const OutputItem& item : items)
    {
        sink.add(item);
    }
    return test::readBytes(dir / "pictures/000000.jpg");
}

constexpr double kNoStamp = std::numeric_limits<double>::quiet_NaN();
const OutputItem kFirst = itemAt(10, 0, TrackingStatus::First);
const OutputItem kThird = itemAt(10.2, 0.02, TrackingStatus::Tracked);
}  // namespace

/** What a prediction was wrong by is no motion in the time of a frame. */
TEST(OverlaySink, theSpeedIsThatBetweenMeasuredFrames)
{
    const std::string picture = pictureAfter({kFirst, kThird});
    EXPECT_NE(picture, pictureAfter({kFirst, itemAt(10.2, 0.1, TrackingStatus::Tracked)}));
    EXPECT_EQ(picture, pictureAfter({kFirst, itemAt(10.1, 5, TrackingStatus::Predicted), kThird}));
    EXPECT_EQ(picture, pictureAfter({kFirst, itemAt(10.1, 5, TrackingStatus::Lost), kThird}));
    EXPECT_EQ(
        pictureAfter({kFirst, itemAt(10.1, 5, TrackingStatus::Lost)}),
        pictureAfter({kFirst, itemAt(10.1, 0, TrackingStatus::Lost)}))
        << "a guess is no speed";
}

/** Who looks at the picture alone would take it for a measurement. */
TEST(OverlaySink, showsThatAMotionIsInPartPredicted)
{
    OutputItem inPart = kThird, predicted = kThird;
    inPart.frame->motion.diagnostics.observableDirections = 4;
    EXPECT_NE(pictureAfter({kFirst, kThird}), pictureAfter({kFirst, inPart}));
    predicted.frame->motion.status = inPart.frame->motion.status = TrackingStatus::Predicted;
    EXPECT_EQ(pictureAfter({kFirst, predicted}), pictureAfter({kFirst, inPart}));
}

TEST(OverlaySink, theTimeIsThatSinceTheFirstStamp)
{
    const std::string picture = pictureAfter({kFirst, kThird});
    EXPECT_EQ(picture, pictureAfter({itemAt(kNoStamp, 0, TrackingStatus::Lost), kFirst, kThird}));
    EXPECT_EQ(picture, pictureAfter({kFirst, itemAt(kNoStamp, 0, TrackingStatus::Lost), kThird}));
    EXPECT_NE(
        pictureAfter({itemAt(kNoStamp, 0, TrackingStatus::Lost)}),
        pictureAfter({itemAt(10, 0, TrackingStatus::Lost)}))
        << "it has no time";
}
}  // namespace pointplane
