// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

#include <functional>
#include <vector>

namespace pointplane
{
/** Errors of zero mean with one covariance, in blocks that have names. In brackets: their symbols
 * in docs/theory.md, section Window. */
class JointGaussian
{
 public:
    enum class Kind
    {
        Pose,      //!< [xi]
        Velocity,  //!< of a measured frame [nu]
        Coasting,  //!< velocity since the latest measured frame
        Camera,    //!< [k]
        Bend,      //!< of a reference: scale of depth in each patch [s]; of unit variance
        View,      //!< of a reference: error of points by the view [eta]; of unit variance
        PlaneView  //!< likewise of planes, of the pose alone [zeta]
    };
    struct Block
    {
        Kind kind;
        int frame;  //!< 0 where there is one for all frames
        [[nodiscard]] Eigen::Index size() const;
        [[nodiscard]] bool is(Kind k, int f) const { return kind == k && frame == f; }
    };

    /** Replaces all blocks. */
    void start(const std::vector<Block>& blocks, const Eigen::MatrixXd& cov);

    [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }
    [[nodiscard]] bool has(Kind kind, int frame) const;

    /** First row of the first such block.
     * \throws std::invalid_argument if there is none */
    [[nodiscard]] Eigen::Index find(Kind kind, int frame) const;

    [[nodiscard]] Eigen::Index size() const { return cov_.rows(); }
    [[nodiscard]] const Eigen::MatrixXd& cov() const { return cov_; }

    /** Augments the state: adds blocks in front, whose errors are A times those of all so far plus
     * noise of covariance Q. */
    void prepend(
        const std::vector<Block>& blocks, const Eigen::MatrixXd& A, const Eigen::MatrixXd& Q);

    /** Adds the block of one more frame, a value of a Gaussian process with unit variance: its
     * distribution given those of the other frames. \param added index of the frame in `frames`
     * \param C correlation of the errors of `frames`, the same in each component */
    void prependAlike(
        Kind kind, const std::vector<int>& frames, std::size_t added, const Eigen::MatrixXd& C);

    /** Gives a block other errors: A times those of all. */
    void replace(Kind kind, int frame, const Eigen::MatrixXd& A);

    /** Gives a block errors that are independent of all others. */
    void makeIndependent(Kind kind, int frame, const Eigen::MatrixXd& cov);

    void rename(Kind kind, int from, int to);

    /** Forgets the blocks that are not kept. isKept() is asked from front to back. */
    void keepIf(const std::function<bool(const Block&)>& isKept);

 private:
    std::vector<Block> blocks_;
    Eigen::MatrixXd cov_;  //!< of the blocks in this order
};
}  // namespace pointplane
