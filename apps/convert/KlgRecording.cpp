// SPDX-License-Identifier: BSD-3-Clause
#include "KlgRecording.h"

#include <pointplane/core/quantile.h>
#include <pointplane/mrpt_io/mrpt_poses.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iomanip>
#include <limits>
#include <sstream>

#include "frame_images.h"
#include <zlib.h>

namespace pointplane
{
namespace
{
/** Largest block of a frame: what is more is damage. */
constexpr std::int32_t kMaxBytes = 64 << 20;

/** ElasticFusion's own default. */
[[nodiscard]] Calibration nominalCamera()
{
    Calibration out;
    out.camera.fx = out.camera.fy = 528;
    out.camera.cx = 320;
    out.camera.cy = 240;
    out.unitsPerMetre = 1000;
    return out;
}
}  // namespace

KlgRecording::KlgRecording(const KlgOptions& options) : options_(options)
{
    isNominal_ = options.camera.empty();
    camera_ = isNominal_ ? nominalCamera() : loadCalibrationFile(options.camera);
    if (!isNominal_ && !camera_.tellsUnits)
    {
        camera_.unitsPerMetre = 1000;
    }
    if (options.depthScale > 0)
    {
        camera_.unitsPerMetre = options.depthScale;
    }
    std::error_code error;
    fileSize_ = std::filesystem::file_size(options.file, error);
    file_.open(options.file, std::ios::binary);
    if (error || !file_)
    {
        throw InputError(
            "cannot open " + options.file + ": " +
            (error ? error.message() : std::string(std::strerror(errno))));
    }
    if (!read(numFrames_) || numFrames_ < 0 || isAtEnd())
    {
        throw InputError(options.file + ": is not a klg log, or has no frames");
    }
    isUnclosed_ = numFrames_ == 0;
    if (isUnclosed_)
    {
        numFrames_ = std::numeric_limits<std::int32_t>::max();
    }
    checkUnitOfStamps();
}

/** By how far the first frames are apart. \throws InputError */
void KlgRecording::checkUnitOfStamps()
{
    constexpr std::size_t kFrames = 20;
    constexpr double kShortest = 1e-3, kLongest = 8;  // [s]
    std::vector<double> intervals;
    FrameHead before, head;
    for (bool isThere = read(before); isThere && intervals.size() < kFrames; before = head)
    {
        file_.seekg(std::int64_t{before.depthSize} + before.colourSize, std::ios::cur);
        isThere = read(head);
        if (isThere)
        {
            intervals.push_back(
                1e-6 * (static_cast<double>(head.microseconds) -
                        static_cast<double>(before.microseconds)));
        }
    }
    file_.clear();
    file_.seekg(sizeof(numFrames_));
    const double interval = intervals.empty() ? 0 : median(intervals);
    if (!intervals.empty() && interval == 0)
    {
        throw InputError(
            options_.file +
            ": its first frames have the same stamp; the program that recorded "
            "them must tell when they were taken");
    }
    if (interval > kLongest || (interval > 0 && interval < kShortest))
    {
        std::ostringstream out;
        out << options_.file << ": frames are " << std::setprecision(3) << interval
            << " s apart; are stamps in " << (interval > kLongest ? "nano" : "milli")
            << "seconds? They must be in microseconds";
        throw InputError(out.str());
    }
}

bool KlgRecording::read(FrameHead& head)
{
    return read(head.microseconds) && read(head.depthSize) && read(head.colourSize);
}

template <class T>
bool KlgRecording::read(T& value)
{
    file_.read(reinterpret_cast<char*>(&value), sizeof(value));
    return static_cast<bool>(file_);
}

bool KlgRecording::read(std::vector<unsigned char>& bytes, std::int32_t size)
{
    const auto at = static_cast<std::uint64_t>(file_.tellg());
    if (size < 0 || size > kMaxBytes || at + static_cast<std::uint64_t>(size) > fileSize_)
    {
        return false;
    }
    bytes.resize(static_cast<std::size_t>(size));
    file_.read(reinterpret_cast<char*>(bytes.data()), size);
    return static_cast<bool>(file_);
}

std::string KlgRecording::where() const
{
    return options_.file + ": frame " + std::to_string(next_ - 1);
}

bool KlgRecording::isAtEnd() { return static_cast<std::uint64_t>(file_.tellg()) == fileSize_; }

std::optional<RecordedFrame> KlgRecording::stopped()
{
    damage_ = options_.file + ": " + (next_ == 1 ? "is not a klg log, or " : "") +
              "truncated or damaged in frame " + std::to_string(next_ - 1) +
              (isUnclosed_ ? std::string() : " of " + std::to_string(numFrames_));
    return {};
}

std::optional<RecordedFrame> KlgRecording::ended()
{
    if (isUnclosed_)
    {
        damage_ = options_.file + ": tells no number of frames, as its recording was broken off";
    }
    else if (!isAtEnd())
    {
        damage_ = options_.file + ": goes on behind the " + std::to_string(numFrames_) +
                  " frames that it tells of";
    }
    return {};
}

cv::Mat KlgRecording::depthOf(const std::vector<unsigned char>& bytes) const
{
    cv::Mat out(camera_.camera.height, camera_.camera.width, CV_16UC1);
    const std::size_t size = out.total() * out.elemSize();
    if (bytes.size() == size)
    {
        std::memcpy(out.data, bytes.data(), size);
        return out;
    }
    uLongf length = size;
    const int code = uncompress(out.data, &length, bytes.data(), bytes.size());
    if (code != Z_OK || length != size)
    {
        throw BadFrame(
            where() + ": depth is damaged, or not " + std::to_string(out.cols) + "x" +
            std::to_string(out.rows) + " (give another size by --camera)");
    }
    return out;
}

cv::Mat KlgRecording::colourOf(const std::vector<unsigned char>& bytes) const
{
    const cv::Size size(camera_.camera.width, camera_.camera.height);
    cv::Mat out;
    if (bytes.size() == static_cast<std::size_t>(size.area()) * 3)
    {
        out = cv::Mat(size, CV_8UC3);
        std::memcpy(out.data, bytes.data(), bytes.size());
        if (!options_.bgr)
        {
            cv::cvtColor(out, out, cv::COLOR_RGB2BGR);
        }
        return out;
    }
    out = decodedFrameImage(bytes, cv::IMREAD_COLOR, where() + ": colour");
    if (out.size() != size)
    {
        throw BadFrame(
            where() + ": colour is " + sizeText(out.size()) + ", not " + sizeText(size) +
            " (give another size by --camera)");
    }
    if (!options_.bgr)
    {
        cv::cvtColor(out, out, cv::COLOR_RGB2BGR);  // Logger2 hands RGB to an encoder of BGR
    }
    return out;
}

std::optional<RecordedFrame> KlgRecording::next()
{
    if (!damage_.empty())
    {
        return {};
    }
    if (next_ == numFrames_ || (isUnclosed_ && isAtEnd()))
    {
        return ended();
    }
    ++next_;
    FrameHead head;
    std::vector<unsigned char> depth, colour;
    if (!read(head) || !read(depth, head.depthSize) || !read(colour, head.colourSize))
    {
        return stopped();
    }
    constexpr std::int64_t kLatest = 10'000'000'000'000'000;  // [us] of the year 2286
    if (head.microseconds > kLatest || head.microseconds < -kLatest)
    {
        throw BadFrame(
            where() + ": stamp " + std::to_string(head.microseconds) +
            " is not between 1970 and 2286; are stamps in nanoseconds? They must be in "
            "microseconds");
    }
    RecordedFrame out;
    out.isNominal = isNominal_;
    out.scan.stamp = fromSeconds(1e-6 * static_cast<double>(head.microseconds));
    out.scan.camera = camera_.camera;
    out.scan.unitsPerMetre = camera_.unitsPerMetre;
    out.scan.depth = depthOf(depth);
    if (!colour.empty())  // else depth is alone
    {
        out.scan.colour = colourOf(colour);
    }
    return out;
}

double KlgRecording::progress() const { return static_cast<double>(next_) / numFrames_; }

std::vector<std::string> KlgRecording::notes() const
{
    if (!isNominal_)
    {
        return {};
    }
    return {"camera: nominal (528 px, ElasticFusion's default); --camera takes a calibration"};
}
}  // namespace pointplane
