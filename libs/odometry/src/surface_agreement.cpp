// SPDX-License-Identifier: BSD-3-Clause
#include "surface_agreement.h"

#include "surface_comparison.h"

namespace pointplane
{
SurfaceSamples::SurfaceSamples(const RgbdFrame& frame, const DepthNoise& noise)
{
    const PixelGrid grid(frame.depth.size());
    for (int row = 0; row < grid.size.height; ++row)
    {
        for (int column = 0; column < grid.size.width; ++column)
        {
            const Eigen::Vector3f point = surfaceAt(frame, grid.pixel(column, row), noise);
            if (point.z() > 0)
            {
                points_cam.push_back(point);
            }
        }
    }
}

Agreement& Agreement::operator+=(const Agreement& other)
{
    agrees += other.agrees;
    hidden += other.hidden;
    vanished += other.vanished;
    return *this;
}

Agreement compareSurfaces(
    const SurfaceSamples& reference,
    const Eigen::Isometry3d& T_cur_ref,
    const RgbdFrame& current,
    const DepthNoise& noise,
    double slack_m)
{
    using Sight = ComparedDepth::Sight;
    const ComparedDepth compared(current, T_cur_ref, noise, slack_m);
    Agreement out;
    for (const Eigen::Vector3f& p_ref : reference.points_cam)
    {
        const Sight sight = compared(p_ref);
        out.agrees += sight == Sight::Agrees;
        out.hidden += sight == Sight::Hidden;
        out.vanished += sight == Sight::Vanished;
    }
    return out;
}
}  // namespace pointplane
