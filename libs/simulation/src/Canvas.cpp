// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/simulation/Canvas.h>

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace pointplane
{
namespace
{
constexpr int kShift = 4;  // fractional bits of OpenCV's drawing coordinates

std::string randomWord(Random& random)
{
    std::string word;
    const int length = 2 + random.below(7);
    for (int i = 0; i < length; ++i)
    {
        const int letter = random.below(26);
        word += static_cast<char>((random.below(6) == 0 ? 'A' : 'a') + letter);
    }
    return word;
}
}  // namespace

cv::Scalar randomColour(Random& random, double low, double high)
{
    const double b = random.uniform(low, high), g = random.uniform(low, high);
    return {b, g, random.uniform(low, high)};
}

Canvas::Canvas(double width, double height, double texel, const cv::Scalar& colour)
    : texel_(std::min({texel, width / 4, height / 4})), width_(width), height_(height)
{
    const int cols = static_cast<int>(std::ceil(width / texel_));
    const int rows = static_cast<int>(std::ceil(height / texel_));
    picture_ = cv::Mat(rows, cols, CV_8UC3, colour);
}

cv::Point Canvas::fixedPoint(double x, double y) const
{
    const double scale = (1 << kShift) / texel_;
    const double half = (1 << kShift) * 0.5;
    return {
        static_cast<int>(std::lround(x * scale - half)),
        static_cast<int>(std::lround(y * scale - half))};
}

void Canvas::addNoise(double wavelength, double amplitude, int octaves, Random& random)
{
    cv::Mat sum = cv::Mat::zeros(picture_.size(), CV_32FC1);
    for (int octave = 0; octave < octaves && wavelength > 2 * texel_; ++octave)
    {
        const double step = wavelength / texel_;
        cv::Mat grid(
            static_cast<int>(std::ceil(picture_.rows / step)) + 1,
            static_cast<int>(std::ceil(picture_.cols / step)) + 1,
            CV_32FC1);
        for (int i = 0; i < static_cast<int>(grid.total()); ++i)
        {
            grid.ptr<float>()[i] = static_cast<float>(amplitude) * random.gaussian();
        }
        cv::Mat fine;
        cv::resize(grid, fine, {}, step, step, cv::INTER_CUBIC);
        sum += fine(cv::Rect(cv::Point(0, 0), picture_.size()));
        wavelength /= 2;
        amplitude /= 2;
    }
    cv::Mat sum3, out;
    cv::merge(std::vector<cv::Mat>{sum, sum, sum}, sum3);
    cv::add(picture_, sum3, out, cv::noArray(), CV_8UC3);
    picture_ = out;
}

void Canvas::fillRectangle(double x, double y, double w, double h, const cv::Scalar& colour)
{
    cv::rectangle(
        picture_, fixedPoint(x, y), fixedPoint(x + w, y + h), colour, -1, cv::LINE_AA, kShift);
}

void Canvas::fillCircle(double x, double y, double radius, const cv::Scalar& colour)
{
    const int r = static_cast<int>(std::lround(radius / texel_ * (1 << kShift)));
    cv::circle(picture_, fixedPoint(x, y), r, colour, -1, cv::LINE_AA, kShift);
}

void Canvas::line(
    double x0, double y0, double x1, double y1, double thick, const cv::Scalar& colour)
{
    const int t = std::max(1, static_cast<int>(std::lround(thick / texel_)));
    cv::line(picture_, fixedPoint(x0, y0), fixedPoint(x1, y1), colour, t, cv::LINE_AA, kShift);
}

void Canvas::writing(double x, double y, double w, double h, double size, Random& random)
{
    const double scale = 0.6 * size / texel_ / 21.0;  // Hershey capitals are 21 px high
    const int thick = std::max(1, static_cast<int>(std::lround(2 * scale)));
    for (double top = y; top + size <= y + h; top += size)
    {
        double left = x;
        while (left < x + w - 3 * size)
        {
            const std::string word = randomWord(random);
            const double length = 0.5 * size * static_cast<double>(word.size());
            if (left + length > x + w)
            {
                break;
            }
            const cv::Point at = fixedPoint(left, top + 0.75 * size);
            cv::putText(
                picture_,
                word,
                {at.x >> kShift, at.y >> kShift},
                cv::FONT_HERSHEY_SIMPLEX,
                scale,
                cv::Scalar(40, 35, 35),
                thick,
                cv::LINE_AA);
            left += length + 0.4 * size;
        }
    }
}

void Canvas::shapes(double x, double y, double w, double h, int count, Random& random)
{
    const double side = std::min(w, h);
    for (int i = 0; i < count; ++i)
    {
        const double r = side * random.uniform(0.04, 0.22);
        const double px = random.uniform(x + r, x + w - r), py = random.uniform(y + r, y + h - r);
        const cv::Scalar colour = randomColour(random);
        switch (random.below(3))
        {
            case 0:
                fillCircle(px, py, r, colour);
                break;
            case 1:
                fillRectangle(px - r, py - r * random.uniform(0.3, 1), 2 * r, r, colour);
                break;
            default:
                line(px - r, py, px + r * random.uniform(-1, 1), py + r, 0.3 * r, colour);
        }
    }
}

void Canvas::poster(double x, double y, double w, double h, Random& random)
{
    fillRectangle(x, y, w, h, randomColour(random, 170, 245));
    const double margin = 0.07 * std::min(w, h);
    const double inner = w - 2 * margin;
    const double title = 0.12 * h;
    writing(x + margin, y + margin, inner, 1.05 * title, title, random);
    const double top = y + margin + 1.2 * title;
    const double split = 0.4 * h;
    fillRectangle(x + margin, top, inner, split, randomColour(random));
    shapes(x + margin, top, inner, split, 14, random);
    const double below = top + split + 0.5 * margin;
    writing(x + margin, below, inner, y + h - margin - below, 0.045 * h, random);
}

void Canvas::boards(double boardWidth, double boardLength, double contrast, Random& random)
{
    const cv::Scalar base = cv::mean(picture_);
    for (double x = 0; x < width_; x += boardWidth)
    {
        for (double y = -random.uniform(0, boardLength); y < height_; y += boardLength)
        {
            const double shade = 1 + contrast * random.uniform(-1, 1);
            fillRectangle(x, y, boardWidth, boardLength, base * shade);
            line(x, y, x + boardWidth, y, 0.002, base * 0.6);
        }
        line(x, 0, x, height_, 0.002, base * 0.6);
    }
}

void Canvas::soften()
{
    constexpr double kSigmaTexels = 0.7;
    cv::GaussianBlur(picture_, picture_, {}, kSigmaTexels, kSigmaTexels, cv::BORDER_REPLICATE);
}

void Canvas::turnOver() { cv::flip(picture_, picture_, 0); }
}  // namespace pointplane
