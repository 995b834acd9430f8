// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/simulation/DepthDropouts.h>
#include <pointplane/simulation/Renderer.h>
#include <pointplane/simulation/SimulationParams.h>

#include <cstdint>

namespace pointplane
{
/** A depth camera: makes readings of the true inverse depth.
 *
 * - Structured light and stereo match windows of a projected pattern. So their noise is one of
 *   disparity = f b / Z: constant in inverse depth, correlated over the window, and quantised
 *   (Khoshelham & Elberink 2012; Konolige & Mihelich 2010). Edges are ragged, because a window may
 *   match either side (lateral noise, Nguyen, Izadi & Lovell 2012).
 * - Time of flight has constant noise in depth, interpolated where the image was enlarged, and a
 *   smooth error in proportion to the depth. A measured pixel at an edge mixes both sides, so its
 *   depth lies between them, where nothing is.
 * - There is no reading at DepthDropouts. */
class DepthSensor
{
 public:
    /** \param cameraKey seed of what is wrong with this camera's calibration */
    DepthSensor(const SimulationParams& params, const Scene& scene, std::uint64_t cameraKey = 0);

    /** \param cast true picture \param frameKey seed of this frame's noise
     * \return CV_32FC1 [m], NaN = no reading */
    [[nodiscard]] cv::Mat sense(const CastImage& cast, std::uint64_t frameKey) const;

 private:
    struct FrameNoise
    {
        cv::Mat matching;  //!< CV_32FC1, of the inverse depth, calibration included [1/m]
        cv::Mat depth;     //!< CV_32FC1, of the depth [m]
        cv::Mat relative;  //!< CV_32FC1, of the depth, over it
        cv::Mat dx, dy;    //!< CV_16SC1, which neighbour a pixel shows [px]
    };
    [[nodiscard]] FrameNoise frameNoise(std::uint64_t frameKey) const;
    [[nodiscard]] int wholePixels(double length_px) const;
    [[nodiscard]] cv::Mat mixed(const cv::Mat& inverseDepth, const cv::Mat& readable) const;
    void matchRow(
        const cv::Mat& inverseDepth,
        const cv::Mat& readable,
        const FrameNoise& noise,
        int v,
        float* q) const;
    void addLengths(const FrameNoise& noise, int v, float* depth) const;

    SimulationParams params_;
    PinholeCamera camera_;  //!< the true one
    DepthDropouts dropouts_;
    float depthScale_;          //!< what depths are multiplied by
    double step_;               //!< of the inverse depth [1/m], 0 = continuous
    double matchingSigma_{0};   //!< noise before rounding [1/m]
    cv::Mat calibrationError_;  //!< CV_32FC1 [1/m]; empty: none
};
}  // namespace pointplane
