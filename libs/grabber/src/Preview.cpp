// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/ObservationBuilder.h>
#include <pointplane/grabber/Preview.h>
#include <pointplane/mrpt_io/OutputFile.h>
#include <pointplane/mrpt_io/errors.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <chrono>
#include <filesystem>

#include "lowPriority.h"

namespace pointplane
{
namespace
{
void writePicture(const std::string& path, const cv::Mat& picture)
{
    std::vector<std::uint8_t> png;
    cv::imencode(".png", picture, png, {cv::IMWRITE_PNG_COMPRESSION, 1});
    OutputFile file(path);
    file.write(png.data(), png.size());
    file.commit();
}

/** Colour, and depth in false colours (red near, blue far, black none), side by side; CV_8UC3. */
cv::Mat previewPicture(const ImagePair& pair)
{
    constexpr double kMaxDepth = 6;  // [m] shown as the deepest blue
    const cv::Mat& depth = pair.depth.pixels;
    cv::Mat nearness, colours;
    // 255 at the camera, 0 at kMaxDepth: JET's red and blue.
    depth.convertTo(nearness, CV_8U, -255.0 * pair.depth.depthUnit / kMaxDepth, 255.0);
    cv::applyColorMap(nearness, colours, cv::COLORMAP_JET);
    colours.setTo(cv::Scalar::all(0), depth == 0);
    if (pair.colour.pixels.empty())
    {
        return colours;
    }
    cv::Mat bgr = toBgr(pair.colour);
    if (bgr.channels() == 1)
    {
        cv::cvtColor(bgr, bgr, cv::COLOR_GRAY2BGR);
    }
    cv::Mat picture;
    if (bgr.rows != colours.rows)
    {
        cv::resize(colours, colours, bgr.size(), 0, 0, cv::INTER_NEAREST);
    }
    cv::hconcat(bgr, colours, picture);
    return picture;
}
}  // namespace

Preview::Preview(std::string path) : path_(std::move(path))
{
    if (std::filesystem::path(path_).extension() != ".png")
    {
        throw InputError("preview '" + path_ + "' must end in .png");
    }
    writePicture(path_, cv::Mat::zeros(480, 1280, CV_8UC3));
    thread_ = std::thread([this] { work(); });
}

Preview::~Preview() { (void)finish(); }

std::string Preview::finish()
{
    stop_ = true;
    latest_.close();
    if (thread_.joinable())
    {
        thread_.join();
    }
    return problem_;
}

void Preview::work()
{
    lowerThreadPriority();
    while (auto pair = latest_.take())
    {
        try
        {
            writePicture(path_, previewPicture(*pair));
        }
        catch (const std::exception& e)
        {
            problem_ = oneLine(e);  // a picture less must not end a recording
        }
        for (int i = 0; i < 10 && !stop_; ++i)
        {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
    }
}
}  // namespace pointplane
