// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/SceneBuilder.h>

#include "scenes_internal.h"

namespace pointplane
{
Scene makeCorner(std::uint64_t seed)
{
    SceneBuilder builder("corner");
    Random random({seed, 1});
    const auto wallpaper = [&random](Canvas& canvas)
    {
        canvas.addNoise(0.5, 5, 3, random);
        canvas.addNoise(0.03, 5, 3, random);
        canvas.poster(0.7, 1.25, 0.42, 0.594, random);
        canvas.poster(canvas.width() - 0.95, 1.5, 0.297, 0.42, random);
    };
    const auto carpet = [&random](Canvas& canvas)
    {
        canvas.boards(0.3, 0.3, 0.08, random);
        canvas.addNoise(0.04, 7, 3, random);
    };
    // The corner is the origin; the room lies in the quadrant x < 0, y < 0.
    const double side = 3.2, height = 2.6;
    builder.addWall({0, 0, 0}, {0, -side, 0}, height, {{186, 200, 204}, 2.5e-3, wallpaper});
    builder.addWall({-side, 0, 0}, {0, 0, 0}, height, {{196, 196, 190}, 2.5e-3, wallpaper});
    builder.addRectangle(
        {-side, -side, 0}, {side, 0, 0}, {0, side, 0}, {{120, 140, 160}, 2.5e-3, carpet});

    CameraMotion& motion = builder.scene().motion;
    motion.eye = {-1.35, -1.2, 1.35};
    motion.target = {-0.1, -0.1, 0.35};
    motion.handSpeed = 0.25;
    motion.handTurnRate = 0.26;
    Lamp lamp;
    lamp.position = {-1.6, -1.9, 2.5};
    return builder.build(lamp);
}
}  // namespace pointplane
