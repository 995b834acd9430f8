// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/planes/CellGrid.h>

namespace pointplane
{
namespace
{
/** Sums over one row of one cell, in cell coordinates i = 0 .. size-1 and q - qReference: small
 * numbers, so that single precision loses nothing that matters. */
struct RowSums
{
    float n{0}, i{0}, ii{0}, q{0}, iq{0}, qq{0};
};

RowSums sumRow(const float* inverseDepth, int size, float qReference)
{
    RowSums s;
    for (int i = 0; i < size; ++i)
    {
        const float valid = inverseDepth[i] > 0 ? 1.F : 0.F;
        const float q = valid * (inverseDepth[i] - qReference);
        const float column = static_cast<float>(i) * valid;
        s.n += valid;
        s.i += column;
        s.ii += column * column;
        s.q += q;
        s.iq += column * q;
        s.qq += q * q;
    }
    return s;
}

/** Adds a row's sums at normalised coordinates x = x0 + i * step, y, q = qReference + dq. */
void addRow(PlaneMoments& m, const RowSums& s, double x0, double step, double y, double q0)
{
    const double sx = s.n * x0 + s.i * step;
    const double sq = s.n * q0 + s.q;
    m.n += s.n;
    m.x += sx;
    m.y += s.n * y;
    m.xx += s.n * x0 * x0 + 2 * x0 * step * s.i + step * step * s.ii;
    m.xy += sx * y;
    m.yy += s.n * y * y;
    m.q += sq;
    m.xq += x0 * sq + step * (s.i * q0 + s.iq);
    m.yq += y * sq;
    m.qq += s.n * q0 * q0 + 2 * q0 * s.q + s.qq;
}

/** 1/Z, with 0 for no reading (NaN fails the comparison). */
void invertRow(const float* z, float* out, int n)
{
    for (int i = 0; i < n; ++i)
    {
        out[i] = z[i] > 0.05F && z[i] < 100.F ? 1.F / z[i] : 0.F;
    }
}
}  // namespace

void CellGrid::compute(const cv::Mat& depth, const PinholeCamera& camera, int cellSize)
{
    POINTPLANE_CHECK(depth.type() == CV_32FC1, "depth image must be CV_32FC1");
    POINTPLANE_CHECK(cellSize >= 2, "cell size " << cellSize << " px is below 2");
    cellSizePx = cellSize;
    cols = depth.cols / cellSize;
    rows = depth.rows / cellSize;
    moments.assign(static_cast<size_t>(rows) * static_cast<size_t>(cols), {});
    std::vector<float> inverseDepth(static_cast<size_t>(depth.cols));
    std::vector<float> qReference(static_cast<size_t>(cols), 0.F);
    for (int row = 0; row < rows; ++row)
    {
        qReference.assign(qReference.size(), 0.F);
        for (int v = row * cellSize; v < (row + 1) * cellSize; ++v)
        {
            invertRow(depth.ptr<float>(v), inverseDepth.data(), depth.cols);
            const double y = (v - camera.cy) / camera.fy;
            for (int col = 0; col < cols; ++col)
            {
                const float* q = inverseDepth.data() + col * cellSize;
                float& reference = qReference[static_cast<size_t>(col)];
                if (reference == 0.F)
                {
                    reference = q[cellSize / 2];
                }
                addRow(
                    moments[static_cast<size_t>(row * cols + col)],
                    sumRow(q, cellSize, reference),
                    (col * cellSize - camera.cx) / camera.fx,
                    1 / camera.fx,
                    y,
                    static_cast<double>(reference));
            }
        }
    }
}
}  // namespace pointplane
