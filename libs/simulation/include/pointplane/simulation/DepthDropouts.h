// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/simulation/Renderer.h>
#include <pointplane/simulation/SimulationParams.h>

#include <vector>

namespace pointplane
{
/** Where a depth camera has no reading: in the projector's shadow, at depth edges, on surfaces that
 * are seen too flat or give none, and out of range. */
class DepthDropouts
{
 public:
    /** \param camera the true one */
    DepthDropouts(const SimulationParams& params, const PinholeCamera& camera, const Scene& scene);

    /** \return CV_8UC1, 0 where there is no reading */
    [[nodiscard]] cv::Mat readable(const CastImage& cast) const;

 private:
    // Of row v; what they lose becomes 0.
    void dropShadow(const float* inverseDepth, uchar* readable) const;
    void dropFlat(const CastImage& cast, int v, uchar* readable) const;
    void dropEdges(const cv::Mat& inverseDepth, int v, uchar* readable) const;

    SimulationParams params_;
    PinholeCamera camera_;
    std::vector<char> hasDepth_;  //!< per surface
};
}  // namespace pointplane
