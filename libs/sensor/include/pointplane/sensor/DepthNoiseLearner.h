// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/DepthNoise.h>

#include <opencv2/core/mat.hpp>

#include <array>
#include <string>

namespace pointplane
{
/** What kind of depth camera made a sequence of images, and how it errs.
 *
 * Small cells of the image are fitted by planes in inverse depth; the least of their residuals tell
 * the noise at each depth. Structured light is known by its levels of disparity, or by a noise of
 * its size: it keeps the noise that is given, which is known best (Khoshelham & Elberink 2012). Any
 * other camera has the noise of the residuals, and bends surfaces in proportion to their distance
 * (kBend). Cells too small to show that are all that is used: large ones cannot tell a bent depth
 * image from a bent surface.
 *
 * Where noise is of that size but without the levels, it is learnt if it is more, and time of
 * flight is known by noise that does not grow with the distance.
 *
 * The same images give the same noise. Images are looked at rarely once there have been some. */
class DepthNoiseLearner
{
 public:
    /** \param given [DepthNoise] of the configuration; where it says its kind, only levels are
     * learnt */
    explicit DepthNoiseLearner(const DepthNoise& given);

    /** Takes in the next image. \param depth CV_32FC1 [m], NaN = no reading */
    void update(const cv::Mat& depth);

    /** Another camera: forgets the images so far. */
    void reset() { *this = DepthNoiseLearner(DepthNoise(given_)); }

    /** What is known by now. Its kind is never "learn". */
    [[nodiscard]] const DepthNoise& noise() const { return noise_; }

 private:
    static constexpr int kNumDepths = 14;  //!< half octaves from 0.125 m
    static constexpr int kNumLevels = 64;  //!< quarter octaves of the residuals from 1 um
    using Histogram = std::array<double, kNumLevels>;

    void addCell(const cv::Mat& depth, int u0, int v0);
    void addSteps(const float* row, int count);
    [[nodiscard]] bool hasLevels() const;  //!< of structured light's disparity
    [[nodiscard]] std::string judgedKind() const;
    void decide();

    DepthNoise given_, noise_;
    long numImages_{0};
    std::array<Histogram, kNumDepths> residuals_{};  //!< of cells, sigma_Z
    std::array<double, kNumDepths> cells_{};
    double fineSteps_{0}, steps_{0};  //!< between neighbours: below structured light's, and all
};
}  // namespace pointplane
