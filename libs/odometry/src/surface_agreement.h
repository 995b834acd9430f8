// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/DepthNoise.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <Eigen/Geometry>

#include <vector>

namespace pointplane
{
/** Points on the surfaces that a frame saw, on a thin grid of its depth image. */
struct SurfaceSamples
{
    SurfaceSamples() = default;

    /** Depth jumps are left out: their readings belong to neither side.
     * \param noise of the depth camera */
    SurfaceSamples(const RgbdFrame& frame, const DepthNoise& noise);

    std::vector<Eigen::Vector3f> points_cam;  //!< camera frame, optical axes [m]
};

/** How many surface points of one frame another frame sees where they should be. */
struct Agreement
{
    int agrees{0};    //!< the other frame sees a surface there
    int hidden{0};    //!< it sees something in front of it
    int vanished{0};  //!< it sees through it

    [[nodiscard]] int seen() const { return agrees + hidden + vanished; }

    /** Fraction of the compared samples that agrees; 0 if none can be compared, as nothing speaks
     * for the motion then. */
    [[nodiscard]] double fraction() const
    {
        return seen() > 0 ? static_cast<double>(agrees) / seen() : 0;
    }

    Agreement& operator+=(const Agreement& other);
};

/** Compares two depth images under a motion. The features that made an estimate agree with it even
 * if they are wrong; the rest of the depth image does not. A motion that is wrong by 5 cm or 5 deg
 * leaves about a third of the surfaces in agreement (docs/theory.md, Verdict).
 * \param T_cur_ref from the camera when the reference's depth image was exposed to the camera when
 * the current one was
 * \param noise of the depth camera
 * \param slack_m allowed difference of depths beyond the sensor's noise and distortion [m] */
[[nodiscard]] Agreement compareSurfaces(
    const SurfaceSamples& reference,
    const Eigen::Isometry3d& T_cur_ref,
    const RgbdFrame& current,
    const DepthNoise& noise,
    double slack_m);
}  // namespace pointplane
