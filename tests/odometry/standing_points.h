// SPDX-License-Identifier: BSD-3-Clause
// Points that stand in the image, for the tests of ImageMarks.
#pragma once

#include <cmath>

#include "ImageMarks.h"

namespace pointplane::standing
{
inline constexpr double kDepth = 2;       // [m]
inline constexpr double kSigma_m = 0.01;  // of each depth
inline constexpr int kWindowPx = 10;

inline PinholeCamera camera()
{
    PinholeCamera out;
    out.width = 320;
    out.height = 240;
    out.fx = out.fy = 260;
    out.cx = 160;
    out.cy = 120;
    return out;
}

inline PointFeature pointAt(const Eigen::Vector2d& uv_px, double z)
{
    return {uv_px, backProject(camera(), 0.5, kSigma_m, uv_px, z)};
}

/** Points that a frame has in common with a reference. */
struct Seen
{
    Seen() { association.reference = &reference; }
    Seen(const Seen&) = delete;

    void add(const PointFeature& before, const PointFeature& now)
    {
        association.points.push_back({static_cast<int>(reference.points.points.size()), now});
        reference.points.points.push_back(before);
    }

    /** \return number of marks that they show */
    size_t marks()
    {
        ImageMarks(kWindowPx).split(association, camera());
        return association.fixedPoints.size();
    }

    Reference reference;
    Association association;
};

/** Points on a circle around the centre of the image. */
struct Circle
{
    int numPoints{40};
    int numChanged{20};  //!< of them, evenly spread; every second is nearer, the others are farther
    double change{0.2};  //!< of their depth [m]
    double shift_px{0};  //!< of all
    double radius_px{100};

    [[nodiscard]] Eigen::Vector2d place_px(int i) const
    {
        const double angle = 2 * M_PI * i / numPoints;
        return Eigen::Vector2d(160, 120) +
               radius_px * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    }

    void showTo(Seen& seen) const
    {
        double sign = 1;
        for (int i = 0; i < numPoints; ++i)
        {
            const bool changes = (i + 1) * numChanged / numPoints > i * numChanged / numPoints;
            sign = changes ? -sign : sign;
            seen.add(
                pointAt(place_px(i), kDepth),
                pointAt(
                    place_px(i) + Eigen::Vector2d(0, shift_px),
                    kDepth + (changes ? sign * change : 0)));
        }
    }

    [[nodiscard]] size_t marks() const
    {
        Seen seen;
        showTo(seen);
        return seen.marks();
    }
};

/** The frame shows what was seen, and what it shows is learnt. */
inline bool teach(ImageMarks& marks, Seen& seen)
{
    marks.split(seen.association, camera());
    return marks.learn({seen.association}, marksIn({seen.association}), camera());
}

inline bool teachMarks(ImageMarks& marks)
{
    Seen seen;
    Circle().showTo(seen);
    return teach(marks, seen);
}
}  // namespace pointplane::standing
