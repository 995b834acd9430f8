// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/simulation/SimulationParams.h>

#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <vector>

namespace pointplane
{
/** Lens and pixels of the colour camera: blur, vignetting, exposure, noise. */
class ColourSensor
{
 public:
    ColourSensor(const SimulationParams& params, std::uint64_t seed);

    /** \param exposures CV_8UC3, pictures at instants spread over the exposure
     * \param t [s] since the beginning, for changes of exposure \return CV_8UC3 */
    [[nodiscard]] cv::Mat sense(
        const std::vector<cv::Mat>& exposures, double t, std::uint64_t frameKey) const;

 private:
    [[nodiscard]] double gain(double t) const;

    SimulationParams params_;
    double swingPhase_{0};
    cv::Mat falloff_;            //!< CV_32FC1, brightness of each pixel
    std::vector<float> sigmas_;  //!< noise of each of the 256 intensities
};
}  // namespace pointplane
