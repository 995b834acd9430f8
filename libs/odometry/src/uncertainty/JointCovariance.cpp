// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/choice.h>
#include <pointplane/core/covariance.h>
#include <pointplane/core/range.h>
#include <pointplane/core/se3.h>
#include <pointplane/odometry/uncertainty/JointCovariance.h>

#include <algorithm>

namespace pointplane
{
namespace
{
/** Part of a frame's own error that stays when others are compared with it: it measured its pose by
 * features of which about half will measure that of others. */
constexpr double kOwnErrorKept = 0.5;

constexpr Eigen::Index kSize = 6;
}  // namespace

bool JointCovariance::TParams::isJoint() const
{
    return chosen<bool>("model", model, {{"joint", true}, {"independent", false}});
}

void JointCovariance::TParams::check() const
{
    (void)isJoint();
    checkRange("noise", noise, 1e-3, 1000);
    checkRange("drift", drift, 0, 1000);
    checkRange("driftSigma", driftSigma, 0, 1);
    checkRange("motion", motion, 0, 1000);
    checkRange("vignetting", vignetting, 0, 1);
    checkRange("principalPoint", principalPoint, 0, 100);
    checkRange("focalLength", focalLength, 0, 10);
    checkRange("history", history, 1, 300);
}

JointCovariance::JointCovariance(const TParams& params) : params_(params) { params_.check(); }

void JointCovariance::start(int frame, const Matrix6d& cov)
{
    blocks_ = {{Kind::Pose, frame}, {Kind::Velocity, 0}, {Kind::Camera, 0}};
    cov_ = Eigen::MatrixXd::Zero(3 * kSize, 3 * kSize);
    cov_.topLeftCorner<kSize, kSize>() = cov;
    const Eigen::Matrix<double, kNumCameraErrors, 1> camera{
        params_.vignetting, params_.principalPoint, params_.principalPoint, params_.focalLength};
    cov_.diagonal().segment<kNumCameraErrors>(find(Kind::Camera, 0)) = camera.cwiseAbs2();
    restart(frame);
}

void JointCovariance::predict(
    int frame, const Eigen::Isometry3d& T_world_latest, const Matrix6d& cov)
{
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(kSize, cov_.cols());
    A.leftCols<kSize>().setIdentity();
    prepend({{Kind::Pose, frame}}, A, propagate(adjoint(T_world_latest), cov));
}

void JointCovariance::restart(int frame, const std::vector<int>& references)
{
    keep(references, frame);
    previous_ = frame;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(kSize, cov_.cols());
    A.middleCols<kSize>(find(Kind::Pose, frame)).setIdentity();
    prepend({{Kind::Reference, frame}}, A, Matrix6d::Zero());
}

/** Of pose and velocity on all blocks so far. The predicted motion starts at the previous frame
 * with its velocity: an error of that moves it by dt times as much. */
Eigen::MatrixXd JointCovariance::dependence(
    const Matrix6d& Ad, double dt, const Measurement& measurement) const
{
    const Matrix6d Ad_inverse = Ad.inverse();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * kSize, cov_.cols());
    const auto prior = measurement.prior.leftCols<kSize>();
    A.middleCols<kSize>(find(Kind::Pose, previous_)) += prior * Ad_inverse;
    A.middleCols<kSize>(find(Kind::Velocity, 0)) +=
        dt * prior + measurement.prior.rightCols<kSize>();
    for (const auto& [frame, change] : measurement.references)
    {
        A.middleCols<kSize>(find(Kind::Reference, frame)) += change * Ad_inverse;
    }
    A.middleCols<kNumCameraErrors>(find(Kind::Camera, 0)) += measurement.camera;
    A.topRows<kSize>() = (Ad * A.topRows<kSize>()).eval();
    return A;
}

void JointCovariance::measure(
    int frame, const Eigen::Isometry3d& T_world_prev, double dt, const Measurement& measurement)
{
    const Matrix6d Ad = adjoint(T_world_prev);
    const Matrix6d drift = propagate(Ad, measurement.drift);
    for (size_t k = 0; k < blocks_.size(); ++k)
    {
        if (blocks_[k].kind == Kind::Reference)
        {
            const auto row = static_cast<Eigen::Index>(k) * kSize;
            cov_.block<kSize, kSize>(row, row) += drift;
        }
    }
    // Pose, velocity, and the same frame as a reference.
    Eigen::MatrixXd A(3 * kSize, cov_.cols());
    A.topRows<2 * kSize>() = dependence(Ad, dt, measurement);
    A.bottomRows<kSize>() = A.topRows<kSize>();
    Matrix12d toWorld = Matrix12d::Identity();
    toWorld.topLeftCorner<kSize, kSize>() = Ad;
    const Matrix12d own = propagate(toWorld, measurement.noise);
    const Matrix12d prior = propagate(toWorld, measurement.priorNoise);
    Eigen::MatrixXd Q(3 * kSize, 3 * kSize);
    Q.topLeftCorner<2 * kSize, 2 * kSize>() = own + prior;
    Q.bottomLeftCorner<kSize, 2 * kSize>() = (kOwnErrorKept * own + prior).topRows<kSize>();
    Q.topRightCorner<2 * kSize, kSize>() = Q.bottomLeftCorner<kSize, 2 * kSize>().transpose();
    Q.bottomRightCorner<kSize, kSize>() = (own + prior).topLeftCorner<kSize, kSize>();

    const auto velocity = find(Kind::Velocity, 0) / kSize;
    prepend({{Kind::Pose, frame}, {Kind::Velocity, 0}, {Kind::Reference, frame}}, A, Q);
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < blocks_.size(); ++k)
    {
        if (k != static_cast<std::size_t>(velocity) + 3)
        {
            kept.push_back(k);
        }
    }
    select(kept);
    previous_ = frame;
}

void JointCovariance::keep(const std::vector<int>& references, std::optional<int> pose)
{
    std::vector<std::size_t> kept;
    int numPoses = 0;
    for (std::size_t k = 0; k < blocks_.size(); ++k)
    {
        const auto& [kind, frame] = blocks_[k];
        bool isWanted = true;
        if (kind == Kind::Pose)
        {
            isWanted = numPoses++ <= params_.history || frame == previous_ || frame == pose;
        }
        else if (kind == Kind::Reference)
        {
            isWanted = std::count(references.begin(), references.end(), frame) > 0;
        }
        if (isWanted)
        {
            kept.push_back(k);
        }
    }
    select(kept);
}

Matrix6d JointCovariance::latest() const { return at(0, 0); }

bool JointCovariance::knows(int frame) const
{
    return std::any_of(
        blocks_.begin(),
        blocks_.end(),
        [frame](const Block& b) { return b.kind == Kind::Pose && b.frame == frame; });
}

Matrix6d JointCovariance::relative(int from, const Eigen::Isometry3d& T_world_from) const
{
    const Eigen::Index k = find(Kind::Pose, from);
    return propagate(
        adjoint(T_world_from.inverse()), (at(0, 0) - at(0, k) - at(k, 0) + at(k, k)).eval());
}

/** First row of a block. */
Eigen::Index JointCovariance::find(Kind kind, int frame) const
{
    const auto it = std::find_if(
        blocks_.begin(),
        blocks_.end(),
        [&](const Block& b) { return b.kind == kind && b.frame == frame; });
    POINTPLANE_CHECK(it != blocks_.end(), "frame " << frame << " is not in the window");
    return (it - blocks_.begin()) * kSize;
}

Matrix6d JointCovariance::at(Eigen::Index row, Eigen::Index column) const
{
    return cov_.block<kSize, kSize>(row, column);
}

/** Adds blocks whose errors are A times those of the others plus noise of covariance Q. */
void JointCovariance::prepend(
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

void JointCovariance::select(const std::vector<std::size_t>& kept)
{
    std::vector<Block> blocks;
    const auto n = static_cast<Eigen::Index>(kept.size());
    Eigen::MatrixXd cov(n * kSize, n * kSize);
    for (Eigen::Index i = 0; i < n; ++i)
    {
        const auto row = static_cast<Eigen::Index>(kept[static_cast<std::size_t>(i)]) * kSize;
        blocks.push_back(blocks_[kept[static_cast<std::size_t>(i)]]);
        for (Eigen::Index j = 0; j < n; ++j)
        {
            const auto column =
                static_cast<Eigen::Index>(kept[static_cast<std::size_t>(j)]) * kSize;
            cov.block<kSize, kSize>(i * kSize, j * kSize) = at(row, column);
        }
    }
    blocks_ = std::move(blocks);
    cov_ = std::move(cov);
}
}  // namespace pointplane
