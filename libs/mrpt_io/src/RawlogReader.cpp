// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/errors.h>

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "GzInput.h"
#include "ObjectScanner.h"
#include "ReplayStream.h"

namespace pointplane
{
namespace
{
[[nodiscard]] mrpt::serialization::CSerializable::Ptr deserialise(std::vector<std::uint8_t>& bytes)
{
    ReplayStream stream(bytes, 0, nullptr);
    auto archive = mrpt::serialization::archiveFrom(static_cast<mrpt::io::CStream&>(stream));
    return archive.ReadObject();
}

/** MRPT's rule. Its own CRawlog::detectImagesDirectory() (2.5.8) drops the slash between folder and
 * name, and so finds nothing for a path with a folder in it. */
[[nodiscard]] std::string imagesDirectory(const std::string& rawlog)
{
    const std::string stem = std::filesystem::path(rawlog).replace_extension().string();
    for (const char* suffix : {"_Images", "_images", "_IMAGES"})
    {
        std::error_code error;
        if (std::filesystem::is_directory(stem + suffix, error))
        {
            return stem + suffix;
        }
    }
    return (std::filesystem::path(rawlog).parent_path() / "Images").string();
}

/** Puts the depth cameras' resolutions back, which the scanner had exchanged. */
void restoreResolutions(
    mrpt::serialization::CSerializable& object,
    const std::vector<ObjectScanner::Resolution>& resolutions)
{
    std::size_t i = 0;
    const auto restore = [&](mrpt::serialization::CSerializable& o)
    {
        if (auto* scan = dynamic_cast<mrpt::obs::CObservation3DRangeScan*>(&o);
            scan != nullptr && i < resolutions.size())
        {
            if (resolutions[i].isKnown)
            {
                scan->cameraParams.nrows = resolutions[i].rows;
                scan->cameraParams.ncols = resolutions[i].cols;
            }
            ++i;
        }
    };
    restore(object);
    if (auto* frame = dynamic_cast<mrpt::obs::CSensoryFrame*>(&object))
    {
        for (const auto& observation : *frame)
        {
            restore(*observation);
        }
    }
}
}  // namespace

struct RawlogReader::Impl
{
    Impl(const std::string& thePath, RawlogClasses classes)
        : path(thePath), in(thePath), scanner(in, classes == RawlogClasses::All)
    {
    }

    void readAhead();
    void endHere(const std::string& problem);

    std::string path;
    std::string externals;
    GzInput in;
    ObjectScanner scanner;
    std::vector<std::uint8_t> bytes;
    mrpt::serialization::CSerializable::Ptr ahead;
    std::size_t numRead{0};
    std::size_t numDelivered{0};
    RawlogEnding ending;      // of the file, as far as it has been read
    RawlogEnding endingSeen;  // by the caller
};

void RawlogReader::Impl::endHere(const std::string& problem)
{
    ending.objectIndex = numRead;
    ending.byteOffset = in.fileOffset();
    if (problem.empty())
    {
        ending.kind = RawlogEnd::Clean;
        return;
    }
    // A plain file that stops inside an object ends "clean" as a file, but not as a rawlog.
    const bool truncated = in.end() == GzInput::End::Truncated || in.end() == GzInput::End::Clean;
    ending.kind = truncated ? RawlogEnd::Truncated : RawlogEnd::Damaged;
    ending.message = path + ": " + (truncated ? "truncated" : "damaged") + " at byte " +
                     std::to_string(ending.byteOffset) + ", object " + std::to_string(numRead) +
                     ": " + problem;
}

void RawlogReader::Impl::readAhead()
{
    ahead.reset();
    if (ending.kind != RawlogEnd::Open)
    {
        return;
    }
    try
    {
        if (!scanner.scan(bytes))
        {
            endHere({});
            return;
        }
        ahead = deserialise(bytes);
        if (ahead)
        {
            restoreResolutions(*ahead, scanner.cameraResolutions());
            ++numRead;
            return;
        }
        endHere("a null object");
    }
    catch (const std::exception& e)
    {
        endHere(oneLine(e));
    }
}

RawlogReader::RawlogReader(const std::string& path, RawlogClasses classes)
    : impl_(std::make_unique<Impl>(path, classes))
{
    impl_->externals = imagesDirectory(path);
    impl_->readAhead();
    if (!impl_->ahead)
    {
        throw InputError(
            impl_->ending.message.empty() ? path + ": contains no objects"
                                          : impl_->ending.message + " (is it a rawlog?)");
    }
}

RawlogReader::~RawlogReader() = default;

mrpt::serialization::CSerializable::Ptr RawlogReader::next()
{
    if (!impl_->ahead)
    {
        impl_->readAhead();
    }
    auto out = std::move(impl_->ahead);
    impl_->ahead.reset();
    if (out)
    {
        ++impl_->numDelivered;
    }
    else
    {
        impl_->endingSeen = impl_->ending;
    }
    return out;
}

const RawlogEnding& RawlogReader::ending() const { return impl_->endingSeen; }
std::size_t RawlogReader::numObjects() const { return impl_->numDelivered; }
double RawlogReader::progress() const
{
    return std::min(
        1.0,
        static_cast<double>(impl_->in.fileOffset()) /
            static_cast<double>(std::max<std::uint64_t>(1, impl_->in.fileSize())));
}
const std::string& RawlogReader::path() const { return impl_->path; }
const std::string& RawlogReader::externalsDirectory() const { return impl_->externals; }
}  // namespace pointplane
