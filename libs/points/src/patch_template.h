// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/points/PatchAligner.h>

#include <Eigen/Eigenvalues>

namespace pointplane
{
/** Eigenvalues in increasing order, closed form. */
class EigenSolver2 : public Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>
{
 public:
    explicit EigenSolver2(const Eigen::Matrix2d& S) { computeDirect(S); }
};

/** Whether all samples between two corners have the 4x4 pixels that interpolation needs. */
[[nodiscard]] inline bool isInside(
    const cv::Mat& image, double uMin, double vMin, double uMax, double vMax)
{
    return uMin >= 1 && vMin >= 1 && uMax < image.cols - 2 && vMax < image.rows - 2;
}

/** What noise of the reference image adds to each eigenvalue of the Hessian: a central difference
 * has half the variance of a sample. */
[[nodiscard]] inline double gradientNoise(
    int count, const PatchReference::Level& level, double noiseVariance)
{
    return count * level.noiseGain * 0.5 * noiseVariance;
}

/** Samples (n+2)^2 pixels of the warped reference patch, one more than the patch on all sides.
 * \return mean gain of noise variance, or 0 when the patch is not inside the image */
[[nodiscard]] double sampleWarped(
    const cv::Mat& image,
    const Eigen::Vector2d& centre,
    const Eigen::Matrix2d& A,
    int n,
    float* out);

/** Template, gradients and Hessian from (n+2)^2 samples. \param data 3 n^2 values, written */
void fillLevel(
    const float* samples,
    const PatchAligner::TParams& params,
    PatchReference::Level& level,
    float* data);
}  // namespace pointplane
