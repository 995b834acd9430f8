// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/core/se3.h>
#include <pointplane/simulation/ColourSensor.h>
#include <pointplane/simulation/DepthSensor.h>
#include <pointplane/simulation/Random.h>
#include <pointplane/simulation/SimulatedSequence.h>
#include <pointplane/simulation/scenes.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace pointplane
{
struct SimulatedSequence::Impl
{
    Impl(std::shared_ptr<const Scene> aScene, const TParams& aParams, std::uint64_t aSeed)
        : scene(
              aParams.movers || aScene->movers.empty()
                  ? std::move(aScene)
                  : std::make_shared<const Scene>(withoutMovers(*aScene))),
          params(aParams),
          seed(aSeed),
          camera(params.trueCamera(seed)),
          path(scene->motion, params.motionScale, seed),
          depthSensor(params, *scene, seed),
          colourSensor(params, seed)
    {
    }

    [[nodiscard]] double time(int frame) const { return frame / params.fps; }

    /** T_world_cam. */
    [[nodiscard]] Eigen::Isometry3d pose(double t) const
    {
        Eigen::Isometry3d out = path.pose(params.motionSpeed * t);
        if (params.motionTurnsOnly)
        {
            out.translation() = path.pose(0).translation();
        }
        return out;
    }

    [[nodiscard]] RowPoses rowPoses(double middle, double readout) const
    {
        const auto rows = static_cast<std::size_t>(camera.height);
        if (readout == 0)
        {
            return RowPoses(rows, {pose(middle), middle});
        }
        RowPoses out;
        out.reserve(rows);
        for (int v = 0; v < camera.height; ++v)
        {
            // As in ShutterModel.
            const double t = middle + (static_cast<double>(v) / camera.height - 0.5) * readout;
            out.push_back({pose(t), t});
        }
        return out;
    }

    [[nodiscard]] RowPoses colourPoses(int frame) const
    {
        return rowPoses(time(frame), params.readoutColour);
    }

    [[nodiscard]] RowPoses depthPoses(int frame) const
    {
        return rowPoses(time(frame) + params.depthDelay, params.readoutDepth);
    }

    /** Enough pictures that the steps between them vanish in the lens's blur. */
    [[nodiscard]] int blurSamples(double t) const
    {
        if (params.exposure == 0)
        {
            return 1;
        }
        const double half = 0.5 * params.exposure;
        const Eigen::Isometry3d T_cam_before = pose(t - half).inverse();
        const Eigen::Isometry3d T_cam_after = pose(t + half).inverse();
        const Vector6d motion = se3Log(T_cam_before * T_cam_after.inverse());
        const double typicalDepth = 1.5, nearest = 0.5, step_px = 1.25;
        double flow_px =
            camera.fx * (motion.head<3>().norm() / typicalDepth + motion.tail<3>().norm());
        for (const Surface& surface : scene->surfaces)
        {
            if (surface.mover < 0)
            {
                continue;
            }
            const Mover& mover = scene->movers[static_cast<std::size_t>(surface.mover)];
            const Eigen::Vector3d before =
                T_cam_before * (mover.T_world_rest(t - half) * surface.origin);
            const Eigen::Vector3d after =
                T_cam_after * (mover.T_world_rest(t + half) * surface.origin);
            const double way = camera.fx * (after - before).norm();
            flow_px = std::max(flow_px, way / std::max(after.z(), nearest));
        }
        return std::clamp(static_cast<int>(std::ceil(flow_px / step_px)), 1, params.maxBlurSamples);
    }

    [[nodiscard]] bool oneInstant() const
    {
        return params.depthDelay == 0 && params.readoutColour == params.readoutDepth;
    }

    std::shared_ptr<const Scene> scene;
    TParams params;
    std::uint64_t seed;
    PinholeCamera camera;
    CameraPath path;
    DepthSensor depthSensor;
    ColourSensor colourSensor;
};

SimulatedSequence::SimulatedSequence(
    const std::string& scene, const TParams& params, std::uint64_t seed)
    : SimulatedSequence(
          std::make_shared<const Scene>(
              makeScene(scene, static_cast<std::uint64_t>(params.sceneSeed))),
          params,
          seed)
{
}

SimulatedSequence::SimulatedSequence(
    std::shared_ptr<const Scene> scene, const TParams& params, std::uint64_t seed)
{
    POINTPLANE_CHECK(scene, "no scene");
    params.check();
    impl_ = std::make_unique<Impl>(std::move(scene), params, seed);
}

SimulatedSequence::~SimulatedSequence() = default;
SimulatedSequence::SimulatedSequence(SimulatedSequence&&) noexcept = default;
SimulatedSequence& SimulatedSequence::operator=(SimulatedSequence&&) noexcept = default;

int SimulatedSequence::numFrames() const
{
    return static_cast<int>(std::floor(impl_->params.duration * impl_->params.fps + 1e-9)) + 1;
}

double SimulatedSequence::stamp(int frame) const
{
    return impl_->params.startStamp + impl_->time(frame);
}

const SimulationParams& SimulatedSequence::params() const { return impl_->params; }

const std::shared_ptr<const Scene>& SimulatedSequence::scene() const { return impl_->scene; }

RgbdFrame SimulatedSequence::frame(int frame, cv::Mat* colour) const
{
    POINTPLANE_CHECK(frame >= 0 && frame < numFrames(), "frame " << frame << " of " << numFrames());
    const Impl& s = *impl_;
    const double t = s.time(frame);
    const std::uint64_t key = Random({s.seed, static_cast<std::uint64_t>(frame)}).bits();

    std::vector<cv::Mat> exposures;
    CastImage cast;
    const int samples = s.blurSamples(t);
    for (int k = 0; k < samples; ++k)
    {
        const double offset = ((k + 0.5) / samples - 0.5) * s.params.exposure;
        const RowPoses poses = s.rowPoses(t + offset, s.params.readoutColour);
        cast = castImage(*s.scene, s.camera, poses);
        exposures.push_back(shadeImage(*s.scene, s.camera, poses, cast, s.params.antialias));
    }
    if (samples > 1 || !s.oneInstant())
    {
        cast = castImage(*s.scene, s.camera, s.depthPoses(frame));
    }

    RgbdFrame out;
    out.stamp = stamp(frame);
    out.camera = s.params.camera();
    out.shutter = s.params.shutter();
    out.depth = s.depthSensor.sense(cast, key);
    cv::Mat bgr = s.colourSensor.sense(exposures, t, key);
    cv::cvtColor(bgr, out.gray, cv::COLOR_BGR2GRAY);
    if (colour)
    {
        *colour = bgr;
    }
    return out;
}

Eigen::Isometry3d SimulatedSequence::truth(double stamp) const
{
    return impl_->pose(stamp - impl_->params.startStamp);
}

Eigen::Isometry3d SimulatedSequence::trueMotion(int a, int b) const
{
    return impl_->pose(impl_->time(a)).inverse() * impl_->pose(impl_->time(b));
}

TruePlanes SimulatedSequence::truePlanes(int frame) const
{
    POINTPLANE_CHECK(frame >= 0 && frame < numFrames(), "frame " << frame << " of " << numFrames());
    const Impl& s = *impl_;
    const CastImage cast = castImage(*s.scene, s.camera, s.depthPoses(frame));
    const Eigen::Isometry3d T_cam_world = s.pose(s.time(frame)).inverse();
    TruePlanes out;
    out.labels = cv::Mat::zeros(cast.ids.size(), CV_8UC1);
    std::vector<int> labelOf(s.scene->surfaces.size(), 0);
    for (int v = 0; v < cast.ids.rows; ++v)
    {
        for (int u = 0; u < cast.ids.cols; ++u)
        {
            const std::int32_t id = cast.ids.at<std::int32_t>(v, u);
            if (id < 0 || !s.scene->surfaces[static_cast<std::size_t>(id)].isPlane())
            {
                continue;
            }
            const Surface& surface = s.scene->surfaces[static_cast<std::size_t>(id)];
            int& label = labelOf[static_cast<std::size_t>(id)];
            if (label == 0 && out.planes_cam.size() < 255)
            {
                const Eigen::Isometry3d T_cam_rest =
                    surface.mover < 0
                        ? T_cam_world
                        : T_cam_world *
                              s.scene->movers[static_cast<std::size_t>(surface.mover)].T_world_rest(
                                  s.time(frame));
                out.planes_cam.push_back(
                    transformed(T_cam_rest, {surface.e3, -surface.e3.dot(surface.origin)}));
                label = static_cast<int>(out.planes_cam.size());
            }
            out.labels.at<uchar>(v, u) = static_cast<uchar>(label);
        }
    }
    return out;
}

TrueMovers SimulatedSequence::trueMovers(int frame) const
{
    POINTPLANE_CHECK(frame >= 0 && frame < numFrames(), "frame " << frame << " of " << numFrames());
    const Impl& s = *impl_;
    TrueMovers out;
    for (const Mover& mover : s.scene->movers)
    {
        out.T_world_rest.push_back(mover.T_world_rest(s.time(frame)));
    }
    const CastImage cast = castImage(*s.scene, s.camera, s.colourPoses(frame));
    out.labels = cv::Mat::zeros(cast.ids.size(), CV_8UC1);
    for (int v = 0; v < cast.ids.rows; ++v)
    {
        for (int u = 0; u < cast.ids.cols; ++u)
        {
            const std::int32_t id = cast.ids.at<std::int32_t>(v, u);
            const int mover = id < 0 ? -1 : s.scene->surfaces[static_cast<std::size_t>(id)].mover;
            out.labels.at<uchar>(v, u) = static_cast<uchar>(mover + 1);
        }
    }
    return out;
}
}  // namespace pointplane
