// SPDX-License-Identifier: BSD-3-Clause
#include "nees_pools.h"

#include <algorithm>
#include <ostream>

#include "command.h"

namespace pointplane
{
NeesResult NeesPools::Pool::score() const
{
    return consistencyOf(increments, independent, interval);
}

std::string NeesPools::Pool::problem() const { return problemOf(increments, interval); }

void NeesPools::add(const NeesRun& run)
{
    for (const NeesRun::Tested& tested : run.tested)
    {
        const std::string name = nameOf(tested.interval);
        auto pool = std::find_if(
            pools_.begin(),
            pools_.end(),
            [&](const Pool& p) { return nameOf(p.interval) == name; });
        if (pool == pools_.end())
        {
            pool = pools_.insert(pools_.end(), {tested.interval, {}, 0});
        }
        pool->independent += countIndependent(tested.increments);
        pool->increments.insert(
            pool->increments.end(), tested.increments.begin(), tested.increments.end());
    }
}

std::vector<NeesResult> NeesPools::scores() const
{
    std::vector<NeesResult> out;
    for (const Pool& pool : pools_)
    {
        out.push_back(pool.score());
    }
    return out;
}

std::vector<NeesResult> NeesPools::scoresOfTestable(CommandContext& context) const
{
    std::vector<NeesResult> out;
    std::string notes;
    for (const Pool& pool : pools_)
    {
        if (const std::string problem = pool.problem(); problem.empty())
        {
            out.push_back(pool.score());
        }
        else
        {
            notes += context.program + ": note: left out: " + problem + "\n";
        }
    }
    if (out.empty())
    {
        return scores();  // throws
    }
    context.err << notes;
    return out;
}
}  // namespace pointplane
