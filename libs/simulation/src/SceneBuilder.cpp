// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/simulation/SceneBuilder.h>

#include <cmath>
#include <utility>

namespace pointplane
{
void SceneBuilder::add(Surface surface, const Finish& finish)
{
    const Eigen::Vector2d size = surface.pictureSize();
    Canvas canvas(size.x(), size.y(), finish.texel, finish.colour);
    if (finish.paint)
    {
        finish.paint(canvas);
        canvas.soften();
    }
    canvas.turnOver();  // painted top row first, while t points up
    surface.hasDepth = finish.hasDepth;
    surface.mover = mover_;
    scene_.surfaces.push_back(std::move(surface));
    pictures_.push_back(canvas.picture());
    texels_.push_back(canvas.texel());
}

void SceneBuilder::addRectangle(
    const Eigen::Vector3d& origin,
    const Eigen::Vector3d& edge1,
    const Eigen::Vector3d& edge2,
    const Finish& finish)
{
    POINTPLANE_CHECK(
        std::abs(edge1.dot(edge2)) < 1e-9 * edge1.norm() * edge2.norm(),
        "edges are not perpendicular");
    Surface s;
    s.kind = Surface::Kind::Rectangle;
    s.origin = origin;
    s.width = edge1.norm();
    s.height = edge2.norm();
    s.e1 = edge1 / s.width;
    s.e2 = edge2 / s.height;
    s.e3 = s.e1.cross(s.e2);
    add(std::move(s), finish);
}

void SceneBuilder::addWall(
    const Eigen::Vector3d& a, const Eigen::Vector3d& b, double height, const Finish& finish)
{
    addRectangle(a, b - a, {0, 0, height}, finish);
}

void SceneBuilder::addBox(
    const Eigen::Vector3d& base,
    const Eigen::Vector3d& size,
    double yaw,
    const Finish& sides,
    const Finish& top)
{
    const Eigen::Vector3d x(std::cos(yaw), std::sin(yaw), 0), y(-std::sin(yaw), std::cos(yaw), 0);
    const Eigen::Vector3d z(0, 0, size.z());
    const Eigen::Vector3d hx = 0.5 * size.x() * x, hy = 0.5 * size.y() * y;
    addRectangle(base - hx - hy, 2 * hx, z, sides);
    addRectangle(base + hx - hy, 2 * hy, z, sides);
    addRectangle(base + hx + hy, -2 * hx, z, sides);
    addRectangle(base - hx + hy, -2 * hy, z, sides);
    addRectangle(base - hx - hy + z, 2 * hx, 2 * hy, top);
}

void SceneBuilder::addCylinder(
    const Eigen::Vector3d& base,
    double radius,
    double height,
    const Finish& mantle,
    const Finish& lid)
{
    Surface s;
    s.kind = Surface::Kind::Cylinder;
    s.origin = base;
    s.radius = radius;
    s.height = height;
    Surface top = s;
    add(std::move(s), mantle);
    top.kind = Surface::Kind::Disc;
    top.origin.z() += height;
    add(std::move(top), lid);
}

void SceneBuilder::beginMover(
    const std::string& name, std::function<Eigen::Isometry3d(double t)> path)
{
    mover_ = static_cast<int>(scene_.movers.size());
    scene_.movers.push_back({name, std::move(path)});
}

Scene SceneBuilder::build(const Lamp& lamp)
{
    bakeTextures(scene_, lamp, pictures_, texels_);
    return scene_;
}
}  // namespace pointplane
