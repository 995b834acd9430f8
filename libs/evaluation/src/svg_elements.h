// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace pointplane::svg
{
/** To a tenth of a pixel. */
[[nodiscard]] std::string number(double value);

/** As an attribute of paths lists it. */
[[nodiscard]] std::string point(double x, double y);

/** \param style class of chartStyle() */
[[nodiscard]] std::string line(const char* style, double x1, double y1, double x2, double y2);

/** Text. \param anchor start, middle or end \param more attributes */
[[nodiscard]] std::string label(
    const std::string& text, double x, double y, const char* anchor, const std::string& more = "");

/** Text upwards, around its middle. */
[[nodiscard]] std::string turned(const std::string& text, double x, double y);
}  // namespace pointplane::svg
