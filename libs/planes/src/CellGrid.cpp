// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/planes/CellGrid.h>

#include <opencv2/core/hal/intrin.hpp>

#include <algorithm>

namespace pointplane
{
namespace
{
/** Cells that are summed side by side, without reordering a sum. */
constexpr int kLanes = 4;

/** Sums over one row of cells, in cell coordinates i = 0 .. size-1 and q - qReference: small
 * numbers, so that single precision loses nothing that matters. */
struct RowSums
{
    float n[kLanes], i[kLanes], ii[kLanes], q[kLanes], iq[kLanes], qq[kLanes];
};

/** The same row of several cells. */
class CellRow
{
 public:
    /** \param cells first pixel of each */
    CellRow(const float* const (&cells)[kLanes], int size) : cells_(cells), size_(size) {}

    /** 1/Z of one pixel of each cell, with 0 for no reading (NaN fails the comparison). */
    [[nodiscard]] cv::v_float32x4 inverseDepth(int i) const
    {
        const cv::v_float32x4 z(cells_[0][i], cells_[1][i], cells_[2][i], cells_[3][i]);
        const cv::v_float32x4 isReading = z > cv::v_setzero_f32();
        return (cv::v_setall_f32(1) / z) & isReading;
    }

    [[nodiscard]] RowSums sum(const float* qReference) const
    {
        const cv::v_float32x4 one = cv::v_setall_f32(1), zero = cv::v_setzero_f32();
        const cv::v_float32x4 reference = cv::v_load(qReference);
        cv::v_float32x4 sn = zero, si = zero, sii = zero, sq = zero, siq = zero, sqq = zero;
        for (int i = 0; i < size_; ++i)
        {
            const cv::v_float32x4 inverse = inverseDepth(i);
            const cv::v_float32x4 valid = (inverse > zero) & one;
            const cv::v_float32x4 q = valid * (inverse - reference);
            const cv::v_float32x4 column = cv::v_setall_f32(static_cast<float>(i)) * valid;
            sn += valid;
            si += column;
            sii += column * column;
            sq += q;
            siq += column * q;
            sqq += q * q;
        }
        RowSums out;
        cv::v_store(out.n, sn);
        cv::v_store(out.i, si);
        cv::v_store(out.ii, sii);
        cv::v_store(out.q, sq);
        cv::v_store(out.iq, siq);
        cv::v_store(out.qq, sqq);
        return out;
    }

 private:
    const float* const (&cells_)[kLanes];
    int size_;
};

/** The first reading of a cell's middle column is what others are compared with. */
void completeReference(const cv::v_float32x4& middle, float* qReference)
{
    const cv::v_float32x4 reference = cv::v_load(qReference);
    cv::v_store(qReference, cv::v_select(reference == cv::v_setzero_f32(), middle, reference));
}

/** PlaneMoments of cells side by side. */
class LaneMoments
{
 public:
    /** \param x0 normalised coordinate of each cell's first column */
    explicit LaneMoments(const double (&x0)[kLanes]) { std::copy_n(x0, kLanes, x0_); }

    /** Adds a row's sums at normalised coordinates x = x0 + i * step, y, q = q0 + dq. */
    void addRow(const RowSums& s, double step, double y, const float* q0)
    {
        for (int k = 0; k < kLanes; ++k)
        {
            const double x0 = x0_[k], q = static_cast<double>(q0[k]);
            const double sn = static_cast<double>(s.n[k]), si = static_cast<double>(s.i[k]);
            const double sx = sn * x0 + si * step;
            const double sq = sn * q + static_cast<double>(s.q[k]);
            n_[k] += sn;
            x_[k] += sx;
            y_[k] += sn * y;
            xx_[k] +=
                sn * x0 * x0 + 2 * x0 * step * si + step * step * static_cast<double>(s.ii[k]);
            xy_[k] += sx * y;
            yy_[k] += sn * y * y;
            q_[k] += sq;
            xq_[k] += x0 * sq + step * (si * q + static_cast<double>(s.iq[k]));
            yq_[k] += y * sq;
            qq_[k] +=
                sn * q * q + 2 * q * static_cast<double>(s.q[k]) + static_cast<double>(s.qq[k]);
        }
    }

    [[nodiscard]] PlaneMoments at(int k) const
    {
        PlaneMoments m;
        m.n = m.numPixels = n_[k];
        m.x = x_[k];
        m.y = y_[k];
        m.xx = xx_[k];
        m.xy = xy_[k];
        m.yy = yy_[k];
        m.q = q_[k];
        m.xq = xq_[k];
        m.yq = yq_[k];
        m.qq = qq_[k];
        return m;
    }

 private:
    double x0_[kLanes];
    double n_[kLanes] = {}, x_[kLanes] = {}, y_[kLanes] = {};
    double xx_[kLanes] = {}, xy_[kLanes] = {}, yy_[kLanes] = {};
    double q_[kLanes] = {}, xq_[kLanes] = {}, yq_[kLanes] = {}, qq_[kLanes] = {};
};
}  // namespace

void CellGrid::compute(const cv::Mat& depth, const PinholeCamera& camera, int cellSize)
{
    POINTPLANE_CHECK(depth.type() == CV_32FC1, "depth image must be CV_32FC1");
    POINTPLANE_CHECK(cellSize >= 2, "cell size " << cellSize << " px is below 2");
    cellSizePx = cellSize;
    cols = depth.cols / cellSize;
    rows = depth.rows / cellSize;
    moments.resize(static_cast<size_t>(rows) * static_cast<size_t>(cols));
    for (int row = 0; row < rows; ++row)
    {
        for (int col = 0; col < cols; col += kLanes)
        {
            // Beyond the last cell, that one again.
            int firstColumn[kLanes];
            double x0[kLanes];
            for (int k = 0; k < kLanes; ++k)
            {
                firstColumn[k] = std::min(col + k, cols - 1) * cellSize;
                x0[k] = (firstColumn[k] - camera.cx) / camera.fx;
            }
            LaneMoments sums(x0);
            float qReference[kLanes] = {};
            for (int v = row * cellSize; v < (row + 1) * cellSize; ++v)
            {
                const auto* z = depth.ptr<float>(v);
                const float* cells[kLanes];
                for (int k = 0; k < kLanes; ++k)
                {
                    cells[k] = z + firstColumn[k];
                }
                const CellRow cellRow(cells, cellSize);
                completeReference(cellRow.inverseDepth(cellSize / 2), qReference);
                sums.addRow(
                    cellRow.sum(qReference),
                    1 / camera.fx,
                    (v - camera.cy) / camera.fy,
                    qReference);
            }
            for (int k = 0; k < std::min(kLanes, cols - col); ++k)
            {
                moments[static_cast<size_t>(row * cols + col + k)] = sums.at(k);
            }
        }
    }
}

void CellGrid::weigh(const DepthNoise& noise)
{
    if (noise.isConstantInInverseDepth())
    {
        return;
    }
    for (PlaneMoments& m : moments)
    {
        if (m.numPixels > 0)
        {
            m *= noise.weight(m.q / m.n);
        }
    }
}
}  // namespace pointplane
