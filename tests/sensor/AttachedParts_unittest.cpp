// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/sensor/AttachedParts.h>

#include <opencv2/imgproc.hpp>

#include <limits>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
constexpr int kWidth = 320, kHeight = 240;
const cv::Rect kRobot(80, 160, 160, 80);  // a sixth of the view
constexpr double kRobotShare = 1.0 / 6;

cv::Mat pattern(int seed)
{
    cv::Mat out(4 * kHeight, 4 * kWidth, CV_8UC1);
    cv::RNG random(static_cast<std::uint64_t>(seed));
    random.fill(out, cv::RNG::UNIFORM, 0, 255);
    cv::GaussianBlur(out, out, {}, 2);
    cv::normalize(out, out, 20, 230, cv::NORM_MINMAX);
    return out;
}

/** A patterned wall 2 m away, of which the camera sees another part when it has moved. */
RgbdFrame wall(int moved_px, double depth_m = 2)
{
    static const cv::Mat image = pattern(1);
    RgbdFrame out;
    out.gray = image({moved_px, moved_px / 2, kWidth, kHeight}).clone();
    out.depth = cv::Mat(kHeight, kWidth, CV_32FC1, cv::Scalar(depth_m));
    return out;
}

void put(const cv::Rect& place, const cv::Mat& gray, double depth_m, RgbdFrame& frame)
{
    gray({0, 0, place.width, place.height}).copyTo(frame.gray(place));
    frame.depth(place).setTo(depth_m);
}

RgbdFrame withRobot(RgbdFrame frame)
{
    static const cv::Mat image = pattern(2);
    put(kRobot, image, 0.4, frame);
    return frame;
}

/** A camera that stands, and what changes in `share` of the view at `depth_m`, beside the wall. */
RgbdFrame withChange(int seed, double share, double depth_m, double wall_m)
{
    RgbdFrame out = wall(0, wall_m);
    put({0, 0, cvRound(share * kWidth), kHeight}, pattern(3 + seed), depth_m, out);
    return out;
}

void addNoise(int seed, RgbdFrame& frame)
{
    cv::RNG random(static_cast<std::uint64_t>(seed));
    cv::Mat noise(frame.gray.size(), CV_16SC1);
    random.fill(noise, cv::RNG::NORMAL, 0, 3);
    cv::add(frame.gray, noise, frame.gray, {}, CV_8U);
    cv::Mat depthNoise(frame.depth.size(), CV_32FC1);
    random.fill(depthNoise, cv::RNG::NORMAL, 0, 0.003);
    frame.depth += depthNoise;
}

/** What is found in frames that move by 10 px each. \param frameAt of how far it has moved */
template <class FrameAt>
double shareOf(AttachedParts& parts, const FrameAt& frameAt, int numFrames = 5)
{
    for (int i = 0; i < numFrames; ++i)
    {
        RgbdFrame frame = frameAt(10 * i);
        addNoise(i, frame);
        parts.update(frame, {});
    }
    return parts.share();
}

template <class FrameAt>
double shareOf(const FrameAt& frameAt)
{
    AttachedParts parts;
    return shareOf(parts, frameAt);
}

/** A lamp goes out: nothing tells then that the part is no longer the same. */
TEST(AttachedParts, staysWhileTheImageIsDark)
{
    AttachedParts parts;
    ASSERT_GT(shareOf(parts, [](int moved) { return withRobot(wall(moved)); }), kRobotShare);
    for (int i = 5; i < 12; ++i)
    {
        RgbdFrame frame = withRobot(wall(10 * i));
        if (i < 8)
        {
            frame.gray.setTo(5);
        }
        addNoise(i, frame);
        parts.update(frame, {});
        EXPECT_GT(parts.share(), kRobotShare) << i;
    }
}

TEST(AttachedParts, findsWhatMovesWithTheCamera)
{
    AttachedParts parts;
    const double share = shareOf(parts, [](int moved) { return withRobot(wall(moved)); });
    EXPECT_GT(share, kRobotShare);
    EXPECT_LT(share, kRobotShare + 0.07) << "one cell more on each side";
    EXPECT_EQ(cv::countNonZero(parts.mask()(kRobot)), kRobot.area());
}

TEST(AttachedParts, tellsAfterTheSecondChangeOfTheView)
{
    AttachedParts parts;
    const auto frameAt = [](int moved) { return withRobot(wall(moved)); };
    EXPECT_EQ(shareOf(parts, frameAt, 2), 0) << "once may be chance";
    parts = {};
    EXPECT_GT(shareOf(parts, frameAt, 3), 0);
}

TEST(AttachedParts, aCameraThatStandsStillHasNone)
{
    EXPECT_EQ(shareOf([](int) { return withRobot(wall(0)); }), 0);
}

/** Noise of a wall without a pattern differs in each image. */
TEST(AttachedParts, aCameraThatStandsStillBeforeAPlainWallHasNone)
{
    const auto plain = [](int)
    {
        RgbdFrame out = wall(0);
        out.gray.setTo(128);
        return withRobot(out);
    };
    EXPECT_EQ(shareOf(plain), 0);
}

/** A person that fills most of the view is a small surface before a wall. */
TEST(AttachedParts, theWallBehindALargePersonIsNone)
{
    EXPECT_EQ(shareOf([](int moved) { return withChange(moved, 0.7, 1, 4); }), 0);
}

/** A floor keeps its depth, too, in front of a camera that drives along. */
TEST(AttachedParts, theRoomInWhichAFarScreenShowsAFilmIsNone)
{
    EXPECT_EQ(shareOf([](int moved) { return withChange(moved, 0.4, 5, 1); }), 0);
}

TEST(AttachedParts, aSurfaceThatMovesAlongItselfIsNone)
{
    const auto withFloor = [](int moved)
    {
        RgbdFrame out = wall(moved);
        static const cv::Mat image = pattern(4);
        put(kRobot, image(cv::Rect(2 * moved, 0, kRobot.width, kRobot.height)), 0.8, out);
        return out;
    };
    EXPECT_EQ(shareOf(withFloor), 0);
}

/** Neither does a floor without a pattern, or with lines that the camera drives along. */
TEST(AttachedParts, aPatternThatShowsNoMotionTellsNothing)
{
    for (const bool hasLines : {false, true})
    {
        cv::Mat image(kRobot.size(), CV_8UC1, cv::Scalar(128));
        for (int u = 0; hasLines && u < kRobot.width; u += 20)
        {
            cv::rectangle(image, {u, 0, 10, kRobot.height}, 30, cv::FILLED);
        }
        const auto withFloor = [&](int moved)
        {
            RgbdFrame out = wall(moved);
            put(kRobot, image, 0.8, out);
            return out;
        };
        EXPECT_EQ(shareOf(withFloor), 0) << hasLines;
    }
}

/** What is farther than most of what moves may be too far to show the motion. */
TEST(AttachedParts, theFarEndOfACorridorIsNone)
{
    const auto corridor = [](int moved)
    {
        RgbdFrame out = wall(moved);
        put({140, 100, 40, 40}, pattern(5), 3, out);
        return out;
    };
    EXPECT_EQ(shareOf(corridor), 0);
}

TEST(AttachedParts, aGripperThatGoesAwayIsForgotten)
{
    AttachedParts parts;
    EXPECT_GT(shareOf(parts, [](int moved) { return withRobot(wall(moved)); }), 0);
    EXPECT_EQ(shareOf(parts, [](int moved) { return wall(moved + 100); }), 0);
    EXPECT_TRUE(parts.mask().empty());
}

TEST(AttachedParts, missingImagesChangeNothing)
{
    AttachedParts parts;
    const double share = shareOf(parts, [](int moved) { return withRobot(wall(moved)); });
    RgbdFrame frame = wall(200);
    frame.gray.release();
    parts.update(frame, {});
    EXPECT_EQ(parts.share(), share);
    frame = wall(210);
    frame.depth.setTo(std::numeric_limits<float>::quiet_NaN());
    parts.update(frame, {});
    EXPECT_EQ(parts.share(), share);
}

/** Some cameras give colour first. */
TEST(AttachedParts, theFirstImagesMayBeWithoutDepth)
{
    const auto scene = [](int moved) { return withRobot(wall(moved)); };
    AttachedParts usual, late;
    RgbdFrame blank = scene(0);
    blank.depth.setTo(std::numeric_limits<float>::quiet_NaN());
    late.update(blank, {});
    const double share = shareOf(usual, scene);
    EXPECT_GT(share, 0);
    EXPECT_EQ(shareOf(late, scene), share);
}
}  // namespace
}  // namespace pointplane
