// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

#include <functional>
#include <vector>

namespace pointplane
{
/** Errors with one covariance, in blocks that have names, of zero mean. */
class JointGaussian
{
 public:
    enum class Kind
    {
        Pose,
        Velocity,  //!< of a measured frame
        Coasting,  //!< velocity since the latest measured frame
        Camera,
        Bend,      //!< of a reference: scale of depth in each patch; of unit variance
        View,      //!< of a reference: error by its view, of pose and velocity; of unit variance
        PlaneView  //!< likewise of its planes, of the pose alone
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

    /** Adds blocks in front, whose errors are A times those of all so far plus noise of covariance
     * Q. */
    void prepend(
        const std::vector<Block>& blocks, const Eigen::MatrixXd& A, const Eigen::MatrixXd& Q);

    /** Adds the block of one more frame, whose errors are of unit variance. What is known of those
     * of the others foretells a part of them (kriging); the rest is new. \param frames of which
     * `added` is the index \param C how the errors of `frames` correlate, in each component */
    void prependAlike(
        Kind kind, const std::vector<int>& frames, std::size_t added, const Eigen::MatrixXd& C);

    /** Gives a block other errors: A times those of all. */
    void replace(Kind kind, int frame, const Eigen::MatrixXd& A);

    /** Gives a block errors of their own. */
    void makeIndependent(Kind kind, int frame, const Eigen::MatrixXd& cov);

    void rename(Kind kind, int from, int to);

    /** Forgets the other blocks. They are asked for from front to back. */
    void keepIf(const std::function<bool(const Block&)>& isKept);

 private:
    std::vector<Block> blocks_;
    Eigen::MatrixXd cov_;  //!< of the blocks in this order
};
}  // namespace pointplane
