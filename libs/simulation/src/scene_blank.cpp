// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/SceneBuilder.h>

#include <cmath>

#include "scenes_internal.h"

namespace pointplane
{
namespace
{
using Finish = SceneBuilder::Finish;

/** Blank surfaces need no fine picture: only the light varies. */
constexpr double kBlankTexel = 0.01;

Finish blank(double grey, bool hasDepth = true)
{
    return {{0.97 * grey, grey, 1.02 * grey}, kBlankTexel, {}, hasDepth};
}

Scene corridor(const std::string& name, bool floorHasDepth)
{
    SceneBuilder builder(name);
    const double begin = -15, end = 17, half = 1.0, height = 2.5;
    builder.addWall({begin, half, 0}, {end, half, 0}, height, blank(205));
    builder.addWall({end, -half, 0}, {begin, -half, 0}, height, blank(195));
    builder.addWall({end, half, 0}, {end, -half, 0}, height, blank(150));
    builder.addWall({begin, -half, 0}, {begin, half, 0}, height, blank(150));
    builder.addRectangle(
        {begin, -half, 0}, {end - begin, 0, 0}, {0, 2 * half, 0}, blank(60, floorHasDepth));
    builder.addRectangle(
        {begin, half, height}, {end - begin, 0, 0}, {0, -2 * half, 0}, blank(170, floorHasDepth));
    CameraMotion& motion = builder.scene().motion;
    motion.eye = {-3, 0, 1.3};
    motion.target = {0, 0.5, 1.25};
    motion.velocity = {0.25, 0, 0};
    motion.handSpeed = 0.15;
    motion.handTurnRate = 0.15;
    Lamp lamp;
    lamp.position = {1, 0, 2.4};
    lamp.power = 0.2;
    lamp.ambient = 0.8;
    return builder.build(lamp);
}
}  // namespace

Scene makeNoTexture(std::uint64_t /*seed*/)
{
    SceneBuilder builder("notexture");
    // Panels like a folding screen, 35 degrees to either side, on the floor of a hall.
    const double width = 0.75, fold = 35 * 3.14159265358979323846 / 180;
    Eigen::Vector3d left(0, 4 * width * std::cos(fold), 0);
    for (int i = 0; i < 8; ++i)
    {
        const double depth = i % 2 == 0 ? width * std::sin(fold) : -width * std::sin(fold);
        const Eigen::Vector3d right = left + Eigen::Vector3d(depth, -width * std::cos(fold), 0);
        builder.addWall(left, right, 1.7, blank(210));
        left = right;
    }
    builder.addWall({-4, 6, 0}, {3, 6, 0}, 6, blank(155));
    builder.addWall({3, 6, 0}, {3, -6, 0}, 6, blank(150));
    builder.addWall({3, -6, 0}, {-4, -6, 0}, 6, blank(145));
    builder.addRectangle({-4, -6, 0}, {7, 0, 0}, {0, 12, 0}, blank(120));
    CameraMotion& motion = builder.scene().motion;
    motion.eye = {-2.0, 0, 1.2};
    motion.target = {0.2, 0, 0.7};
    motion.handSpeed = 0.25;
    motion.handTurnRate = 0.22;
    Lamp lamp;
    lamp.position = {-2.0, 1.5, 2.9};
    return builder.build(lamp);
}

Scene makeCabinet(std::uint64_t seed)
{
    SceneBuilder builder("cabinet");
    Random random({seed, 3});
    const auto drawers = [](Canvas& canvas)
    {
        const double w = canvas.width(), h = canvas.height();
        for (int i = 1; i < 4; ++i)
        {
            canvas.line(0.01, i * h / 4, w - 0.01, i * h / 4, 0.004, {90, 90, 90});
        }
        for (int i = 0; i < 4; ++i)
        {
            canvas.fillRectangle(0.38 * w, (i + 0.3) * h / 4, 0.24 * w, 0.02, {120, 120, 125});
        }
    };
    const auto scuffs = [&random](Canvas& canvas)
    {
        canvas.addNoise(0.4, 2, 2, random);
        for (int i = 0; i < 30; ++i)
        {
            const double x = random.uniform(0.2, canvas.width() - 0.2);
            const double y = random.uniform(0.2, canvas.height() - 0.2);
            canvas.line(x, y, x + random.uniform(-0.1, 0.1), y + 0.05, 0.006, {95, 105, 110});
        }
    };
    // Door side to the camera, drawers beside it.
    const Eigen::Vector3d size(0.55, 0.8, 1.0);
    builder.addBox({0, 0, 0}, size, 0.5, {{200, 205, 208}, 2e-3, drawers}, blank(190));
    builder.addRectangle({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, {{120, 135, 140}, 4e-3, scuffs});
    builder.addWall({4, 5, 0}, {4, -5, 0}, 3, blank(170));
    builder.addWall({-5, 4.5, 0}, {4, 4.5, 0}, 3, blank(185));
    builder.addWall({4, -4.5, 0}, {-5, -4.5, 0}, 3, blank(180));
    CameraMotion& motion = builder.scene().motion;
    motion.eye = {-1.6, -0.1, 1.45};
    motion.target = {0, 0, 0.6};
    motion.orbitAmplitude = 0.7;
    motion.orbitPeriod = 16;
    motion.handSpeed = 0.15;
    motion.handTurnRate = 0.15;
    Lamp lamp;
    lamp.position = {-1.5, 1.2, 2.8};
    return builder.build(lamp);
}

Scene makeCorridor(std::uint64_t /*seed*/) { return corridor("corridor", false); }

Scene makeCorridorWithFloor(std::uint64_t /*seed*/) { return corridor("corridor_floor", true); }
}  // namespace pointplane
