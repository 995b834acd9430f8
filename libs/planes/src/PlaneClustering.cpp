// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/PlaneClustering.h>

#include <algorithm>
#include <queue>

#include "CellGraph.h"

namespace pointplane
{
namespace
{
/** Largest first. */
void sortBySize(std::vector<CellCluster>& clusters)
{
    std::sort(
        clusters.begin(),
        clusters.end(),
        [](const CellCluster& a, const CellCluster& b)
        {
            return a.moments.numPixels != b.moments.numPixels
                       ? a.moments.numPixels > b.moments.numPixels
                       : a.cells < b.cells;
        });
}

struct QueueEntry
{
    double error;
    int node;
    double n;  //!< size at the time of queueing: an entry of a node that has grown since is stale

    bool operator<(const QueueEntry& other) const
    {
        return error != other.error ? error > other.error : node > other.node;
    }
};
}  // namespace

/** The method that [P17, section Plane Extraction] names. */
std::vector<CellCluster> clusterCells(
    const CellGrid& grid, const PlanarityTest& test, double minValidFraction, double minPixels)
{
    CellGraph graph(grid, test, minValidFraction);
    std::priority_queue<QueueEntry> queue;
    const auto enqueue = [&](int id)
    {
        const CellNode& node = graph.node(id);
        queue.push({node.meanSquaredError(), id, node.moments.numPixels});
    };
    for (int id = 0; id < graph.size(); ++id)
    {
        if (graph.node(id).alive)
        {
            enqueue(id);
        }
    }
    std::vector<CellCluster> out;
    while (!queue.empty())
    {
        const QueueEntry top = queue.top();
        queue.pop();
        CellNode& node = graph.node(top.node);
        if (!node.alive || node.moments.numPixels != top.n)
        {
            continue;
        }
        const auto [other, fit] = graph.bestMerge(top.node);
        if (other >= 0)
        {
            const bool keepOther = graph.node(other).numCells > node.numCells;
            const int into = keepOther ? other : top.node;
            graph.absorb(into, keepOther ? top.node : other, fit);
            enqueue(into);
            continue;
        }
        node.alive = false;
        if (node.moments.numPixels >= minPixels)
        {
            out.push_back({node.moments, node.fit, graph.cellsOf(node)});
        }
    }
    sortBySize(out);
    return out;
}

void mergeCoplanar(std::vector<CellCluster>& clusters, const PlanarityTest& test)
{
    for (size_t i = 0; i < clusters.size(); ++i)
    {
        for (size_t j = i + 1; j < clusters.size();)
        {
            CellCluster& a = clusters[i];
            const CellCluster& b = clusters[j];
            const auto fit = test.merged(a.moments, a.fit.sse, b.moments, b.fit.sse);
            if (!fit)
            {
                ++j;
                continue;
            }
            a.moments += b.moments;
            a.fit = *fit;
            a.cells.insert(a.cells.end(), b.cells.begin(), b.cells.end());
            clusters.erase(clusters.begin() + static_cast<std::ptrdiff_t>(j));
            j = i + 1;  // the plane has changed: try all others again
        }
    }
    sortBySize(clusters);
}
}  // namespace pointplane
