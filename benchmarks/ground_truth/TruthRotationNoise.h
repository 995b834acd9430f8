// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/points/PointTracker.h>
#include <pointplane/sensor/RgbdFrame.h>

#include <vector>

#include "rotation_fit.h"

namespace pointplane
{
/** What the images say of a ground truth, per pose and about the camera's axes x, y, z [rad]. */
struct RotationNoise
{
    std::size_t numPairs{0};
    double meanTracks{0};                            //!< of a pair
    Eigen::Vector3d sigma{Eigen::Vector3d::Zero()};  //!< of the ground truth, tracks' noise removed
    Eigen::Vector3d sigmaOfTracks{Eigen::Vector3d::Zero()};  //!< their noise, in the same terms
};

/** Measures the rotational noise of ground truth by pairs of images, without an odometry.
 *
 * Corners of one image, with depth, are moved by the ground truth into the other and looked for
 * around there. The small rotation that takes them from where the ground truth puts them to where
 * they are is the error of the ground truth's motion: that of two poses, hence the rms over all
 * pairs is divided by sqrt(2). What chance contributes through the tracks shows in how far the
 * rotations of two halves of the tracks differ; it is subtracted. */
class TruthRotationNoise
{
 public:
    TruthRotationNoise();

    /** \param T_to_from motion of the ground truth: p_to = T_to_from * p_from
     * \return false when there are too few tracks */
    bool add(const RgbdFrame& from, const RgbdFrame& to, const Eigen::Isometry3d& T_to_from);

    [[nodiscard]] RotationNoise result() const;

 private:
    [[nodiscard]] std::vector<Sighting> sightings(
        const RgbdFrame& from, const RgbdFrame& to, const Eigen::Isometry3d& T_to_from) const;

    PointTracker tracker_;
    std::size_t numPairs_{0}, numTracks_{0};
    Eigen::Vector3d sumSquares_{Eigen::Vector3d::Zero()};
    Eigen::Vector3d sumSquaresOfTracks_{Eigen::Vector3d::Zero()};
};
}  // namespace pointplane
