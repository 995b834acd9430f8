// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/SceneBuilder.h>

#include "scenes_internal.h"

namespace pointplane
{
namespace
{
using Finish = SceneBuilder::Finish;

/** A cover or package: coloured, with a label and shapes. */
Painter package(Random& random)
{
    return [&random](Canvas& canvas)
    {
        const double w = canvas.width(), h = canvas.height();
        canvas.shapes(0, 0, w, h, 6, random);
        if (w > 0.05 && h > 0.03)
        {
            canvas.fillRectangle(
                0.1 * w, 0.2 * h, 0.8 * w, 0.5 * h, randomColour(random, 150, 245));
            canvas.writing(0.13 * w, 0.24 * h, 0.75 * w, 0.44 * h, 0.15 * h, random);
        }
        canvas.addNoise(0.02, 4, 3, random);
    };
}

Finish packageFinish(Random& random)
{
    return {randomColour(random, 30, 200), 1e-3, package(random)};
}

void addWalls(SceneBuilder& builder, Random& random)
{
    const auto posters = [&random](Canvas& canvas)
    {
        canvas.addNoise(0.6, 4, 3, random);
        canvas.addNoise(0.04, 3, 3, random);
        for (double x = 0.3; x + 0.5 < canvas.width(); x += random.uniform(0.75, 1.05))
        {
            // One random number a statement: the order of arguments is the compiler's choice.
            const double top = random.uniform(0.75, 1.05);
            const double height = random.uniform(0.5, 0.6);
            canvas.poster(x, top, 0.42, height, random);
        }
    };
    const auto floor = [&random](Canvas& canvas)
    {
        canvas.boards(0.14, 1.2, 0.12, random);
        canvas.addNoise(0.05, 6, 3, random);
    };
    builder.addWall({2.6, 2.4, 0}, {2.6, -2.4, 0}, 2.6, {{192, 204, 208}, 3e-3, posters});
    builder.addWall({-2.5, 2.4, 0}, {2.6, 2.4, 0}, 2.6, {{196, 200, 196}, 3e-3, posters});
    builder.addWall({2.6, -2.4, 0}, {-2.5, -2.4, 0}, 2.6, {{200, 200, 190}, 3e-3, posters});
    builder.addWall({-2.5, -2.4, 0}, {-2.5, 2.4, 0}, 2.6, {{200, 200, 200}, 3e-3, posters});
    builder.addRectangle({-2.5, -2.4, 0}, {5.1, 0, 0}, {0, 4.8, 0}, {{70, 105, 140}, 3e-3, floor});
}

void addDesk(SceneBuilder& builder, Random& random, double top)
{
    const auto wood = [&random](Canvas& canvas)
    {
        canvas.boards(0.2, 3, 0.05, random);
        canvas.addNoise(0.03, 5, 4, random);
        for (int i = 0; i < 5; ++i)  // papers
        {
            const double x = random.uniform(0.02, canvas.width() - 0.25);
            const double y = random.uniform(0.02, canvas.height() - 0.33);
            canvas.fillRectangle(x, y, 0.21, 0.297, {235, 238, 238});
            canvas.writing(x + 0.02, y + 0.02, 0.17, 0.25, 0.014, random);
        }
    };
    const Finish edge{{80, 110, 140}, 2e-3, {}};
    // The board of 1.0 x 1.7 m and its two side panels.
    builder.addBox(
        {0.6, 0, top - 0.03}, {1.0, 1.7, 0.03}, 0, edge, {{110, 150, 180}, 1.5e-3, wood});
    builder.addBox({0.6, -0.82, 0}, {0.9, 0.03, top - 0.03}, 0, edge, edge);
    builder.addBox({0.6, 0.82, 0}, {0.9, 0.03, top - 0.03}, 0, edge, edge);
}

void addMonitor(SceneBuilder& builder, Random& random, double top)
{
    const Finish dark{{45, 45, 45}, 2e-3, {}};
    const auto screen = [&random](Canvas& canvas)
    {
        const double w = canvas.width(), h = canvas.height();
        canvas.fillRectangle(0.02, 0.02, w - 0.04, h - 0.04, {120, 90, 50});
        canvas.fillRectangle(0.05, 0.05, 0.5 * w, 0.6 * h, {235, 235, 230});
        canvas.writing(0.06, 0.06, 0.45 * w, 0.55 * h, 0.018, random);
        canvas.shapes(0.6 * w, 0.1 * h, 0.35 * w, 0.7 * h, 12, random);
    };
    builder.addBox({0.93, 0.35, top}, {0.2, 0.25, 0.015}, 0, dark, dark);
    builder.addBox({0.98, 0.35, top + 0.015}, {0.04, 0.08, 0.1}, 0, dark, dark);
    builder.addBox({0.97, 0.35, top + 0.115}, {0.05, 0.52, 0.32}, 0, dark, dark);
    builder.addWall(
        {0.943, 0.61, top + 0.115}, {0.943, 0.09, top + 0.115}, 0.32, {{30, 30, 30}, 1e-3, screen});
}

void addKeyboard(SceneBuilder& builder, double top)
{
    const auto keys = [](Canvas& canvas)
    {
        for (double x = 0.012; x + 0.02 < canvas.width(); x += 0.019)
        {
            for (double y = 0.012; y + 0.02 < canvas.height(); y += 0.019)
            {
                canvas.fillRectangle(x, y, 0.016, 0.016, {60, 60, 60});
                canvas.fillCircle(x + 0.007, y + 0.007, 0.003, {220, 220, 220});
            }
        }
    };
    const Finish side{{30, 30, 30}, 1e-3, {}};
    builder.addBox({0.55, 0.3, top}, {0.15, 0.44, 0.02}, 0.08, side, {{30, 30, 30}, 0.8e-3, keys});
}

void addObjects(SceneBuilder& builder, Random& random, double top)
{
    const auto box = [&](double x, double y, double z, double w, double d, double h, double yaw)
    {
        const Finish sides = packageFinish(random);
        builder.addBox({x, y, z}, {w, d, h}, yaw, sides, packageFinish(random));
    };
    const auto can = [&](double x, double y, double z, double radius, double height)
    {
        const Finish lid{randomColour(random, 80, 200), 1e-3, {}};
        builder.addCylinder({x, y, z}, radius, height, packageFinish(random), lid);
    };
    box(0.85, -0.35, top, 0.2, 0.3, 0.25, 0.4);
    box(0.5, -0.6, top, 0.14, 0.1, 0.2, -0.3);
    box(1.0, -0.68, top, 0.12, 0.26, 0.34, 0.1);
    box(0.3, 0.65, top, 0.16, 0.22, 0.12, 0.6);
    double height = top;
    for (int i = 0; i < 4; ++i)  // a pile of books
    {
        const double thick = random.uniform(0.02, 0.045);
        const double w = random.uniform(0.15, 0.19), d = random.uniform(0.21, 0.26);
        box(0.42, -0.22, height, w, d, thick, random.uniform(-0.3, 0.3));
        height += thick;
    }
    can(0.42, 0.02, top, 0.04, 0.1);
    can(0.66, -0.1, top, 0.033, 0.12);
    can(0.7, 0.7, top, 0.06, 0.22);
    can(0.22, 0.42, top, 0.04, 0.09);
    can(0.9, 0.0, top, 0.05, 0.28);
    // Shelves along the walls, a bin and a chest behind.
    box(2.3, -1.5, 0, 0.5, 0.9, 1.1, 0);
    box(2.35, 1.2, 0, 0.4, 1.2, 0.7, 0);
    can(1.6, -1.3, 0, 0.16, 0.4);
    box(-2.1, 1.4, 0, 0.6, 0.8, 0.9, 0.3);
    box(-2.2, -1.2, 0, 0.4, 1.1, 1.3, 0);
}
}  // namespace

SceneBuilder furnishedRoom(const std::string& name, std::uint64_t seed)
{
    SceneBuilder builder(name);
    Random random({seed, 2});
    const double top = 0.75;
    addWalls(builder, random);
    addDesk(builder, random, top);
    addMonitor(builder, random, top);
    addKeyboard(builder, top);
    addObjects(builder, random, top);
    return builder;
}

Lamp roomLamp()
{
    Lamp lamp;
    lamp.position = {0.0, 0.4, 2.5};
    return lamp;
}

Scene makeDesk(std::uint64_t seed)
{
    SceneBuilder builder = furnishedRoom("desk", seed);
    CameraMotion& motion = builder.scene().motion;
    motion.eye = {-0.45, 0.0, 1.35};
    motion.target = {0.8, 0.0, 0.75};
    motion.handSpeed = 0.3;
    motion.handTurnRate = 0.3;
    return builder.build(roomLamp());
}

Scene makeRoom(std::uint64_t seed)
{
    SceneBuilder builder = furnishedRoom("room", seed);
    CameraMotion& motion = builder.scene().motion;
    motion.eye = {-0.8, 0.0, 1.4};
    motion.target = {0.8, 0.0, 1.1};
    motion.turnPeriod = 18;
    motion.turnRadius = 0.4;
    motion.handSpeed = 0.15;
    motion.handTurnRate = 0.12;
    return builder.build(roomLamp());
}
}  // namespace pointplane
