// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/simulation/Canvas.h>
#include <pointplane/simulation/Scene.h>

#include <functional>

namespace pointplane
{
/** Paints a surface's picture; the canvas comes in the surface's base colour, top row first. */
using Painter = std::function<void(Canvas&)>;

/** Puts surfaces and their pictures together. */
class SceneBuilder
{
 public:
    struct Finish
    {
        cv::Scalar colour{200, 200, 200};
        double texel{2e-3};  //!< [m]
        Painter paint{};     //!< nothing: blank
        bool hasDepth{true};
    };

    explicit SceneBuilder(std::string name) { scene_.name = std::move(name); }

    [[nodiscard]] Scene& scene() { return scene_; }

    /** \param edge1, edge2 perpendicular edges [m]; edge1 x edge2 points to the visible side.
     * The picture's top row lies along edge1 at the far end of edge2. */
    void addRectangle(
        const Eigen::Vector3d& origin,
        const Eigen::Vector3d& edge1,
        const Eigen::Vector3d& edge2,
        const Finish& finish);

    /** Upright wall from a to b (at their z), whose picture runs from a (left) to b (right). */
    void addWall(
        const Eigen::Vector3d& a, const Eigen::Vector3d& b, double height, const Finish& finish);

    /** Five faces of a box that stands on something. \param base centre of its bottom
     * \param size along its own x, y, z [m] \param yaw [rad] \param sides, top finishes */
    void addBox(
        const Eigen::Vector3d& base,
        const Eigen::Vector3d& size,
        double yaw,
        const Finish& sides,
        const Finish& top);

    /** Upright cylinder with a lid. \param base centre of its bottom */
    void addCylinder(
        const Eigen::Vector3d& base,
        double radius,
        double height,
        const Finish& mantle,
        const Finish& lid);

    /** What is added from now on belongs to a new mover, until endMover(). It stands where it is at
     * rest. */
    void beginMover(const std::string& name, std::function<Eigen::Isometry3d(double t)> path);
    void endMover() { mover_ = -1; }

    /** The finished scene. */
    [[nodiscard]] Scene build(const Lamp& lamp);

 private:
    void add(Surface surface, const Finish& finish);

    Scene scene_;
    int mover_{-1};
    std::vector<cv::Mat> pictures_;
    std::vector<double> texels_;
};
}  // namespace pointplane
