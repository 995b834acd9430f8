// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/planes/CellGrid.h>
#include <pointplane/planes/PlanarityTest.h>

#include <memory_resource>
#include <utility>
#include <vector>

namespace pointplane
{
/** Cells that form one plane so far. */
struct CellNode
{
    PlaneMoments moments;
    MomentsFit fit;
    int firstCell{-1}, lastCell{-1};  //!< of a chain, which CellGraph keeps
    size_t numCells{0};
    std::pmr::vector<int> neighbours;  //!< sorted, and not of merged nodes, once resolved
    bool alive{true};                  //!< else it is part of another node, or done

    [[nodiscard]] double meanSquaredError() const { return fit.sse / moments.numPixels; }

    void addNeighbour(int node);
};

/** Planar cells and what they have been merged to: nodes, linked where their cells are adjacent. */
class CellGraph
{
 public:
    /** Uniform quads of cells are merged first. \param grid, test must live as long as this
     * \param minValidFraction of a cell's pixels that must have depth */
    CellGraph(const CellGrid& grid, const PlanarityTest& test, double minValidFraction);
    CellGraph(const CellGraph&) = delete;
    CellGraph& operator=(const CellGraph&) = delete;

    [[nodiscard]] int size() const { return static_cast<int>(nodes_.size()); }
    [[nodiscard]] CellNode& node(int id) { return nodes_[static_cast<size_t>(id)]; }

    /** \return the neighbour with which the node makes the plane of the least mean squared error,
     * and that plane; -1 if none passes the test */
    [[nodiscard]] std::pair<int, MomentsFit> bestMerge(int id);

    /** Merges one node into another one. \param fit of both */
    void absorb(int into, int from, const MomentsFit& fit);

    /** \return indices into the grid, sorted */
    [[nodiscard]] std::vector<int> cellsOf(const CellNode& node) const;

 private:
    void makeCellNodes(double minValidFraction);
    void mergeQuads();
    void mergeQuad(int row, int col, int size);
    [[nodiscard]] int squareAt(int row, int col, int size);
    void connect();
    void link(size_t cellA, size_t cellB);
    [[nodiscard]] int find(int id);
    void resolveNeighbours(int id);

    const CellGrid& grid_;
    const PlanarityTest& test_;
    std::pmr::monotonic_buffer_resource memory_;  //!< of the nodes' lists: one each is slow
    std::vector<CellNode> nodes_;
    std::vector<int> nodeOfCell_;  //!< -1 = not planar
    std::vector<int> nextCell_;    //!< of the same node; -1 = none
    std::vector<int> parent_;      //!< union-find over nodes
};
}  // namespace pointplane
