// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>
#include <pointplane/simulation/Texture.h>

namespace pointplane
{
/** One analytic piece of a scene. Its frame in the world is (origin; e1, e2, e3), e3 = e1 x e2;
 * that of a mover's surface is in the world as it is with the mover at rest.
 *
 * - Rectangle: origin + s e1 + t e2, 0 <= s <= width, 0 <= t <= height.
 * - Disc: origin + s e1 + t e2, s^2 + t^2 <= radius^2.
 * - Cylinder: the mantle origin + radius (cos a e1 + sin a e2) + t e3, 0 <= t <= height.
 *
 * Rectangles and discs are seen from the side of e3, cylinders from outside. */
struct Surface
{
    enum class Kind
    {
        Rectangle,
        Disc,
        Cylinder
    };
    Kind kind{Kind::Rectangle};
    Eigen::Vector3d origin{0, 0, 0};
    Eigen::Vector3d e1{1, 0, 0}, e2{0, 1, 0}, e3{0, 0, 1};
    double width{1}, height{1};  //!< [m]
    double radius{0};            //!< [m]
    bool hasDepth{true};         //!< false: returns no infrared light
    int mover{-1};               //!< index of the mover in Scene::movers that it belongs to
    Texture texture;             //!< with the scene's light in it

    [[nodiscard]] bool isPlane() const { return kind != Kind::Cylinder; }

    /** Size of the picture on it [m]: a disc's bounding square, a cylinder's mantle unrolled. */
    [[nodiscard]] Eigen::Vector2d pictureSize() const;

    /** Where the picture's point (s, t) is and the normal there. */
    void pictureToWorld(double s, double t, Eigen::Vector3d& point, Eigen::Vector3d& normal) const;

    /** Picture coordinates of a point on the surface [m]. */
    [[nodiscard]] Eigen::Vector2d worldToPicture(const Eigen::Vector3d& point) const;

    /** 1 / z of the nearest point eye + z ray that is seen, or 0. \param ray any length */
    [[nodiscard]] double inverseDepth(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray) const;
};
}  // namespace pointplane
