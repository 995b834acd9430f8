// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/choice.h>
#include <pointplane/core/covariance.h>
#include <pointplane/core/range.h>
#include <pointplane/core/se3.h>
#include <pointplane/odometry/uncertainty/JointCovariance.h>

#include <algorithm>
#include <utility>

namespace pointplane
{
namespace
{
constexpr Eigen::Index kSize = 6;  //!< of a pose's or a velocity's error
}  // namespace

bool JointCovariance::TParams::isJoint() const
{
    return chosen<bool>("model", model, {{"joint", true}, {"independent", false}});
}

void JointCovariance::TParams::check() const
{
    (void)isJoint();
    checkRange("noise", noise, 1e-3, 1000);
    checkRange("viewNoise", viewNoise, 0, 1000);
    checkRange("vignetting", vignetting, 0, 1);
    checkRange("principalPoint", principalPoint, 0, 100);
    checkRange("focalLength", focalLength, 0, 10);
    checkRange("depthScale", depthScale, 0, 10);
    checkRange("history", history, 1, 300);
}

JointCovariance::JointCovariance(const TParams& params) : params_(params) { params_.check(); }

void JointCovariance::start(int frame, const Matrix6d& cov)
{
    constexpr Eigen::Index size = 2 * kSize + kNumCameraErrors;
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(size, size);
    all.topLeftCorner<kSize, kSize>() = cov;
    errors_.start({{Kind::Pose, frame}, {Kind::Velocity, frame}, {Kind::Camera, 0}}, all);
    latest_ = previous_ = frame;
    restart(frame);
}

void JointCovariance::changeCamera(const CameraMatrix& cov)
{
    errors_.makeIndependent(Kind::Camera, 0, cov);
}

void JointCovariance::predict(
    int frame, const Eigen::Isometry3d& T_world_latest, const Prediction& prediction)
{
    if (!has(Kind::Coasting, 0))
    {
        errors_.prepend(
            {{Kind::Coasting, 0}},
            Eigen::MatrixXd::Zero(kSize, errors_.size()),
            prediction.velocity);
    }
    const Matrix6d Ad = adjoint(T_world_latest);
    const Eigen::Index velocity = find(Kind::Coasting, 0);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * kSize, errors_.size());
    A.block<kSize, kSize>(0, newest()).setIdentity();
    A.block<kSize, kSize>(0, velocity) = Ad * prediction.after.reach().asDiagonal();
    A.block<kSize, kSize>(kSize, velocity) = prediction.after.kept().asDiagonal();
    Matrix12d toWorld = Matrix12d::Identity();
    toWorld.topLeftCorner<kSize, kSize>() = Ad;
    errors_.prepend(
        {{Kind::Pose, frame}, {Kind::Coasting, 0}}, A, propagate(toWorld, prediction.noise));
    latest_ = frame;
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
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * kSize, errors_.size());
    const auto addView = [&](Kind kind, int reference, const Eigen::MatrixXd& change)
    {
        A.middleCols(find(kind, reference), change.cols()) -= change;
        A.middleCols(find(kind, frame), change.cols()) += change;
    };
    const Sensitivity& of = measurement.factors;
    const Views& views = measurement.views;
    const auto prior = of.prior.leftCols<kSize>();
    A.middleCols<kSize>(find(Kind::Pose, previous_)) += prior * Ad_inverse;
    A.middleCols<kSize>(find(Kind::Velocity, previous_)) +=
        prior * decayed.reach().asDiagonal() +
        of.prior.rightCols<kSize>() * decayed.kept().asDiagonal();
    for (const auto& [reference, change] : of.references)
    {
        const Matrix126d byPose = change.leftCols<6>();
        A.middleCols<kSize>(find(Kind::Pose, reference)) += byPose * Ad_inverse;
        if (has(Kind::Velocity, reference))
        {
            A.middleCols<kSize>(find(Kind::Velocity, reference)) += change.rightCols<6>();
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
    A.topRows<kSize>() = (Ad * A.topRows<kSize>()).eval();
    return A;
}

void JointCovariance::measure(
    int frame,
    const Eigen::Isometry3d& T_world_prev,
    const DecayedVelocities& decayed,
    const Measurement& measurement,
    const std::optional<MotionModel::Smoothed>& previousVelocity)
{
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

    constexpr Eigen::Index camera = 2 * kSize, size = camera + kNumCameraErrors;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, errors_.size());
    A.topRows<2 * kSize>() = dependence(frame, Ad, decayed, measurement);
    A.block<kNumCameraErrors, kNumCameraErrors>(camera, find(Kind::Camera, 0)) =
        measurement.camera.gain;
    Matrix12d toWorld = Matrix12d::Identity();
    toWorld.topLeftCorner<kSize, kSize>() = Ad;
    Eigen::MatrixXd Q = Eigen::MatrixXd::Zero(size, size);
    Q.topLeftCorner<2 * kSize, 2 * kSize>() =
        propagate(toWorld, measurement.noise);
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
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(kSize, errors_.size());
    A.middleCols<kSize>(find(Kind::Velocity, previous_)) = velocity.byVelocity;
    A.middleCols<kSize>(find(Kind::Velocity, frame)) = velocity.byNextVelocity;
    const auto addMotion = [&](int from, int to, const Matrix6d& change)
    {
        A.middleCols<kSize>(find(Kind::Pose, from)) -= change;
        A.middleCols<kSize>(find(Kind::Pose, to)) += change;
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
                    return numPoses++ <= params_.history || block.frame == previous_ ||
                           isReference || contains(poses, block.frame);
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

bool JointCovariance::knows(int frame) const { return has(Kind::Pose, frame); }

Matrix6d JointCovariance::relative(int from, const Eigen::Isometry3d& T_world_from) const
{
    const Eigen::Index n = newest(), k = find(Kind::Pose, from);
    return propagate(
        adjoint(T_world_from.inverse()), (at(n, n) - at(n, k) - at(k, n) + at(k, k)).eval());
}

Matrix6d JointCovariance::at(Eigen::Index row, Eigen::Index column) const
{
    return errors_.cov().block<kSize, kSize>(row, column);
}
}  // namespace pointplane
