// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/rawlog_names.h>
#include <pointplane/mrpt_io/recording_marks.h>

#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "GzInput.h"
#include "ObjectScanner.h"
#include "ReplayStream.h"
#include "other_file_type.h"

namespace pointplane
{
namespace
{
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
            scan->cameraParams.nrows = resolutions[i].rows;
            scan->cameraParams.ncols = resolutions[i].cols;
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
    Impl(const std::string& thePath, RawlogClasses theClasses)
        : path(thePath), classes(theClasses), in(thePath), scanner(in)
    {
    }

    void readAhead();
    void readMark();
    void scanOrAskMrpt();
    void askMrpt(const std::string& what);
    [[nodiscard]] Checksums sum();
    void endHere(const std::string& problem);
    void endHere(RawlogEnd kind, const std::string& problem);

    std::string path;
    RawlogClasses classes;
    std::string externals;
    std::optional<Checksums> knownSum;
    std::vector<std::uint8_t> member;  // of the object ahead
    GzInput in;
    ObjectScanner scanner;
    std::vector<std::uint8_t> bytes, room;
    mrpt::serialization::CSerializable::Ptr ahead;
    bool isRecording{false};  // between the marks of one
    std::size_t numRead{0};
    std::size_t numDelivered{0};
    RawlogEnding ending;      // of the file, as far as it has been read
    RawlogEnding endingSeen;  // by the caller
};

Checksums RawlogReader::Impl::sum()
{
    if (!knownSum)
    {
        knownSum = checksumsOf(path);
    }
    return *knownSum;
}

void RawlogReader::Impl::endHere(RawlogEnd kind, const std::string& problem)
{
    static constexpr const char* kWords[] = {"", "", "truncated", "damaged", "not supported"};
    static_assert(static_cast<std::size_t>(RawlogEnd::NotSupported) + 1 == std::size(kWords));
    ahead.reset();
    ending.kind = kind;
    ending.objectIndex = numRead;
    ending.byteOffset = in.fileOffset();
    if (kind != RawlogEnd::Clean)
    {
        ending.message = path + ": " + kWords[static_cast<std::size_t>(kind)] + " at byte " +
                         std::to_string(ending.byteOffset) + ", object " + std::to_string(numRead) +
                         ": " + problem;
    }
}

void RawlogReader::Impl::endHere(const std::string& problem)
{
    // A plain file that stops inside an object ends "clean" as a file, but not as a rawlog.
    const bool truncated = in.end() == GzInput::End::Truncated || in.end() == GzInput::End::Clean;
    endHere(
        truncated ? RawlogEnd::Truncated : RawlogEnd::Damaged,
        in.problem().empty() ? problem : in.problem());
}

void RawlogReader::Impl::askMrpt(const std::string& what)
{
    if (classes == RawlogClasses::Known)
    {
        endHere(RawlogEnd::NotSupported, what + ", whose layout is not known");
        return;
    }
    if (sum() == Checksums::Wrong)
    {
        endHere(RawlogEnd::Damaged, "the checksum is wrong, so this is not read: " + what);
        return;
    }
    scanner.restore(bytes);
    try
    {
        ahead = deserialise(bytes, &in);
    }
    catch (const std::exception& e)
    {
        // MRPT reads on behind the end of a whole file, too, where it takes a class for another
        // version.
        const bool isWhole = sum() == Checksums::Right;
        if (!isWhole && (!in.problem().empty() || in.end() != GzInput::End::Open))
        {
            endHere(oneLine(e));
            return;
        }
        endHere(
            RawlogEnd::NotSupported,
            what + (isWhole ? "" : " (or damage: the file has no checksum)"));
    }
}

void RawlogReader::Impl::scanOrAskMrpt()
{
    try
    {
        if (!scanner.scan(bytes))
        {
            endHere(
                isRecording ? RawlogEnd::Truncated : RawlogEnd::Clean,
                "the end mark of the recording is missing: its program still records or was "
                "killed, or the file was cut between two frames");
            return;
        }
        member = in.endMember();
        if (in.end() == GzInput::End::Damaged)  // by the member's checksum
        {
            endHere("");
            return;
        }
        requireRoom(bytes.size(), room);
        ahead = deserialise(bytes, nullptr);
    }
    catch (const ObjectScanner::Unknown& e)
    {
        askMrpt(e.what());
        member = in.endMember();
    }
}

void RawlogReader::Impl::readMark()
{
    if (const auto* comment = dynamic_cast<const mrpt::obs::CObservationComment*>(ahead.get()))
    {
        isRecording =
            comment->text == kRecordingBegins || (isRecording && comment->text != kRecordingEnds);
    }
}

void RawlogReader::Impl::readAhead()
{
    ahead.reset();
    if (ending.kind != RawlogEnd::Open)
    {
        return;
    }
    in.beginMember();
    try
    {
        scanOrAskMrpt();
    }
    catch (const std::exception& e)
    {
        if (isOutOfMemory(e))
        {
            throw;  // says nothing about the file
        }
        endHere(oneLine(e));
    }
    if (ahead)
    {
        restoreResolutions(*ahead, scanner.cameraResolutions());
        readMark();
        ++numRead;
    }
    else if (ending.kind == RawlogEnd::Open)
    {
        endHere("a null object");
    }
}

RawlogReader::RawlogReader(const std::string& path, RawlogClasses classes)
    : impl_(std::make_unique<Impl>(path, classes))
{
    impl_->externals = imagesFolderToRead(path);
    impl_->readAhead();
    if (!impl_->ahead)
    {
        const auto type = otherFileType(path);
        throw InputError(
            isCompressedTwice(path) ? path + ": is compressed twice; run gunzip on it once"
            : type                  ? path + ": is " + type->name + ", not a rawlog" +
                         (type->advice.empty() ? "" : "; " + type->advice)
            : impl_->ending.message.empty() ? path + ": contains no objects"
            : impl_->ending.kind == RawlogEnd::NotSupported
                ? impl_->ending.message
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

RawlogRecord RawlogReader::takeRecord()
{
    if (!impl_->member.empty())
    {
        return {{}, std::exchange(impl_->member, {})};
    }
    impl_->scanner.restore(impl_->bytes);
    return {std::exchange(impl_->bytes, {}), {}};
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
