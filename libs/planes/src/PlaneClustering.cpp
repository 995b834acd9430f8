// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/planes/PlaneClustering.h>

#include <algorithm>
#include <memory_resource>
#include <numeric>
#include <queue>

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

constexpr size_t kUsualNeighbours = 8;

struct Node
{
    PlaneMoments moments;
    MomentsFit fit;
    int firstCell{-1}, lastCell{-1};  //!< of a chain, which Graph keeps
    size_t numCells{0};
    std::pmr::vector<int> neighbours;  //!< sorted, and not of merged nodes, once resolved
    bool alive{true};

    [[nodiscard]] double meanSquaredError() const { return fit.sse / moments.numPixels; }

    /** Runs of the same one are common: cells along a border. */
    void addNeighbour(int node)
    {
        if (neighbours.empty() || neighbours.back() != node)
        {
            neighbours.reserve(std::max(kUsualNeighbours, neighbours.capacity()));
            neighbours.push_back(node);
        }
    }
};

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

/** The cell graph during clustering. */
class Graph
{
 public:
    Graph(const CellGrid& grid, const PlanarityTest& test, double minValidFraction);
    std::vector<CellCluster> cluster(double minPixels);

 private:
    void makeCellNodes(double minValidFraction);
    void mergeQuads();
    void connect();
    [[nodiscard]] int find(int node);
    void resolveNeighbours(int node);
    void absorb(int into, int from, const MomentsFit& fit);
    [[nodiscard]] std::pair<int, MomentsFit> bestMerge(int node);
    [[nodiscard]] std::vector<int> cellsOf(const Node& node) const;

    const CellGrid& grid_;
    const PlanarityTest& test_;
    std::pmr::monotonic_buffer_resource memory_;  //!< of the nodes' lists: one each is slow
    std::vector<Node> nodes_;
    std::vector<int> nodeOfCell_;  //!< -1 = not planar
    std::vector<int> nextCell_;    //!< of the same node; -1 = none
    std::vector<int> parent_;      //!< union-find over nodes
};

Graph::Graph(const CellGrid& grid, const PlanarityTest& test, double minValidFraction)
    : grid_(grid),
      test_(test),
      memory_((grid.moments.size() + 1) * kUsualNeighbours * 2 * sizeof(int)),
      nodeOfCell_(grid.moments.size(), -1),
      nextCell_(grid.moments.size(), -1)
{
    makeCellNodes(minValidFraction);
    parent_.resize(nodes_.size());
    std::iota(parent_.begin(), parent_.end(), 0);
    mergeQuads();
    connect();
}

void Graph::makeCellNodes(double minValidFraction)
{
    const double minValid = minValidFraction * grid_.cellSizePx * grid_.cellSizePx;
    nodes_.reserve(grid_.moments.size());
    for (size_t i = 0; i < grid_.moments.size(); ++i)
    {
        const PlaneMoments& m = grid_.moments[i];
        if (m.numPixels < minValid || !test_.isPlanarCell(m))
        {
            continue;
        }
        nodeOfCell_[i] = static_cast<int>(nodes_.size());
        const int cell = static_cast<int>(i);
        nodes_.push_back({m, *fitPlane(m), cell, cell, 1, std::pmr::vector<int>(&memory_), true});
    }
}

void Graph::mergeQuads()
{
    for (int size = 1; size <= 8; size *= 2)
    {
        for (int row = 0; row + 2 * size <= grid_.rows; row += 2 * size)
        {
            for (int col = 0; col + 2 * size <= grid_.cols; col += 2 * size)
            {
                const auto nodeAt = [&](int r, int c)
                {
                    const int node = nodeOfCell_[static_cast<size_t>(r * grid_.cols + c)];
                    const bool whole =
                        node >= 0 && nodes_[static_cast<size_t>(find(node))].numCells ==
                                         static_cast<size_t>(size * size);
                    return whole ? find(node) : -1;
                };
                const int a = nodeAt(row, col), b = nodeAt(row, col + size);
                const int c = nodeAt(row + size, col), d = nodeAt(row + size, col + size);
                if (a < 0 || b < 0 || c < 0 || d < 0)
                {
                    continue;
                }
                const auto node = [&](int i) -> const Node&
                { return nodes_[static_cast<size_t>(i)]; };
                const PlaneMoments top = node(a).moments + node(b).moments;
                const PlaneMoments bottom = node(c).moments + node(d).moments;
                const auto topFit = test_.merged(
                    node(a).moments, node(a).fit.sse, node(b).moments, node(b).fit.sse);
                const auto bottomFit = test_.merged(
                    node(c).moments, node(c).fit.sse, node(d).moments, node(d).fit.sse);
                if (!topFit || !bottomFit)
                {
                    continue;
                }
                const auto joint = test_.merged(top, topFit->sse, bottom, bottomFit->sse);
                if (joint)
                {
                    absorb(a, b, *joint);
                    absorb(a, c, *joint);
                    absorb(a, d, *joint);
                }
            }
        }
    }
}

void Graph::connect()
{
    const auto link = [&](size_t cellA, size_t cellB)
    {
        if (nodeOfCell_[cellA] < 0 || nodeOfCell_[cellB] < 0)
        {
            return;
        }
        const int a = find(nodeOfCell_[cellA]), b = find(nodeOfCell_[cellB]);
        if (a != b)
        {
            nodes_[static_cast<size_t>(a)].addNeighbour(b);
            nodes_[static_cast<size_t>(b)].addNeighbour(a);
        }
    };
    const size_t cols = static_cast<size_t>(grid_.cols), rows = static_cast<size_t>(grid_.rows);
    for (size_t row = 0; row < rows; ++row)
    {
        for (size_t col = 0; col < cols; ++col)
        {
            const size_t cell = row * cols + col;
            if (col + 1 < cols)
            {
                link(cell, cell + 1);
            }
            if (row + 1 < rows)
            {
                link(cell, cell + cols);
            }
        }
    }
}

int Graph::find(int node)
{
    while (parent_[static_cast<size_t>(node)] != node)
    {
        int& p = parent_[static_cast<size_t>(node)];
        p = parent_[static_cast<size_t>(p)];
        node = p;
    }
    return node;
}

void Graph::resolveNeighbours(int node)
{
    auto& list = nodes_[static_cast<size_t>(node)].neighbours;
    for (int& n : list)
    {
        n = find(n);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    list.erase(
        std::remove_if(
            list.begin(),
            list.end(),
            [&](int n) { return n == node || !nodes_[static_cast<size_t>(n)].alive; }),
        list.end());
}

void Graph::absorb(int into, int from, const MomentsFit& fit)
{
    Node& a = nodes_[static_cast<size_t>(into)];
    Node& b = nodes_[static_cast<size_t>(from)];
    a.moments += b.moments;
    a.fit = fit;
    nextCell_[static_cast<size_t>(a.lastCell)] = b.firstCell;
    a.lastCell = b.lastCell;
    a.numCells += b.numCells;
    a.neighbours.insert(a.neighbours.end(), b.neighbours.begin(), b.neighbours.end());
    b.alive = false;
    b.neighbours.clear();
    parent_[static_cast<size_t>(from)] = into;
}

std::pair<int, MomentsFit> Graph::bestMerge(int id)
{
    const Node& node = nodes_[static_cast<size_t>(id)];
    std::pair<int, MomentsFit> best{-1, {}};
    double bestError = 0;
    for (const int n : node.neighbours)
    {
        const Node& other = nodes_[static_cast<size_t>(n)];
        const auto fit = test_.merged(node.moments, node.fit.sse, other.moments, other.fit.sse);
        const double error =
            fit ? fit->sse / (node.moments.numPixels + other.moments.numPixels) : 0;
        if (fit && (best.first < 0 || error < bestError))
        {
            best = {n, *fit};
            bestError = error;
        }
    }
    return best;
}

/** Sorted. */
std::vector<int> Graph::cellsOf(const Node& node) const
{
    std::vector<int> out;
    out.reserve(node.numCells);
    for (int cell = node.firstCell; cell >= 0; cell = nextCell_[static_cast<size_t>(cell)])
    {
        out.push_back(cell);
    }
    std::sort(out.begin(), out.end());
    return out;
}

/** The method that [P17, section Plane Extraction] names. */
std::vector<CellCluster> Graph::cluster(double minPixels)
{
    std::priority_queue<QueueEntry> queue;
    const auto enqueue = [&](int id)
    {
        const Node& node = nodes_[static_cast<size_t>(id)];
        queue.push({node.meanSquaredError(), id, node.moments.numPixels});
    };
    for (size_t i = 0; i < nodes_.size(); ++i)
    {
        if (nodes_[i].alive)
        {
            enqueue(static_cast<int>(i));
        }
    }
    std::vector<CellCluster> out;
    while (!queue.empty())
    {
        const QueueEntry top = queue.top();
        queue.pop();
        Node& node = nodes_[static_cast<size_t>(top.node)];
        if (!node.alive || node.moments.numPixels != top.n)
        {
            continue;
        }
        resolveNeighbours(top.node);
        const auto [other, fit] = bestMerge(top.node);
        if (other >= 0)
        {
            const bool keepOther = nodes_[static_cast<size_t>(other)].numCells > node.numCells;
            const int into = keepOther ? other : top.node;
            absorb(into, keepOther ? top.node : other, fit);
            enqueue(into);
            continue;
        }
        node.alive = false;
        if (node.moments.numPixels >= minPixels)
        {
            out.push_back({node.moments, node.fit, cellsOf(node)});
        }
    }
    sortBySize(out);
    return out;
}
}  // namespace

std::vector<CellCluster> clusterCells(
    const CellGrid& grid, const PlanarityTest& test, double minValidFraction, double minPixels)
{
    return Graph(grid, test, minValidFraction).cluster(minPixels);
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
