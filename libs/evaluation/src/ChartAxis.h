// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace pointplane
{
/** Smallest and largest of what it was shown; empty until then. */
struct ChartRange
{
    double min{0}, max{0};
    bool empty{true};
    void add(double value);
};

struct ChartTick
{
    double value;
    std::string label;  //!< empty: a short line only
};

/** Maps the values of one axis to pixels. It ends with the data; the ticks lie inside. */
class ChartAxis
{
 public:
    /** \param range of the data; a range without length is widened
     * \param pixelsAtMin, pixelsAtMax where the axis ends */
    ChartAxis(ChartRange range, bool logarithmic, double pixelsAtMin, double pixelsAtMax);

    [[nodiscard]] double pixelsOf(double value) const;
    [[nodiscard]] double min() const { return min_; }
    [[nodiscard]] double max() const { return max_; }
    [[nodiscard]] bool logarithmic() const { return logarithmic_; }
    /** At round values (1, 2 or 5 times a power of ten, zero among them if it is in the range), not
     * closer than `spacing` pixels unless two labels need it. */
    [[nodiscard]] std::vector<ChartTick> ticks(double spacing) const;

 private:
    [[nodiscard]] double position(double value) const;
    /** \param spacing as a fraction of the axis */
    [[nodiscard]] std::vector<ChartTick> decadeTicks(double spacing) const;

    double min_, max_;
    bool logarithmic_;
    double pixelsAtMin_, pixelsAtMax_;
};
}  // namespace pointplane
