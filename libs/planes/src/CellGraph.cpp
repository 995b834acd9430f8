// SPDX-License-Identifier: BSD-3-Clause
#include "CellGraph.h"

#include <algorithm>
#include <numeric>

namespace pointplane
{
namespace
{
constexpr size_t kUsualNeighbours = 8;
}  // namespace

/** Runs of the same one are common: cells along a border. */
void CellNode::addNeighbour(int node)
{
    if (neighbours.empty() || neighbours.back() != node)
    {
        neighbours.reserve(std::max(kUsualNeighbours, neighbours.capacity()));
        neighbours.push_back(node);
    }
}

CellGraph::CellGraph(const CellGrid& grid, const PlanarityTest& test, double minValidFraction)
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

void CellGraph::makeCellNodes(double minValidFraction)
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

void CellGraph::mergeQuads()
{
    for (int size = 1; size <= 8; size *= 2)
    {
        for (int row = 0; row + 2 * size <= grid_.rows; row += 2 * size)
        {
            for (int col = 0; col + 2 * size <= grid_.cols; col += 2 * size)
            {
                mergeQuad(row, col, size);
            }
        }
    }
}

/** Four squares of `size` x `size` cells, where they are planes and together one. */
void CellGraph::mergeQuad(int row, int col, int size)
{
    const int a = squareAt(row, col, size), b = squareAt(row, col + size, size);
    const int c = squareAt(row + size, col, size), d = squareAt(row + size, col + size, size);
    if (a < 0 || b < 0 || c < 0 || d < 0)
    {
        return;
    }
    const PlaneMoments top = node(a).moments + node(b).moments;
    const PlaneMoments bottom = node(c).moments + node(d).moments;
    const auto topFit =
        test_.merged(node(a).moments, node(a).fit.sse, node(b).moments, node(b).fit.sse);
    const auto bottomFit =
        test_.merged(node(c).moments, node(c).fit.sse, node(d).moments, node(d).fit.sse);
    if (!topFit || !bottomFit)
    {
        return;
    }
    if (const auto joint = test_.merged(top, topFit->sse, bottom, bottomFit->sse))
    {
        absorb(a, b, *joint);
        absorb(a, c, *joint);
        absorb(a, d, *joint);
    }
}

/** \return the node that is this square of cells as a whole, or -1 */
int CellGraph::squareAt(int row, int col, int size)
{
    const int first = nodeOfCell_[static_cast<size_t>(row * grid_.cols + col)];
    const int whole = first < 0 ? -1 : find(first);
    return whole >= 0 && node(whole).numCells == static_cast<size_t>(size * size) ? whole : -1;
}

void CellGraph::connect()
{
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

void CellGraph::link(size_t cellA, size_t cellB)
{
    if (nodeOfCell_[cellA] < 0 || nodeOfCell_[cellB] < 0)
    {
        return;
    }
    const int a = find(nodeOfCell_[cellA]), b = find(nodeOfCell_[cellB]);
    if (a != b)
    {
        node(a).addNeighbour(b);
        node(b).addNeighbour(a);
    }
}

int CellGraph::find(int id)
{
    while (parent_[static_cast<size_t>(id)] != id)
    {
        int& p = parent_[static_cast<size_t>(id)];
        p = parent_[static_cast<size_t>(p)];
        id = p;
    }
    return id;
}

void CellGraph::resolveNeighbours(int id)
{
    auto& list = node(id).neighbours;
    for (int& n : list)
    {
        n = find(n);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    list.erase(
        std::remove_if(list.begin(), list.end(), [&](int n) { return n == id || !node(n).alive; }),
        list.end());
}

void CellGraph::absorb(int into, int from, const MomentsFit& fit)
{
    CellNode& a = node(into);
    CellNode& b = node(from);
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

std::pair<int, MomentsFit> CellGraph::bestMerge(int id)
{
    resolveNeighbours(id);
    const CellNode& own = node(id);
    std::pair<int, MomentsFit> best{-1, {}};
    double bestError = 0;
    for (const int n : own.neighbours)
    {
        const CellNode& other = node(n);
        const auto fit = test_.merged(own.moments, own.fit.sse, other.moments, other.fit.sse);
        const double error = fit ? fit->sse / (own.moments.numPixels + other.moments.numPixels) : 0;
        if (fit && (best.first < 0 || error < bestError))
        {
            best = {n, *fit};
            bestError = error;
        }
    }
    return best;
}

std::vector<int> CellGraph::cellsOf(const CellNode& node) const
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
}  // namespace pointplane
