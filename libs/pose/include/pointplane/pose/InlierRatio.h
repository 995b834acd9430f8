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
}  // namespace pointplane
