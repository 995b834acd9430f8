// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/sensor/RgbdFrame.h>

#include <opencv2/core/mat.hpp>

#include <cstdint>

namespace pointplane
{
/** A frame as a coarse grid of cells, to be compared with another one. */
struct CellView
{
    enum class Contrast : std::uint8_t
    {
        Noise,
        Pattern,    //!< but it may look the same along a line
        ShowsShift  //!< in all directions
    };
    static constexpr int kDepthSide = 2;  //!< [px] of a cell

    CellView() = default;
    /** Without the contrast. \param frame with colour and depth */
    explicit CellView(const RgbdFrame& frame);

    void findContrast();

    [[nodiscard]] Contrast contrastAt(const cv::Point& cell) const
    {
        return static_cast<Contrast>(contrast(cell));
    }

    /** How much a cell looks as in the other view: zero-mean normalised cross-correlation; 0 if one
     * of them has no contrast. */
    [[nodiscard]] double correlation(const CellView& other, const cv::Point& cell) const;

    cv::Mat_<std::uint8_t> gray;      //!< a square of pixels for each cell
    cv::Mat_<float> depth;            //!< likewise [m]
    cv::Mat_<std::uint8_t> contrast;  //!< what each cell's pattern can tell
};

/** Correlation of a pattern with one that took its place. */
constexpr double kOtherPattern = 0.5;
}  // namespace pointplane
