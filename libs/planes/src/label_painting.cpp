// SPDX-License-Identifier: BSD-3-Clause
#include "label_painting.h"

#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
class LabelPainter
{
 public:
    LabelPainter(const CellGrid& grid, const cv::Mat& depth, const PinholeCamera& camera)
        : grid_(grid),
          depth_(depth),
          camera_(camera),
          labels_(depth.size(), CV_8UC1, cv::Scalar(0)),
          labelOfCell_(grid.moments.size(), 0)
    {
    }

    cv::Mat paint(const std::vector<CellCluster>& clusters, const PlanarityTest& test)
    {
        for (size_t i = 0; i < clusters.size(); ++i)
        {
            for (const int cell : clusters[i].cells)
            {
                labelOfCell_[static_cast<size_t>(cell)] = static_cast<uchar>(i + 1);
                paintCell(cell, static_cast<uchar>(i + 1));
            }
        }
        for (int cell = 0; cell < static_cast<int>(labelOfCell_.size()); ++cell)
        {
            if (labelOfCell_[static_cast<size_t>(cell)] == 0)
            {
                paintBorderCell(cell, clusters, test);
            }
        }
        return labels_;
    }

 private:
    [[nodiscard]] cv::Rect rect(int cell) const
    {
        const int s = grid_.cellSizePx;
        return {cell % grid_.cols * s, cell / grid_.cols * s, s, s};
    }

    void paintCell(int cell, uchar label)
    {
        const cv::Rect area = rect(cell);
        for (int v = area.y; v < area.y + area.height; ++v)
        {
            std::fill_n(labels_.ptr<uchar>(v) + area.x, area.width, label);
        }
    }

    /** Labels of the up to eight cells around, sorted, without repetition. */
    const std::vector<uchar>& adjacentLabels(int cell)
    {
        std::vector<uchar>& out = adjacent_;
        out.clear();
        const int col = cell % grid_.cols, row = cell / grid_.cols;
        for (int r = std::max(0, row - 1); r <= std::min(grid_.rows - 1, row + 1); ++r)
        {
            for (int c = std::max(0, col - 1); c <= std::min(grid_.cols - 1, col + 1); ++c)
            {
                const uchar label = labelOfCell_[static_cast<size_t>(r * grid_.cols + c)];
                if (label != 0 && std::find(out.begin(), out.end(), label) == out.end())
                {
                    out.push_back(label);
                }
            }
        }
        std::sort(out.begin(), out.end());
        return out;
    }

    void paintBorderCell(
        int cell, const std::vector<CellCluster>& clusters, const PlanarityTest& test)
    {
        const cv::Rect area = rect(cell);
        for (const uchar label : adjacentLabels(cell))
        {
            const Eigen::Vector3d& theta = clusters[static_cast<size_t>(label - 1)].fit.theta_m;
            const Eigen::Vector3d middle(
                (area.x + 0.5 * area.width - camera_.cx) / camera_.fx,
                (area.y + 0.5 * area.height - camera_.cy) / camera_.fy,
                1);
            const double limit =
                test.cellSigmas *
                std::sqrt(
                    test.noise.inverseDepthVariance(theta.dot(middle)) + test.slopeSquared(theta));
            for (int v = area.y; v < area.y + area.height; ++v)
            {
                const float* z = depth_.ptr<float>(v);
                uchar* out = labels_.ptr<uchar>(v);
                const double base = theta.y() * (v - camera_.cy) / camera_.fy + theta.z();
                for (int u = area.x; u < area.x + area.width; ++u)
                {
                    const double error = base + theta.x() * (u - camera_.cx) / camera_.fx +
                                         1 / static_cast<double>(z[u]);
                    if (out[u] == 0 && std::abs(error) <= limit)
                    {
                        out[u] = label;
                    }
                }
            }
        }
    }

    const CellGrid& grid_;
    const cv::Mat& depth_;
    const PinholeCamera& camera_;
    cv::Mat labels_;
    std::vector<uchar> labelOfCell_;
    std::vector<uchar> adjacent_;  //!< memory of adjacentLabels()
};
}  // namespace

cv::Mat paintLabels(
    const std::vector<CellCluster>& clusters,
    const CellGrid& grid,
    const cv::Mat& depth,
    const PinholeCamera& camera,
    const PlanarityTest& test)
{
    return LabelPainter(grid, depth, camera).paint(clusters, test);
}
}  // namespace pointplane
