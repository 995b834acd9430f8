// SPDX-License-Identifier: BSD-3-Clause
#include "TruthRotationNoise.h"

#include <algorithm>

namespace pointplane
{
namespace
{
/** More corners than an odometry has time for; found again within 2 % of the image width (12.8 px
 * of 640) of the prediction, and similar there. */
[[nodiscard]] PointTracker::TParams trackerParams()
{
    PointTracker::TParams out;
    out.maxPoints = 600;
    out.searchRadiusFraction = 0.02;
    out.minZncc = 0.9;
    return out;
}

/** Every second one. Corners are ordered by their strength, so each half is spread over the image.
 */
[[nodiscard]] std::vector<Sighting> half(const std::vector<Sighting>& all, std::size_t first)
{
    std::vector<Sighting> out;
    for (std::size_t k = first; k < all.size(); k += 2)
    {
        out.push_back(all[k]);
    }
    return out;
}
}  // namespace

TruthRotationNoise::TruthRotationNoise() : tracker_(trackerParams(), {}, {}) {}

std::vector<Sighting> TruthRotationNoise::sightings(
    const RgbdFrame& from, const RgbdFrame& to, const Eigen::Isometry3d& T_to_from) const
{
    const PointReference reference = tracker_.makeReference(from);
    std::vector<Sighting> out;
    for (const PointTrack& track :
         tracker_.track(reference, to, tracker_.pyramid(to.gray), T_to_from))
    {
        const Eigen::Vector3d& p_from =
            reference.points[static_cast<std::size_t>(track.ref)].p_cam.mean;
        out.push_back(
            {T_to_from * p_from,
             to.camera.normalised(track.cur.uv_px),
             track.cur.uv_px.y() / (to.camera.height - 1) - 0.5});
    }
    return out;
}

bool TruthRotationNoise::add(
    const RgbdFrame& from, const RgbdFrame& to, const Eigen::Isometry3d& T_to_from)
{
    const std::vector<Sighting> all = sightings(from, to, T_to_from);
    const auto rotation = fitRotation(all);
    const auto a = fitRotation(half(all, 0)), b = fitRotation(half(all, 1));
    if (!rotation || !a || !b)
    {
        return false;
    }
    ++numPairs_;
    numTracks_ += all.size();
    sumSquares_ += rotation->cwiseAbs2();
    // Each half has twice the variance of the whole, their difference four times.
    sumSquaresOfTracks_ += (*a - *b).cwiseAbs2() / 4;
    return true;
}

RotationNoise TruthRotationNoise::result() const
{
    RotationNoise out;
    out.numPairs = numPairs_;
    const double n = static_cast<double>(std::max<std::size_t>(numPairs_, 1));
    out.meanTracks = static_cast<double>(numTracks_) / n;
    out.sigma = ((sumSquares_ - sumSquaresOfTracks_) / (2 * n)).cwiseMax(0).cwiseSqrt();
    out.sigmaOfTracks = (sumSquaresOfTracks_ / (2 * n)).cwiseSqrt();
    return out;
}
}  // namespace pointplane
