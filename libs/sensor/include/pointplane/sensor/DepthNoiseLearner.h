// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/DepthNoise.h>

#include <opencv2/core/mat.hpp>

#include <array>
#include <string>
#include <vector>

namespace pointplane
{
/** Learns from depth images what kind of camera made them, and its noise.
 *
 * Planes in inverse depth are fitted to small cells of the image. The smallest residuals tell the
 * noise at each depth; the others are of surfaces that are not plane.
 *
 * - Structured light is known by the levels of its disparity, or by noise of its size. With levels
 *   it keeps the given noise (Khoshelham & Elberink 2012); without them, noise is learnt if it is
 *   more than given.
 * - Time of flight is known by small noise, or by noise that does not grow with the distance;
 *   active stereo by large noise. Their noise is that of the residuals. Besides, they bend
 *   surfaces in proportion to the distance, by a constant that is not learnt: a bent depth image
 *   looks like a bent surface.
 *
 * The same images give the same noise. After the first few, only one image in ten is looked at.
 * Images without depth do not count. */
class DepthNoiseLearner
{
 public:
    /** \param given [DepthNoise] of the configuration; its kind says what is learnt
     * \throws std::invalid_argument naming the key that is out of range */
    explicit DepthNoiseLearner(const DepthNoise& given);

    /** Learns from the next image. \param depth CV_32FC1 [m], NaN = no reading */
    void update(const cv::Mat& depth);

    /** Another camera: forgets the images so far. */
    void reset() { *this = DepthNoiseLearner(DepthNoise(given_)); }

    /** What is known by now. Its kind is "learn" until something told it. */
    [[nodiscard]] const DepthNoise& noise() const { return noise_; }

    /** What the planar cells at a depth tell, where there are enough of them. */
    struct NoiseAtDepth
    {
        double depth;  //!< [m]
        double sigma;  //!< of the depth [m]
        double cells;  //!< how many there were
    };

 private:
    static constexpr int kNumDepths = 20;  //!< half octaves from 0.125 m to 128 m
    static constexpr int kNumLevels = 96;  //!< quarter octaves of the residuals, 1 um to 16 m
    using Histogram = std::array<double, kNumLevels>;

    /** What was seen. */
    struct Counts
    {
        std::array<Histogram, kNumDepths> residuals{};  //!< of cells, sigma_Z
        std::array<double, kNumDepths> cells{};
        double fineSteps{0}, steps{0};  //!< between neighbours: below structured light's, and all
    };

    static void addCell(const cv::Mat& depth, int u0, int v0, Counts& counts);
    static void addSteps(const float* row, int count, Counts& counts);
    /** Fades what was seen, and adds an image. */
    void add(const Counts& image);
    [[nodiscard]] bool hasLevels() const;  //!< of structured light's disparity
    [[nodiscard]] std::vector<NoiseAtDepth> measured() const;
    [[nodiscard]] std::string judgedKind(const std::vector<NoiseAtDepth>& depths) const;
    void decide();

    DepthNoise given_, noise_;
    long numImages_{0};  //!< with depth
    Counts counts_;
};
}  // namespace pointplane
