// SPDX-License-Identifier: BSD-3-Clause
#include "StaticTransforms.h"

#include <set>

namespace pointplane
{
namespace
{
/** Rounding of a driver that computes a link anew each time. */
constexpr double kSame = 1e-6;

/** tf2 writes frames without the leading slash, tf with. */
[[nodiscard]] std::string bare(const std::string& frame)
{
    return !frame.empty() && frame[0] == '/' ? frame.substr(1) : frame;
}
}  // namespace

void StaticTransforms::add(
    const std::string& parent, const std::string& child, const Eigen::Isometry3d& T_parent_child)
{
    const auto [link, isNew] = links_.emplace(bare(child), Link{bare(parent), T_parent_child});
    link->second.moves = link->second.moves ||
                         (!isNew && !link->second.T_parent_child.isApprox(T_parent_child, kSame));
}

std::string StaticTransforms::movingAbove(std::string frame) const
{
    std::set<std::string> seen;  // of a loop
    for (auto link = links_.find(bare(frame)); link != links_.end();
         link = links_.find(link->second.parent))
    {
        if (link->second.moves)
        {
            return "from " + link->second.parent + " to " + link->first;
        }
        if (!seen.insert(link->first).second)
        {
            break;
        }
    }
    return "";
}

std::map<std::string, Eigen::Isometry3d> StaticTransforms::ancestors(std::string frame) const
{
    std::map<std::string, Eigen::Isometry3d> out;
    Eigen::Isometry3d T_ancestor_frame = Eigen::Isometry3d::Identity();
    while (out.emplace(frame, T_ancestor_frame).second)
    {
        const auto link = links_.find(frame);
        if (link == links_.end() || link->second.moves)
        {
            break;
        }
        T_ancestor_frame = link->second.T_parent_child * T_ancestor_frame;
        frame = link->second.parent;
    }
    return out;
}

std::optional<Eigen::Isometry3d> StaticTransforms::between(
    const std::string& a, const std::string& b) const
{
    const auto ofB = ancestors(bare(b));
    for (const auto& [ancestor, T_ancestor_a] : ancestors(bare(a)))
    {
        const auto common = ofB.find(ancestor);
        if (common != ofB.end())
        {
            return T_ancestor_a.inverse() * common->second;
        }
    }
    return {};
}
}  // namespace pointplane
