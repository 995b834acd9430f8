// SPDX-License-Identifier: BSD-3-Clause
#include "chart_colours.h"

#include <pointplane/evaluation/svg_chart.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "short_number.h"

namespace pointplane
{
namespace
{
constexpr double kFontSize = 12;  // [px] of everything that is written

/** Colours of Okabe and Ito, which people with colour-blindness can tell apart; those for a dark
 * background are lighter. */
struct Theme
{
    const char *ink, *muted, *grid, *accent, *alarm;
    std::array<const char*, 8> palette;
};
constexpr Theme kLight{
    "#1c2430",
    "#6b7480",
    "#e1e6eb",
    "#b36b00",
    "#c2255c",
    {"#0072b2", "#d55e00", "#009e73", "#a14f86", "#8a6d00", "#3a9bd9", "#6f4fb3", "#495057"}};
constexpr Theme kDark{
    "#e8ecf0",
    "#9aa5b1",
    "#333d47",
    "#f0a83c",
    "#ff7a9c",
    {"#4db2f0", "#ff8a3d", "#3fcf9f", "#e08fc4", "#e0c050", "#9ad4f7", "#b79cf0", "#ced4da"}};
}  // namespace

std::string colourClass(const std::string& name, std::size_t index)
{
    return name.empty() ? "c" + std::to_string(index % kLight.palette.size()) : name;
}

std::string levelColour(double level)
{
    static constexpr double kStops[3][3] = {{38, 118, 202}, {230, 172, 40}, {208, 28, 46}};
    const double at = 2 * std::clamp(level, 0.0, 1.0);
    const auto k = static_cast<std::size_t>(std::min(1.0, std::floor(at)));
    char text[16];
    const auto mixed = [&](std::size_t channel)
    {
        const double f = at - static_cast<double>(k);
        return static_cast<unsigned>(
            std::lround((1 - f) * kStops[k][channel] + f * kStops[k + 1][channel]));
    };
    std::snprintf(text, sizeof text, "#%02x%02x%02x", mixed(0), mixed(1), mixed(2));
    return text;
}

std::string chartStyle(bool dark)
{
    const Theme& theme = dark ? kDark : kLight;
    std::string out;
    const auto rule = [&](const std::string& selector, const std::string& declarations)
    { out += ".plot " + selector + "{" + declarations + "}\n"; };
    const auto colour = [&](const std::string& name, const std::string& value)
    {
        rule(".line." + name, "stroke:" + value);
        rule(
            ".dot." + name + ",.plot .mark." + name + ",.plot .band." + name + ",.plot .bar." +
                name,
            "fill:" + value);
    };
    rule(
        "text",
        "font:" + shortNumber(kFontSize) +
            "px system-ui,\"DejaVu Sans\",sans-serif;fill:" + theme.ink);
    rule(".grid", std::string("stroke:") + theme.grid + ";stroke-width:1");
    rule(".zero", std::string("stroke:") + theme.muted + ";stroke-width:1");
    rule(".axis", std::string("stroke:") + theme.muted + ";stroke-width:1");
    rule(".line", "fill:none;stroke-width:1.6;stroke-linejoin:round");
    rule(".dashed", "stroke-dasharray:6 4");
    rule(".alone", "stroke-width:4;stroke-linecap:round");
    rule(".level", "fill:none;stroke-width:4.5;stroke-linecap:round;stroke-linejoin:round");
    rule(".band", "fill-opacity:.25");
    rule(".mark", std::string("stroke:") + theme.ink + ";stroke-width:1.5");
    colour("ink", theme.ink);
    colour("muted", theme.muted);
    colour("accent", theme.accent);
    colour("alarm", theme.alarm);
    for (std::size_t k = 0; k < theme.palette.size(); ++k)
    {
        colour("c" + std::to_string(k), theme.palette[k]);
    }
    return out;
}
}  // namespace pointplane
