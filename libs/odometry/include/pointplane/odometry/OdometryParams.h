// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/Parameters.h>
#include <pointplane/sensor/DepthNoise.h>

namespace pointplane
{
/** All parameters of the odometry, one ini section a group. */
struct OdometryParams
{
    DepthNoise depthNoise;

    /** Calls f(sectionName, group) for each group. */
    template <class F>
    void visitSections(F&& f)
    {
        f("DepthNoise", depthNoise);
    }

    /** \throws std::invalid_argument naming section and key */
    void check() const;
};
}  // namespace pointplane
