// SPDX-License-Identifier: BSD-3-Clause
#include "ReferenceWindow.h"

#include <pointplane/core/se3.h>

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace pointplane
{
namespace
{
Eigen::Isometry3d shifted(double x)
{
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation().x() = x;
    return T;
}

Reference reference(int id, double x = 0)
{
    Reference out;
    out.id = id;
    out.stamp = id / 30.0;
    out.T_world_cam = shifted(x);
    return out;
}

std::vector<int> ids(const ReferenceWindow& window)
{
    std::vector<int> out;
    for (const Reference* r : window.active())
    {
        out.push_back(r->id);
    }
    return out;
}

using Ids = std::vector<int>;
}  // namespace

TEST(ReferenceWindow, previousFirstThenKeyframesNewestFirst)
{
    ReferenceWindow window({});
    EXPECT_TRUE(window.empty());
    EXPECT_TRUE(window.active().empty());
    window.add(reference(1), true);
    EXPECT_FALSE(window.empty());
    EXPECT_EQ(ids(window), Ids({1}));  // not twice
    window.add(reference(2), false);
    EXPECT_EQ(ids(window), Ids({2, 1}));
    window.add(reference(3), true);
    EXPECT_EQ(ids(window), Ids({3, 1}));
    window.add(reference(4), false);
    EXPECT_EQ(ids(window), Ids({4, 3, 1}));
    EXPECT_EQ(window.previous().id, 4);
}

TEST(ReferenceWindow, asManyPlacesAreKeptAsWanted)
{
    for (const int most : {0, 2, 20})
    {
        ReferenceParams params;
        params.maxKeyframes = 1;
        params.maxPlaces = most;
        ReferenceWindow window(params);
        for (int id = 1; id <= 5; ++id)
        {
            window.add(reference(id, id), true);
        }
        Ids kept;
        for (const Reference& place : window.places())
        {
            kept.push_back(place.id);
        }
        EXPECT_EQ(kept, most == 0 ? Ids() : most == 2 ? Ids({3, 4}) : Ids({1, 2, 3, 4}));
    }
}

TEST(ReferenceWindow, oldestKeyframeIsDropped)
{
    ReferenceParams params;
    params.maxKeyframes = 2;
    ReferenceWindow window(params);
    for (int i = 1; i <= 5; ++i)
    {
        window.add(reference(i), true);
    }
    window.add(reference(6), false);
    EXPECT_EQ(ids(window), Ids({6, 5, 4}));
}

TEST(ReferenceWindow, frameToFrameHasThePreviousOnly)
{
    ReferenceParams params;
    params.reference = "previous";
    ReferenceWindow window(params);
    window.add(reference(1), true);
    window.add(reference(2), true);
    EXPECT_EQ(ids(window), Ids({2}));
    EXPECT_TRUE(window.needsKeyframe(shifted(0), 1));
    EXPECT_TRUE(window.isNewest(window.previous()));
}

TEST(ReferenceWindow, newKeyframeAfterDistanceAngleOrLossOfOverlap)
{
    ReferenceParams params;
    params.keyframeDistance = 0.15;
    params.keyframeAngleDeg = 10;
    params.keyframeMinOverlap = 0.5;
    ReferenceWindow window(params);
    EXPECT_TRUE(window.needsKeyframe(shifted(0), 1));  // there is none yet
    window.add(reference(1, 3), true);
    window.add(reference(2, 3.14), false);
    EXPECT_FALSE(window.needsKeyframe(shifted(3.149), 1));
    EXPECT_TRUE(window.needsKeyframe(shifted(3.151), 1));
    EXPECT_TRUE(window.needsKeyframe(shifted(2.849), 1));
    const auto turned = [](double deg)
    {
        Vector6d xi = Vector6d::Zero();
        xi[4] = deg * M_PI / 180;
        return Eigen::Isometry3d(shifted(3) * se3Exp(xi));
    };
    EXPECT_FALSE(window.needsKeyframe(turned(9.9), 1));
    EXPECT_TRUE(window.needsKeyframe(turned(10.1), 1));
    EXPECT_FALSE(window.needsKeyframe(shifted(3), 0.51));
    EXPECT_TRUE(window.needsKeyframe(shifted(3), 0.49));
}

TEST(ReferenceWindow, newestTellsTheOverlap)
{
    ReferenceWindow window({});
    window.add(reference(1), true);
    window.add(reference(2), true);
    window.add(reference(3), false);
    const auto active = window.active();
    EXPECT_FALSE(window.isNewest(*active[0]));  // the previous frame is no key frame
    EXPECT_TRUE(window.isNewest(*active[1]));
    EXPECT_FALSE(window.isNewest(*active[2]));
}

/** Four points and two planes; of the one half is found again, of the other nothing. */
TEST(ReferenceWindow, whatCannotBeFoundDoesNotCountInTheOverlap)
{
    ReferenceWindow window({});
    Reference keyframe = reference(1);
    keyframe.points.points.resize(4);
    keyframe.planes.planes.resize(2);
    window.add(keyframe, true);
    Association found;
    found.reference = window.active()[0];
    found.points.resize(2);
    EXPECT_EQ(window.overlap({found}, {}), 0);
    EXPECT_EQ(window.overlap({found}, {true, false}), 0.5);
    EXPECT_EQ(window.overlap({found}, {false, true}), 0);
    EXPECT_EQ(window.overlap({found}, {false, false}), 1);
    EXPECT_EQ(window.overlap({}, {}), 0);
}

TEST(ReferenceWindow, velocityOfThePreviousFrameIsRefinedInItsKeyframeToo)
{
    ReferenceWindow window({});
    window.add(reference(1), true);
    window.refinePreviousVelocity(Vector6d::Constant(2));
    EXPECT_EQ(window.previous().velocity, Vector6d::Constant(2));
    window.add(reference(2), false);
    window.refinePreviousVelocity(Vector6d::Constant(3));
    const auto active = window.active();
    EXPECT_EQ(active[0]->velocity, Vector6d::Constant(3));
    EXPECT_EQ(active[1]->velocity, Vector6d::Constant(2));
}

TEST(ReferenceWindow, clearForgets)
{
    ReferenceWindow window({});
    window.add(reference(1), true);
    window.clear();
    EXPECT_TRUE(window.empty());
    EXPECT_TRUE(window.active().empty());
}

TEST(ReferenceWindow, refusesParametersOutOfRange)
{
    const auto refused = [](auto change)
    {
        ReferenceParams params;
        change(params);
        EXPECT_THROW(ReferenceWindow{params}, std::invalid_argument);
    };
    refused([](auto& p) { p.reference = "none"; });
    refused([](auto& p) { p.maxKeyframes = 0; });
    refused([](auto& p) { p.keyframeDistance = 0; });
    refused([](auto& p) { p.keyframeAngleDeg = 0; });
    refused([](auto& p) { p.keyframeMinOverlap = 1; });
}
}  // namespace pointplane
