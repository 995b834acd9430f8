// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/types.h>

#include <array>
#include <cstdint>

namespace pointplane
{
/** Where a camera is held and how it is moved, before the hand's own motion is added. World: z up.
 * Its eye looks at its target with the image upright. */
struct CameraMotion
{
    Eigen::Vector3d eye{0, 0, 1};       //!< [m]
    Eigen::Vector3d target{1, 0, 1};    //!< [m]
    Eigen::Vector3d velocity{0, 0, 0};  //!< of eye and target [m/s]
    double orbitAmplitude{0};           //!< swing of the eye around the target [rad]
    double orbitPeriod{12};             //!< [s]
    double turnPeriod{0};               //!< full turn of the view around the eye [s], 0 = none
    double turnRadius{0};               //!< of the circle that the eye goes round meanwhile [m]
    double handSpeed{0.25};             //!< rms speed of the hand's motion [m/s]
    double handTurnRate{0.26};          //!< rms angular rate of the hand's motion [rad/s]
    double tremorSpeed{0.012};          //!< rms, at 3 to 6 Hz [m/s]
    double tremorTurnRate{0.02};        //!< rms [rad/s]
};

/** Smooth hand-held motion with exact pose at any time: a base motion and, on each of the six axes,
 * two slow sinusoids (0.12 to 0.7 Hz) and a tremor with random frequencies and phases. */
class CameraPath
{
 public:
    CameraPath() = default;

    /** \param scale multiplies the hand's motion; 0 = only the base motion */
    CameraPath(const CameraMotion& motion, double scale, std::uint64_t seed);

    /** T_world_cam, optical axes. \param t [s] since the beginning */
    [[nodiscard]] Eigen::Isometry3d pose(double t) const;

 private:
    struct Wave
    {
        double amplitude{0}, omega{0}, phase{0};
    };
    static constexpr int kWaves = 3;

    [[nodiscard]] double hand(int axis, double t) const;

    CameraMotion motion_;
    std::array<std::array<Wave, kWaves>, 6> waves_{};  //!< camera axes: translation, rotation
};
}  // namespace pointplane
