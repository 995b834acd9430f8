// SPDX-License-Identifier: BSD-3-Clause
#include "lucas_kanade.h"

#include <algorithm>
#include <cmath>

#include "template_correlation.h"

namespace pointplane
{
PatchTemplates::PatchTemplates(int windowPx)
    : windowPx_(windowPx), templateSize_(templateSize(windowPx))
{
}

void PatchTemplates::reserve(std::size_t patches, std::size_t levels)
{
    normals_.reserve(patches * levels);
    samples_.reserve(patches * levels * templateSize_);
}

void PatchTemplates::add(
    const std::vector<cv::Mat>& pyramid, const cv::Point2f& centre, Brightness brightness)
{
    numLevels_ = pyramid.size() / 2;
    const float half = static_cast<float>(windowPx_ - 1) * 0.5F;
    for (std::size_t level = 0; level < numLevels_; ++level)
    {
        const cv::Point2f corner =
            centre * (1.F / static_cast<float>(1 << level)) - cv::Point2f(half, half);
        samples_.resize(samples_.size() + templateSize_);
        normals_.push_back(sampleTemplate(
            pyramid[2 * level],
            pyramid[2 * level + 1],
            corner,
            windowPx_,
            brightness,
            samples_.data() + samples_.size() - templateSize_));
    }
}

/** One level. \return whether the patch has structure and the search ended inside */
bool PatchTemplates::align(
    std::size_t patchAndLevel,
    const cv::Mat& image,
    const PatchSearch& search,
    cv::Point2f& position) const
{
    constexpr double kOscillation = 0.01;  // [px]
    const NormalMatrix& normal = normals_[patchAndLevel];
    if (normal.inverseDeterminant == 0.F)
    {
        return false;
    }
    const std::int16_t* patch = samples_.data() + patchAndLevel * templateSize_;
    const float half = static_cast<float>(windowPx_ - 1) * 0.5F;
    const cv::Point2f centre(half, half);
    cv::Point2f corner = position - centre, previousStep;
    for (int i = 0; i < search.maxIterations; ++i)
    {
        // One row less than the border allows: whole strips are read.
        const int u = cvFloor(corner.x), v = cvFloor(corner.y);
        if (u < -windowPx_ || u >= image.cols || v < -windowPx_ || v >= image.rows - 1)
        {
            return false;
        }
        const cv::Point2f b = templateCorrelation(patch, windowPx_, image, corner);
        const cv::Point2f step(
            (normal.xy * b.y - normal.yy * b.x) * normal.inverseDeterminant,
            (normal.xy * b.x - normal.xx * b.y) * normal.inverseDeterminant);
        corner += step;
        position = corner + centre;
        if (step.ddot(step) <= search.epsilon_px * search.epsilon_px)
        {
            break;
        }
        if (i > 0 && static_cast<double>(std::abs(step.x + previousStep.x)) < kOscillation &&
            static_cast<double>(std::abs(step.y + previousStep.y)) < kOscillation)
        {
            position -= step * 0.5F;
            break;
        }
        previousStep = step;
    }
    return true;
}

bool PatchTemplates::find(
    std::size_t patch,
    const std::vector<cv::Mat>& pyramid,
    const PatchSearch& search,
    cv::Point2f& position) const
{
    const std::size_t numLevels =
        std::min({static_cast<std::size_t>(search.numLevels), numLevels_, pyramid.size()});
    position *= 1.F / static_cast<float>(1 << (numLevels - 1));
    bool found = false;
    for (std::size_t level = numLevels; level-- > 0;)
    {
        found = align(patch * numLevels_ + level, pyramid[level], search, position);
        if (level > 0)
        {
            position *= 2.F;
        }
    }
    return found;
}
}  // namespace pointplane
