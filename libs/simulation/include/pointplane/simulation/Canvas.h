// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/simulation/Random.h>

#include <opencv2/core/mat.hpp>

#include <string>

namespace pointplane
{
/** A picture that is painted in metres; becomes the texture of a surface. Origin at the surface's
 * (s, t) = (0, 0); colours are blue, green, red in 0 .. 255. */
class Canvas
{
 public:
    /** \param width, height [m] \param texel wanted side of a texel [m] */
    Canvas(double width, double height, double texel, const cv::Scalar& colour);

    [[nodiscard]] const cv::Mat& picture() const { return picture_; }
    [[nodiscard]] double texel() const { return texel_; }
    [[nodiscard]] double width() const { return width_; }
    [[nodiscard]] double height() const { return height_; }

    /** Adds smooth noise of the given wavelength [m] and amplitude (standard deviation); each
     * further octave has half of both. Octaves finer than two texels are left out. */
    void addNoise(double wavelength, double amplitude, int octaves, Random& random);

    void fillRectangle(double x, double y, double w, double h, const cv::Scalar& colour);
    void fillCircle(double x, double y, double radius, const cv::Scalar& colour);
    void line(double x0, double y0, double x1, double y1, double thick, const cv::Scalar& colour);

    /** Lines of made-up words that fill the rectangle. \param size of a line [m] */
    void writing(double x, double y, double w, double h, double size, Random& random);

    /** A printed sheet: title, picture of random shapes, writing. */
    void poster(double x, double y, double w, double h, Random& random);

    /** Random shapes in random colours that fill the rectangle. */
    void shapes(double x, double y, double w, double h, int count, Random& random);

    /** Boards of the given width along s, each of its own shade. */
    void boards(double boardWidth, double boardLength, double contrast, Random& random);

    /** What a lens would do: removes what a texel grid cannot carry. */
    void soften();

    /** The texel rows are turned over, for surfaces whose t points up. */
    void turnOver();

 private:
    [[nodiscard]] cv::Point fixedPoint(double x, double y) const;

    cv::Mat picture_;
    double texel_, width_, height_;
};

[[nodiscard]] cv::Scalar randomColour(Random& random, double low = 20, double high = 235);
}  // namespace pointplane
