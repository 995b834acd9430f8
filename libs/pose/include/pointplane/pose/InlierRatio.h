// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace pointplane
{
/** A feature with a larger robust weight counts as one that agrees. */
constexpr double kCountingWeight = 0.5;

/** How many points of a surface agree with the camera's motion. */
struct InlierRatio
{
    double points{0};   //!< pairs: found again, once for each reference
    double inliers{0};  //!< sum of their robust weights

    /** In (0, 1], as if two more points had agreed: a surface without points counts fully. */
    [[nodiscard]] double value() const
    {
        constexpr double kPrior = 2;
        return (kPrior + inliers) / (kPrior + points);
    }
};

/** What is known of a surface after a frame. Trust falls at once, because a surface that has stood
 * for long may begin to move, and comes back only as time passes, because it may move again. So
 * earlier frames count at most as much as this one, and not at all if they make it better.
 * \param earlier of the frames before \param now of this frame alone */
[[nodiscard]] inline InlierRatio remembered(const InlierRatio& earlier, const InlierRatio& now)
{
    if (now.points == 0)
    {
        return earlier;
    }
    const double share = earlier.points > now.points ? now.points / earlier.points : 1;
    const InlierRatio both{
        now.points + share * earlier.points, now.inliers + share * earlier.inliers};
    return both.value() < earlier.value() ? both : earlier;
}
}  // namespace pointplane
