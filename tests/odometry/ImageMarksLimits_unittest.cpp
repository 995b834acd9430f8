// SPDX-License-Identifier: BSD-3-Clause
// How much it takes before points that stand in the image are marks: just below each limit they are
// not, just above it they are.
#include <cmath>
#include <functional>
#include <vector>

#include "standing_points.h"
#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
/** Depth of two walls, one four times as far, that changes all over the image. */
void showChange(standing::Seen& seen, const std::function<double(double)>& change)
{
    const standing::Circle circle;
    for (int i = 0; i < circle.numPoints; ++i)
    {
        const double z = i % 5 < 3 ? 1 : 4;
        seen.add(
            standing::pointAt(circle.place_px(i), z),
            standing::pointAt(circle.place_px(i), change(z)));
    }
}

}  // namespace

TEST(ImageMarksLimits, pointsThatMoveByThreeTenthsOfAPixelDoNotStand)
{
    standing::Circle circle;
    circle.shift_px = 0.29;
    EXPECT_EQ(circle.marks(), 40);
    circle.shift_px = 0.31;
    EXPECT_EQ(circle.marks(), 0);
}

TEST(ImageMarksLimits, depthHasChangedByMoreThanThreeSigmas)
{
    standing::Circle circle;
    const double sigma = std::sqrt(2.0) * standing::kSigma_m;  // of a difference
    circle.change = 2.95 * sigma;
    EXPECT_EQ(circle.marks(), 0);
    circle.change = 3.05 * sigma;
    EXPECT_EQ(circle.marks(), 40);
}

TEST(ImageMarksLimits, fewerThanTwentyPointsTellNothing)
{
    standing::Circle circle;
    circle.numChanged = 12;
    circle.numPoints = 19;
    EXPECT_EQ(circle.marks(), 0);
    circle.numPoints = 20;
    EXPECT_EQ(circle.marks(), 20);
}

TEST(ImageMarksLimits, fewerThanEightThatChangeMayDoByChance)
{
    standing::Circle circle;
    circle.numChanged = 7;
    EXPECT_EQ(circle.marks(), 0);
    circle.numChanged = 8;
    EXPECT_EQ(circle.marks(), 40);
}

TEST(ImageMarksLimits, lessThanASixthThatChangesIsSomethingThatMoves)
{
    standing::Circle circle;
    circle.numPoints = 120;
    circle.numChanged = 19;
    EXPECT_EQ(circle.marks(), 0);
    circle.numChanged = 21;
    EXPECT_EQ(circle.marks(), 120);
}

/** Near the point that the camera moves to, points stand while their depth changes. */
TEST(ImageMarksLimits, aCameraThatMovesWouldHaveMovedMarks)
{
    standing::Circle circle;
    circle.change = 0.1;  // a twentieth of the depth: 0.9 px of 18
    circle.radius_px = 17;
    EXPECT_EQ(circle.marks(), 0);
    circle.radius_px = 19;
    EXPECT_EQ(circle.marks(), 40);
}

TEST(ImageMarksLimits, pointsWithoutDepthTellNothing)
{
    for (const bool isBefore : {true, false})
    {
        standing::Seen seen;
        standing::Circle().showTo(seen);
        for (PointTrack& track : seen.association.points)
        {
            PointFeature& before = seen.reference.points.points[static_cast<size_t>(track.ref)];
            (isBefore ? before : track.cur).hasDepth = false;
        }
        EXPECT_EQ(seen.marks(), 0);
    }
}

/** No change of one kind can be taken for one of another. */
TEST(ImageMarksLimits, anOffsetAScaleAndAnOffsetOfDisparityAreTheSensors)
{
    const std::vector<std::function<double(double)>> changes{
        [](double z) { return z + 0.2; },
        [](double z) { return 0.9 * z; },
        [](double z) { return 1 / (1 / z + 0.01); }};
    for (size_t i = 0; i < changes.size(); ++i)
    {
        standing::Seen seen;
        showChange(seen, changes[i]);
        EXPECT_EQ(seen.marks(), 0) << "change " << i;
    }
    standing::Seen seen;
    showChange(seen, [](double z) { return z + 0.01 * z * z * z; });
    EXPECT_EQ(seen.marks(), 40);
}

TEST(ImageMarksLimits, aSensorThatChangesDoesNotClearASuspicion)
{
    ImageMarks marks(standing::kWindowPx);
    EXPECT_FALSE(standing::teachMarks(marks));
    standing::Seen changed;
    showChange(changed, [](double z) { return 0.9 * z; });
    EXPECT_FALSE(standing::teach(marks, changed));
    EXPECT_TRUE(standing::teachMarks(marks));
}

TEST(ImageMarksLimits, theNewestReferenceThatShowsMarksKeepsTheSuspicion)
{
    ImageMarks marks(standing::kWindowPx);
    EXPECT_FALSE(marks.learn({}, {{{20, 20}, 1}, {{20, 20}, 0}}, standing::camera()));
    standing::Seen seen;
    seen.reference.id = 1;
    standing::Circle().showTo(seen);
    EXPECT_TRUE(standing::teach(marks, seen));
}
}  // namespace pointplane
