// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/evaluation/Chart.h>

#include <string>

namespace pointplane
{
/** A chart as an SVG element; colours come from chartStyle(). Long series are thinned out to some
 * thousand points; extremes and gaps stay. */
[[nodiscard]] std::string svgOf(const Chart& chart);

/** The same as a file of its own, in colours for paper. */
[[nodiscard]] std::string svgFileOf(const Chart& chart);

/** Style sheet of the charts' classes, for a light or a dark background. */
[[nodiscard]] std::string chartStyle(bool dark);

/** `text` with &, <, > and " as XML and HTML spell them, and U+FFFD for each byte that is not UTF-8
 * or that XML does not allow. */
[[nodiscard]] std::string xmlEscaped(const std::string& text);
}  // namespace pointplane
