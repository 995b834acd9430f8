// SPDX-License-Identifier: BSD-3-Clause
#include "JointCovariance.h"

#include <pointplane/core/covariance.h>
#include <pointplane/core/se3.h>

#include <algorithm>
#include <utility>

namespace pointplane
{
void JointCovariance::start(int frame, const Matrix6d& cov)
{
    constexpr Eigen::Index size = 12 + kNumCameraErrors;
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
    all.topLeftCorner<6, 6>() = cov;
    errors_.start({{Kind::Pose, frame}, {Kind::Velocity, frame}, {Kind::Camera, 0}}, all);
    latest_ = previous_ = frame;
    restart(frame);
}

void JointCovariance::changeCamera(const CameraMatrix& cov)
{
    errors_.makeIndependent(Kind::Camera, 0, cov);
}

void JointCovariance::predict(const Eigen::Isometry3d& T_world_latest, const Prediction& prediction)
{
    if (!has(Kind::Coasting, 0))
    {
        errors_.prepend(
            {{Kind::Coasting, 0}}, Eigen::MatrixXd::Zero(6, errors_.size()), prediction.velocity);
    }
    const Matrix6d Ad = adjoint(T_world_latest);
    const Eigen::Index velocity = find(Kind::Coasting, 0);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(12, errors_.size());
    A.block<6, 6>(0, newest()).setIdentity();
    A.block<6, 6>(0, velocity) = Ad * prediction.after.reach().asDiagonal();
    A.block<6, 6>(6, velocity) = prediction.after.kept().asDiagonal();
    Matrix12d toWorld = Matrix12d::Identity();
    toWorld.topLeftCorner<6, 6>() = Ad;
    errors_.prepend(
        {{Kind::Pose, latest_ + 1}, {Kind::Coasting, 0}}, A, propagate(toWorld, prediction.noise));
    ++latest_;
    dropCoasting(1);
}

/** All but the first `kept` of the velocities since the latest measured frame. */
void JointCovariance::dropCoasting(int kept)
{
    errors_.keepIf([&](const Block& block) { return block.kind != Kind::Coasting || kept-- > 0; });
}

void JointCovariance::restart(int frame, const std::vector<int>& poses)
{
    std::vector<int> kept = poses;
    kept.push_back(frame);
    errors_.rename(Kind::Velocity, previous_, frame);
    previous_ = frame;
    earlier_.reset();
    keep({}, kept);
    errors_.prependAlike(Kind::View, {frame}, 0, Eigen::MatrixXd::Identity(1, 1));
}

/** How the errors of the new pose (in the world) and velocity depend on all blocks so far: the
 * upper part of A in docs/theory.md, section Window. The predicted motion starts at the previous
 * frame with its velocity, which decays: an error of that moves it by the velocity's reach. */
Eigen::MatrixXd JointCovariance::dependence(
    int frame,
    const Matrix6d& Ad,
    const DecayedVelocities& decayed,
    const Measurement& measurement) const
{
    const Matrix6d Ad_inverse = Ad.inverse();  // from the world to the previous frame
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(12, errors_.size());
    const auto addView = [&](Kind kind, int reference, const Eigen::MatrixXd& change)
    {
        A.middleCols(find(kind, reference), change.cols()) -= change;
        A.middleCols(find(kind, frame), change.cols()) += change;
    };
    const Sensitivity& of = measurement.factors;
    const Views& views = measurement.views;
    const auto prior = of.prior.leftCols<6>();
    A.middleCols<6>(find(Kind::Pose, previous_)) += prior * Ad_inverse;
    A.middleCols<6>(find(Kind::Velocity, previous_)) +=
        prior * decayed.reach().asDiagonal() +
        of.prior.rightCols<6>() * decayed.kept().asDiagonal();
    for (const auto& [reference, change] : of.references)
    {
        const Matrix126d byPose = change.leftCols<6>();
        A.middleCols<6>(find(Kind::Pose, reference)) += byPose * Ad_inverse;
        if (has(Kind::Velocity, reference))
        {
            A.middleCols<6>(find(Kind::Velocity, reference)) += change.rightCols<6>();
        }
        if (has(Kind::PlaneView, frame))
        {
            addView(Kind::PlaneView, reference, byPose * views.planeRoot);
        }
    }
    for (const auto& [reference, change] : of.referencePoints)
    {
        addView(Kind::View, reference, change * views.pointSigma.asDiagonal());
    }
    if (views.patchSigma > 0)
    {
        const auto addPatches = [&](int image, const MotionByPatches& change)
        { A.middleCols<kNumPatches>(find(Kind::Bend, image)) += views.patchSigma * change; };
        addPatches(frame, of.patches);
        for (const auto& [reference, change] : of.referencePatches)
        {
            addPatches(reference, change);
        }
    }
    A.middleCols<kNumCameraErrors>(find(Kind::Camera, 0)) += of.camera;
    A.topRows<6>() = (Ad * A.topRows<6>()).eval();
    return A;
}

void JointCovariance::measure(
    const Eigen::Isometry3d& T_world_prev,
    const DecayedVelocities& decayed,
    const Measurement& measurement,
    const std::optional<MotionModel::Smoothed>& previousVelocity)
{
    const int frame = latest_ + 1;
    const Matrix6d Ad = adjoint(T_world_prev);
    const Views& views = measurement.views;
    addViews(frame, Kind::View, views.frames, views.ofPoints);
    if (!views.planeRoot.isZero(0))
    {
        addViews(frame, Kind::PlaneView, views.frames, views.ofPlanes);
    }
    if (views.patchSigma > 0)
    {
        addViews(frame, Kind::Bend, views.frames, views.ofPatches);
    }

    constexpr Eigen::Index camera = 12, size = camera + kNumCameraErrors;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, errors_.size());
    A.topRows<12>() = dependence(frame, Ad, decayed, measurement);
    A.block<kNumCameraErrors, kNumCameraErrors>(camera, find(Kind::Camera, 0)) =
        measurement.camera.gain;
    Matrix12d toWorld = Matrix12d::Identity();
    toWorld.topLeftCorner<6, 6>() = Ad;
    Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(size, size);
    Q.topLeftCorner<12, 12>() = propagate(toWorld, measurement.noise);
    Q.block<kNumCameraErrors, kNumCameraErrors>(camera, camera) = measurement.camera.noise;
    errors_.prepend({{Kind::Pose, frame}, {Kind::Velocity, frame}, {Kind::Camera, 0}}, A, Q);
    // The camera's errors after the frame take the place of those before.
    int numCameras = 0;
    errors_.keepIf([&](const Block& block)
                   { return block.kind != Kind::Camera || numCameras++ == 0; });
    if (previousVelocity)
    {
        smooth(frame, Ad, *previousVelocity);
    }
    earlier_ = {previous_, Ad};
    latest_ = previous_ = frame;
    dropCoasting();
}

/** The velocity of the previous frame is corrected. \param frame the new one \param Ad adjoint of
 * the pose of the previous one */
void JointCovariance::smooth(int frame, const Matrix6d& Ad, const MotionModel::Smoothed& velocity)
{
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(6, errors_.size());
    A.middleCols<6>(find(Kind::Velocity, previous_)) = velocity.byVelocity;
    A.middleCols<6>(find(Kind::Velocity, frame)) = velocity.byNextVelocity;
    const auto addMotion = [&](int from, int to, const Matrix6d& change)
    {
        A.middleCols<6>(find(Kind::Pose, from)) -= change;
        A.middleCols<6>(find(Kind::Pose, to)) += change;
    };
    addMotion(previous_, frame, velocity.byNextMotion * Ad.inverse());
    if (earlier_ && has(Kind::Pose, earlier_->frame))
    {
        addMotion(earlier_->frame, previous_, velocity.byPreviousMotion * earlier_->Ad.inverse());
    }
    errors_.replace(Kind::Velocity, previous_, A);
}

/** Of a new frame, and of places that were recalled. */
void JointCovariance::addViews(
    int frame, Kind kind, const std::vector<int>& references, const Eigen::MatrixXd& C)
{
    std::vector<int> frames = references;
    frames.push_back(frame);
    for (std::size_t k = 0; k < frames.size(); ++k)
    {
        if (!has(kind, frames[k]))
        {
            errors_.prependAlike(kind, frames, k, C);
        }
    }
}

void JointCovariance::keep(const std::vector<int>& references, const std::vector<int>& poses)
{
    const auto contains = [](const std::vector<int>& frames, int frame)
    { return std::count(frames.begin(), frames.end(), frame) > 0; };
    int numPoses = 0;
    errors_.keepIf(
        [&](const Block& block)
        {
            const bool isReference = contains(references, block.frame);
            switch (block.kind)
            {
                case Kind::Pose:
                    return numPoses++ <= history_ || block.frame == previous_ || isReference ||
                           contains(poses, block.frame);
                case Kind::Velocity:
                    return isReference || block.frame == previous_;
                case Kind::View:
                case Kind::PlaneView:
                case Kind::Bend:
                    return isReference;
                default:
                    return true;
            }
        });
}

Matrix6d JointCovariance::latest() const { return at(newest(), newest()); }

Matrix6d JointCovariance::velocity(int frame) const
{
    if (!has(Kind::Velocity, frame))
    {
        return Matrix6d::Zero();
    }
    const Eigen::Index k = find(Kind::Velocity, frame);
    return at(k, k);
}

Matrix6d JointCovariance::relative(int from, const Eigen::Isometry3d& T_world_from) const
{
    const Eigen::Index n = newest(), k = find(Kind::Pose, from);
    return propagate(
        adjoint(T_world_from.inverse()), (at(n, n) - at(n, k) - at(k, n) + at(k, k)).eval());
}

Matrix6d JointCovariance::at(Eigen::Index row, Eigen::Index column) const
{
    return errors_.cov().block<6, 6>(row, column);
}
}  // namespace pointplane
