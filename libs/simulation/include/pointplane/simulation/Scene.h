// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/simulation/CameraPath.h>
#include <pointplane/simulation/Surface.h>

#include <functional>
#include <string>
#include <vector>

namespace pointplane
{
/** Something rigid that moves. It keeps the light that falls on it at rest. */
struct Mover
{
    std::string name;
    /** A point at p at rest is at T_world_rest(t) p at time t [s] since the beginning. */
    std::function<Eigen::Isometry3d(double t)> T_world_rest;
};

/** A world, what moves in it, and how a camera moves through it. World: z up, metres. */
struct Scene
{
    std::string name;
    std::vector<Surface> surfaces;
    std::vector<Mover> movers;
    CameraMotion motion;
};

/** The same world without what moves. */
[[nodiscard]] Scene withoutMovers(const Scene& scene);

/** Light of a scene: a lamp with soft shadows, and as much from everywhere. */
struct Lamp
{
    Eigen::Vector3d position{0, 0, 2.4};
    double size{0.5};     //!< edge of the square it shines from [m]
    double power{0.55};   //!< brightness of a surface that faces it at 1.5 m, of 1
    double ambient{0.5};  //!< brightness of what it does not reach
};

/** Multiplies each picture by the light that falls on its surface (Lambert's law, independent of
 * the viewpoint) and makes it the surface's texture.
 * \param pictures CV_8UC3, one per surface \param texels [m] */
void bakeTextures(
    Scene& scene,
    const Lamp& lamp,
    const std::vector<cv::Mat>& pictures,
    const std::vector<double>& texels);
}  // namespace pointplane
