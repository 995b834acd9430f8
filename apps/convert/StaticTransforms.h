// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

#include <map>
#include <optional>
#include <string>

namespace pointplane
{
/** Where frames are on a robot, as ROS tells it: each with respect to its parent. A frame that is
 * told to be elsewhere later moves: what is connected by it alone is not. */
class StaticTransforms
{
 public:
    void add(
        const std::string& parent,
        const std::string& child,
        const Eigen::Isometry3d& T_parent_child);

    /** \return T_a_b, or nothing if they are not connected */
    [[nodiscard]] std::optional<Eigen::Isometry3d> between(
        const std::string& a, const std::string& b) const;

    /** The first link above a frame that moves, as "from a to b"; empty: there is none. */
    [[nodiscard]] std::string movingAbove(std::string frame) const;

 private:
    struct Link
    {
        std::string parent;
        Eigen::Isometry3d T_parent_child;
        bool moves{false};
    };
    /** T_ancestor_frame for all its ancestors, itself included. */
    [[nodiscard]] std::map<std::string, Eigen::Isometry3d> ancestors(std::string frame) const;

    std::map<std::string, Link> links_;  //!< by child
};
}  // namespace pointplane
