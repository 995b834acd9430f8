// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/simulation/Texture.h>

#include <opencv2/imgproc.hpp>

namespace pointplane
{
Texture::Texture(const cv::Mat& bgr, double texel) : texel_(texel)
{
    POINTPLANE_CHECK(
        bgr.type() == CV_8UC3 && bgr.cols >= 4 && bgr.rows >= 4,
        "a texture needs a CV_8UC3 picture of at least 4 x 4, got " << bgr.cols << " x "
                                                                    << bgr.rows);
    cv::Mat picture = bgr;
    float scale = 256;
    while (true)
    {
        Level level;
        level.width = picture.cols;
        level.height = picture.rows;
        level.scale = scale;
        level.texels.reserve(picture.total());
        for (int y = 0; y < picture.rows; ++y)
        {
            const auto* row = picture.ptr<cv::Vec3b>(y);
            for (int x = 0; x < picture.cols; ++x)
            {
                level.texels.push_back(
                    std::uint64_t{row[x][0]} | std::uint64_t{row[x][1]} << 16 |
                    std::uint64_t{row[x][2]} << 32);
            }
        }
        levels_.push_back(std::move(level));
        // An odd last row or column is left out, so that texels of all levels stay aligned.
        const cv::Size half(picture.cols / 2, picture.rows / 2);
        if (half.width < 4 || half.height < 4)
        {
            break;
        }
        cv::Mat next;
        cv::resize(
            picture(cv::Rect(0, 0, 2 * half.width, 2 * half.height)),
            next,
            half,
            0,
            0,
            cv::INTER_AREA);
        picture = next;
        scale /= 2;
    }
    // sample() reads the level below the integral part as well.
    maxLod_ = static_cast<float>(levels_.size() - 1);
}
}  // namespace pointplane
