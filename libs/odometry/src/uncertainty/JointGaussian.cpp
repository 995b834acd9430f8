// SPDX-License-Identifier: BSD-3-Clause
#include "JointGaussian.h"

#include <pointplane/pose/pairs.h>

#include <Eigen/Cholesky>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace pointplane
{
Eigen::Index JointGaussian::Block::size() const
{
    switch (kind)
    {
        case Kind::Camera:
            return kNumCameraErrors;
        case Kind::Bend:
            return kNumPatches;
        case Kind::View:
            return 12;
        default:
            return 6;
    }
}

void JointGaussian::start(const std::vector<Block>& blocks, const Eigen::MatrixXd& cov)
{
    blocks_ = blocks;
    cov_ = cov;
}

bool JointGaussian::has(Kind kind, int frame) const
{
    return std::any_of(
        blocks_.begin(), blocks_.end(), [&](const Block& b) { return b.is(kind, frame); });
}

Eigen::Index JointGaussian::find(Kind kind, int frame) const
{
    Eigen::Index row = 0;
    for (const Block& block : blocks_)
    {
        if (block.is(kind, frame))
        {
            return row;
        }
        row += block.size();
    }
    throw std::invalid_argument("frame " + std::to_string(frame) + " is not in the window");
}

void JointGaussian::prepend(
    const std::vector<Block>& blocks, const Eigen::MatrixXd& A, const Eigen::MatrixXd& Q)
{
    const Eigen::Index n = cov_.rows(), m = A.rows();
    Eigen::MatrixXd out(m + n, m + n);
    out.bottomRightCorner(n, n) = cov_;
    out.topRightCorner(m, n) = A * cov_;
    out.topLeftCorner(m, m) = out.topRightCorner(m, n) * A.transpose() + Q;
    out.bottomLeftCorner(n, m) = out.topRightCorner(m, n).transpose();
    cov_ = 0.5 * (out + out.transpose());
    blocks_.insert(blocks_.begin(), blocks.begin(), blocks.end());
}

void JointGaussian::prependAlike(
    Kind kind, const std::vector<int>& frames, std::size_t added, const Eigen::MatrixXd& C)
{
    std::vector<std::size_t> known;
    std::vector<Eigen::Index> rows;  // of one component: all are alike
    for (std::size_t k = 0; k < frames.size(); ++k)
    {
        if (has(kind, frames[k]))
        {
            known.push_back(k);
            rows.push_back(find(kind, frames[k]));
        }
    }
    const Block block{kind, frames[added]};
    const Eigen::VectorXd weights = C(known, known).ldlt().solve(Eigen::VectorXd(C(known, added)));
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(block.size(), size());
    for (std::size_t k = 0; k < rows.size(); ++k)
    {
        A.middleCols(rows[k], block.size())
            .diagonal()
            .setConstant(weights[static_cast<Eigen::Index>(k)]);
    }
    // C may differ from when the known blocks were added: the distance of the features changes.
    const double isNew = std::max(0.0, 1 - weights.dot(cov_(rows, rows) * weights));
    prepend({block}, A, isNew * Eigen::MatrixXd::Identity(block.size(), block.size()));
}

void JointGaussian::replace(Kind kind, int frame, const Eigen::MatrixXd& A)
{
    const Eigen::Index row = find(kind, frame), m = A.rows();
    const Eigen::MatrixXd cross = A * cov_;
    const Eigen::MatrixXd own = cross * A.transpose();
    cov_.middleRows(row, m) = cross;
    cov_.middleCols(row, m) = cross.transpose();
    cov_.block(row, row, m, m) = 0.5 * (own + own.transpose());
}

void JointGaussian::makeIndependent(Kind kind, int frame, const Eigen::MatrixXd& cov)
{
    const Eigen::Index row = find(kind, frame), m = cov.rows();
    cov_.middleRows(row, m).setZero();
    cov_.middleCols(row, m).setZero();
    cov_.block(row, row, m, m) = cov;
}

void JointGaussian::rename(Kind kind, int from, int to)
{
    for (Block& block : blocks_)
    {
        if (block.is(kind, from))
        {
            block.frame = to;
        }
    }
}

void JointGaussian::keepIf(const std::function<bool(const Block&)>& isKept)
{
    std::vector<Eigen::Index> rows;
    std::vector<Block> blocks;
    Eigen::Index row = 0;
    for (const Block& block : blocks_)
    {
        const Eigen::Index end = row + block.size();
        if (isKept(block))
        {
            blocks.push_back(block);
            for (Eigen::Index i = row; i < end; ++i)
            {
                rows.push_back(i);
            }
        }
        row = end;
    }
    cov_ = cov_(rows, rows).eval();
    blocks_ = std::move(blocks);
}
}  // namespace pointplane
