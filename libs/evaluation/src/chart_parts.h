// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "ChartLayout.h"

namespace pointplane
{
/** Colours of the scale of a series' levels. */
constexpr std::size_t kLevels = 32;

/** @name Parts of a chart as SVG elements
 * @{ */
[[nodiscard]] std::string axesOf(const ChartLayout& plot);
/** \param index in the chart's series */
[[nodiscard]] std::string seriesOf(const ChartLayout& plot, std::size_t index);
[[nodiscard]] std::string legendOf(const ChartLayout& plot);
/** The scale of the levels; empty where no series has any. */
[[nodiscard]] std::string colourBarOf(const ChartLayout& plot);
/** @} */
}  // namespace pointplane
