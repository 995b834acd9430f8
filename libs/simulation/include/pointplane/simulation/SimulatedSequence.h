// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Plane.h>
#include <pointplane/sensor/RgbdFrame.h>
#include <pointplane/simulation/CameraPath.h>
#include <pointplane/simulation/SimulationParams.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace pointplane
{
struct Scene;

/** The planes that a frame truly shows. */
struct TruePlanes
{
    std::vector<Plane> planes_cam;  //!< camera frame at the frame's stamp, n towards the camera
    cv::Mat labels;                 //!< CV_8UC1: 0 = none or curved, i + 1 = planes_cam[i]
};

/** What moves in a frame. */
struct TrueMovers
{
    cv::Mat labels;  //!< CV_8UC1, of the colour image: 0 = the still world, i + 1 = mover i
    /** How each mover has moved in the world since it was at rest. A point of a mover that is at p
     * (world) in frame a is at T_world_rest_b T_world_rest_a^-1 p in frame b. */
    std::vector<Eigen::Isometry3d> T_world_rest;
};

/** A sequence of RGB-D frames of a scene, with exact ground truth. Frames are rendered when asked
 * for, in any order, from any number of threads; same scene, parameters and seed give the same
 * bytes. World: z up. */
class SimulatedSequence
{
 public:
    using TParams = SimulationParams;

    /** \param scene one of sceneList() \param seed of the motion and the noise (of the scene's
     * looks: params.sceneSeed)
     * \throws std::invalid_argument naming the scene or key */
    SimulatedSequence(const std::string& scene, const TParams& params, std::uint64_t seed);

    /** Another motion through a scene that is built already (building takes a second). */
    SimulatedSequence(
        std::shared_ptr<const Scene> scene, const TParams& params, std::uint64_t seed);
    ~SimulatedSequence();
    SimulatedSequence(SimulatedSequence&&) noexcept;
    SimulatedSequence& operator=(SimulatedSequence&&) noexcept;

    [[nodiscard]] int numFrames() const;
    [[nodiscard]] double stamp(int frame) const;  //!< [s] UTC
    [[nodiscard]] const TParams& params() const;
    [[nodiscard]] const std::shared_ptr<const Scene>& scene() const;

    /** Renders a frame. \param colour out, if given: CV_8UC3 BGR
     * \throws std::invalid_argument when there is no such frame */
    [[nodiscard]] RgbdFrame frame(int frame, cv::Mat* colour = nullptr) const;

    /** T_world_cam, optical axes. \param stamp [s] UTC, as in RgbdFrame */
    [[nodiscard]] Eigen::Isometry3d truth(double stamp) const;

    /** T_a_b of the camera between two frames. */
    [[nodiscard]] Eigen::Isometry3d trueMotion(int a, int b) const;

    /** Planes and their pixels, as in the depth image but without its gaps. */
    [[nodiscard]] TruePlanes truePlanes(int frame) const;

    /** Movers and their pixels in the middle of the colour exposure, also of movers that stand
     * still. */
    [[nodiscard]] TrueMovers trueMovers(int frame) const;

 private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};
}  // namespace pointplane
