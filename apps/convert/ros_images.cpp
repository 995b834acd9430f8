// SPDX-License-Identifier: BSD-3-Clause
#include "ros_images.h"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>

#include "Recording.h"
#include "frame_images.h"

namespace pointplane
{
namespace
{
constexpr std::uint32_t kMaxPixels = 1U << 26;

struct Encoding
{
    const char* name;
    int type;
    int toBgr;  //!< cv::COLOR_..., or -1
};
constexpr Encoding kEncodings[] = {
    {"bgr8", CV_8UC3, -1},
    {"8UC3", CV_8UC3, -1},
    {"rgb8", CV_8UC3, cv::COLOR_RGB2BGR},
    {"bgra8", CV_8UC4, cv::COLOR_BGRA2BGR},
    {"rgba8", CV_8UC4, cv::COLOR_RGBA2BGR},
    {"mono8", CV_8UC1, -1},
    {"8UC1", CV_8UC1, -1},
    {"16UC1", CV_16UC1, -1},
    {"mono16", CV_16UC1, -1},
    {"32FC1", CV_32FC1, -1}};

/** What compressed_depth_image_transport puts before the PNG. */
struct CompressedDepthHeader
{
    std::int32_t format;
    float a, b;  //!< 32FC1: Z = a / (value - b)
};

[[nodiscard]] cv::Mat decoded(const std::uint8_t* data, std::size_t size, int flags)
{
    return decodedFrameImage({data, data + size}, flags, "compressed image");
}

[[nodiscard]] cv::Mat depthFromInverse(const cv::Mat& values, const CompressedDepthHeader& header)
{
    cv::Mat out(values.size(), CV_32FC1);
    for (int v = 0; v < values.rows; ++v)
    {
        const auto* from = values.ptr<std::uint16_t>(v);
        auto* to = out.ptr<float>(v);
        for (int u = 0; u < values.cols; ++u)
        {
            const float value = static_cast<float>(from[u]);
            to[u] = from[u] > 0 && value > header.b ? header.a / (value - header.b)
                                                    : std::numeric_limits<float>::quiet_NaN();
        }
    }
    return out;
}
}  // namespace

bool isDepth(const sensor_msgs::Image& image)
{
    return image.encoding == "16UC1" || image.encoding == "mono16" || image.encoding == "32FC1";
}

bool isDepth(const sensor_msgs::CompressedImage& image)
{
    return image.format.find("compressedDepth") != std::string::npos;
}

cv::Mat toMat(const sensor_msgs::Image& image)
{
    const auto* encoding = std::find_if(
        std::begin(kEncodings),
        std::end(kEncodings),
        [&](const Encoding& e) { return image.encoding == e.name; });
    if (encoding == std::end(kEncodings))
    {
        throw BadFrame("encoding '" + image.encoding + "' is not supported");
    }
    const std::size_t rowBytes =
        static_cast<std::size_t>(image.width) * CV_ELEM_SIZE(encoding->type);
    if (image.width == 0 || image.height == 0 || image.width > kMaxPixels / image.height ||
        image.step < rowBytes ||
        image.data.size() < static_cast<std::size_t>(image.step) * image.height)
    {
        throw BadFrame(
            "image of " + std::to_string(image.width) + "x" + std::to_string(image.height) +
            " does not fit its " + std::to_string(image.data.size()) + " bytes");
    }
    if (image.is_bigendian != 0 && CV_ELEM_SIZE1(encoding->type) > 1)
    {
        throw BadFrame("big-endian images are not supported");
    }
    cv::Mat out(static_cast<int>(image.height), static_cast<int>(image.width), encoding->type);
    for (int v = 0; v < out.rows; ++v)
    {
        std::memcpy(
            out.ptr(v), image.data.data() + static_cast<std::size_t>(v) * image.step, rowBytes);
    }
    if (encoding->toBgr >= 0)
    {
        cv::cvtColor(out, out, encoding->toBgr);
    }
    return out;
}

cv::Mat toMat(const sensor_msgs::CompressedImage& image)
{
    if (!isDepth(image))
    {
        cv::Mat out = decoded(image.data.data(), image.data.size(), cv::IMREAD_UNCHANGED);
        if (out.channels() == 4)
        {
            cv::cvtColor(out, out, cv::COLOR_BGRA2BGR);
        }
        return out;
    }
    if (image.format.find("rvl") != std::string::npos)
    {
        throw BadFrame(
            "depth compressed as RVL is not supported; image_transport's republish makes raw "
            "images of it");
    }
    CompressedDepthHeader header{};
    if (image.data.size() <= sizeof(header))
    {
        throw BadFrame("compressed depth is damaged");
    }
    std::memcpy(&header, image.data.data(), sizeof(header));
    const cv::Mat values = decoded(
        image.data.data() + sizeof(header),
        image.data.size() - sizeof(header),
        cv::IMREAD_UNCHANGED);
    if (values.type() != CV_16UC1)
    {
        throw BadFrame("compressed depth is not a 16 bit PNG");
    }
    return image.format.compare(0, 5, "32FC1") == 0 ? depthFromInverse(values, header) : values;
}

bool hasInverseDistortion(const sensor_msgs::CameraInfo& info)
{
    return info.distortion_model == "Inverse Brown Conrady" &&
           std::any_of(info.D.begin(), info.D.end(), [](double d) { return d != 0; });
}

PinholeCamera toCamera(const sensor_msgs::CameraInfo& info, bool isRectified)
{
    PinholeCamera out;
    out.width = static_cast<int>(info.width);
    out.height = static_cast<int>(info.height);
    const bool byP = isRectified && info.P[0] > 0;
    out.fx = byP ? info.P[0] : info.K[0];
    out.cx = byP ? info.P[2] : info.K[2];
    out.fy = byP ? info.P[5] : info.K[4];
    out.cy = byP ? info.P[6] : info.K[5];
    const bool isDistorted =
        std::any_of(info.D.begin(), info.D.end(), [](double d) { return d != 0; });
    if (!isRectified && isDistorted)
    {
        const bool isHigher =
            info.D.size() > 5 &&
            std::any_of(info.D.begin() + 5, info.D.end(), [](double d) { return d != 0; });
        const bool isBrown = info.distortion_model.empty() ||
                             info.distortion_model == "plumb_bob" ||
                             info.distortion_model == "Brown Conrady" ||
                             info.distortion_model == "Inverse Brown Conrady" ||
                             info.distortion_model == "rational_polynomial";
        if (isHigher || !isBrown)
        {
            throw InputError(
                "distortion '" + info.distortion_model + "' with " + std::to_string(info.D.size()) +
                " parameters is not supported; give a calibration by --camera");
        }
        if (!hasInverseDistortion(info))
        {
            std::copy_n(
                info.D.begin(), std::min<std::size_t>(5, info.D.size()), out.distortion.begin());
        }
    }
    return out;
}
}  // namespace pointplane
