// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include <algorithm>
#include <vector>

namespace pointplane::test
{
/** How well a segmentation agrees with the truth, counted over regions (Hoover et al. 1996). */
struct SegmentationScore
{
    int numTrue{0};   //!< true regions that count
    int numFound{0};  //!< regions of the segmentation
    int correct{0};   //!< true regions with one found region, each covered by the other
    int over{0};      //!< true regions cut into several found ones
    int under{0};     //!< found regions that join several true ones
    int missed{0};    //!< true regions in none of the above
    int spurious{0};  //!< found regions in none of the above

    SegmentationScore& operator+=(const SegmentationScore& o)
    {
        numTrue += o.numTrue;
        numFound += o.numFound;
        correct += o.correct;
        over += o.over;
        under += o.under;
        missed += o.missed;
        spurious += o.spurious;
        return *this;
    }
};

/** Compares label images (CV_8UC1, 0 = no region) at a tolerance, e.g. 0.8 of a region's pixels.
 * \param valid CV_8UC1: pixels that could be segmented (non-zero); others do not count
 * \param minPixels smaller true regions are not asked for, and their pixels count for nobody */
inline SegmentationScore scoreSegmentation(
    const cv::Mat& truth,
    const cv::Mat& found,
    const cv::Mat& valid,
    double tolerance,
    int minPixels)
{
    constexpr size_t kLabels = 256;
    std::vector<int> sizeTrue(kLabels, 0), sizeFound(kLabels, 0);
    std::vector<std::vector<int>> common(kLabels, std::vector<int>(kLabels, 0));
    for (int v = 0; v < truth.rows; ++v)
    {
        for (int u = 0; u < truth.cols; ++u)
        {
            if (valid.at<uchar>(v, u) != 0)
            {
                ++sizeTrue[truth.at<uchar>(v, u)];
            }
        }
    }
    const auto counts = [&](size_t t) { return t > 0 && sizeTrue[t] >= minPixels; };
    for (int v = 0; v < truth.rows; ++v)
    {
        for (int u = 0; u < truth.cols; ++u)
        {
            const size_t t = truth.at<uchar>(v, u), f = found.at<uchar>(v, u);
            if (valid.at<uchar>(v, u) != 0 && (t == 0 || counts(t)))
            {
                ++common[t][f];
                ++sizeFound[f];
            }
        }
    }

    SegmentationScore out;
    std::vector<bool> doneTrue(kLabels, false), doneFound(kLabels, false);
    for (size_t t = 1; t < kLabels; ++t)
    {
        for (size_t f = 1; counts(t) && f < kLabels; ++f)
        {
            if (common[t][f] >= tolerance * sizeTrue[t] && common[t][f] >= tolerance * sizeFound[f])
            {
                ++out.correct;
                doneTrue[t] = doneFound[f] = true;
            }
        }
    }
    // Over: parts that lie in one true region and together cover it.
    for (size_t t = 1; t < kLabels; ++t)
    {
        std::vector<size_t> parts;
        int covered = 0;
        for (size_t f = 1; counts(t) && !doneTrue[t] && f < kLabels; ++f)
        {
            if (!doneFound[f] && sizeFound[f] > 0 && common[t][f] >= tolerance * sizeFound[f])
            {
                parts.push_back(f);
                covered += common[t][f];
            }
        }
        if (parts.size() > 1 && covered >= tolerance * sizeTrue[t])
        {
            ++out.over;
            doneTrue[t] = true;
            std::for_each(parts.begin(), parts.end(), [&](size_t f) { doneFound[f] = true; });
        }
    }
    // Under: one found region that contains several true ones and little else.
    for (size_t f = 1; f < kLabels; ++f)
    {
        std::vector<size_t> parts;
        int covered = 0;
        for (size_t t = 1; !doneFound[f] && sizeFound[f] > 0 && t < kLabels; ++t)
        {
            if (counts(t) && !doneTrue[t] && common[t][f] >= tolerance * sizeTrue[t])
            {
                parts.push_back(t);
                covered += common[t][f];
            }
        }
        if (parts.size() > 1 && covered >= tolerance * sizeFound[f])
        {
            ++out.under;
            doneFound[f] = true;
            std::for_each(parts.begin(), parts.end(), [&](size_t t) { doneTrue[t] = true; });
        }
    }
    for (size_t i = 1; i < kLabels; ++i)
    {
        out.numTrue += counts(i) ? 1 : 0;
        out.missed += counts(i) && !doneTrue[i] ? 1 : 0;
        out.numFound += sizeFound[i] > 0 ? 1 : 0;
        out.spurious += sizeFound[i] > 0 && !doneFound[i] ? 1 : 0;
    }
    return out;
}
}  // namespace pointplane::test
