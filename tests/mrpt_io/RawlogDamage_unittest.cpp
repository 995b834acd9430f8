// SPDX-License-Identifier: BSD-3-Clause
// Rawlogs that are not as they were written: cut, with flipped bits, with wrong sizes.
#include <pointplane/mrpt_io/RawlogReader.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/external_range.h>

#include <mrpt/obs/CObservationRange.h>
#include <mrpt/serialization/CArchive.h>

#include <opencv2/core.hpp>

#include <random>

#include "TempDir.h"
#include "rawlog_samples.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

namespace pointplane
{
namespace
{
using test::decompressed;
using test::otherSensors;
using test::RawlogContents;
using test::readAll;
using test::readBytes;
using test::TempDir;
using test::writeBytes;

TEST(RawlogDamage, sizesThatTheFileCannotHoldAreDamage)
{
    const TempDir dir;
    test::writeObservations(dir / "a.rawlog", 2);
    const std::string bytes = decompressed(dir / "a.rawlog");
    // rangeUnits (1 mm), then rows and columns of the range image: 24 and 32, little endian.
    const std::string units("\x6f\x12\x83\x3a", 4);
    const std::string sizes("\x18\0\0\0\x20\0\0\0", 8);
    const std::size_t second = bytes.rfind(units + sizes);
    ASSERT_NE(second, std::string::npos);
    for (const std::string& wrong :
         {std::string("\xff\xff\xff\x7f\x20\0\0\0", 8),
          std::string("\0\x20\0\0\0\x20\0\0", 8),
          std::string("\x18\0\0\0\xff\xff\xff\xff", 8)})
    {
        std::string damaged = bytes;
        damaged.replace(second + units.size(), sizes.size(), wrong);
        writeBytes(dir / "b.rawlog", damaged);
        const RawlogContents contents = readAll(dir / "b.rawlog");
        EXPECT_EQ(contents.objects.size(), 1U);
        EXPECT_NE(contents.ending.kind, RawlogEnd::Clean);
        EXPECT_EQ(contents.ending.objectIndex, 1U);
    }
}

TEST(RawlogDamage, truncationAtAnObjectBoundaryOfGzIsSeen)
{
    const TempDir dir;
    RawlogWriterOptions options;
    options.flushEveryObjects = 1;
    test::writeObservations(dir / "a.rawlog", 5, options);
    const std::string bytes = readBytes(dir / "a.rawlog");
    // The trailer (8 bytes) gone: every object is there, yet the file is not complete.
    writeBytes(dir / "cut.rawlog", bytes.substr(0, bytes.size() - 8));
    const RawlogContents contents = readAll(dir / "cut.rawlog");
    EXPECT_EQ(contents.objects.size(), 5U);
    EXPECT_EQ(contents.ending.kind, RawlogEnd::Truncated);
    EXPECT_EQ(contents.ending.objectIndex, 5U);
    EXPECT_EQ(contents.ending.byteOffset, bytes.size() - 8);
    EXPECT_THAT(contents.ending.message, testing::HasSubstr("cut.rawlog: truncated at byte"));
}

TEST(RawlogDamage, sizesInOtherSensorsAreNotBelieved)
{
    const TempDir dir;
    for (const auto& object : otherSensors())
    {
        const std::string name = object->GetRuntimeClass()->className;
        std::vector<std::uint8_t> bytes;
        mrpt::serialization::ObjectToOctetVector(object.get(), bytes);
        // Every length of the format is somewhere among these.
        for (std::size_t at = name.size() + 2; at + 4 <= bytes.size() && at < 1000; ++at)
        {
            std::string damaged(bytes.begin(), bytes.end());
            damaged.replace(at, 4, std::string("\xff\xff\xff\x7f", 4));
            writeBytes(dir / "b.rawlog", damaged);
            rusage before{}, after{};
            getrusage(RUSAGE_SELF, &before);
            try
            {
                (void)readAll(dir / "b.rawlog");
            }
            catch (const InputError& error)
            {
                EXPECT_THAT(error.what(), testing::HasSubstr("b.rawlog"));
            }
            getrusage(RUSAGE_SELF, &after);
            EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 100'000) << name << " at byte " << at;
        }
    }
}

TEST(RawlogDamage, onRequestMrptIsNotAskedForClassesThatAreNotKnown)
{
    const TempDir dir;
    {
        RawlogWriter writer(dir / "a.rawlog");
        writer.write(*test::sampleScan(0));
        writer.write(mrpt::obs::CObservationRange());
        writer.close();
    }
    EXPECT_EQ(readAll(dir / "a.rawlog").objects.size(), 2U);
    RawlogReader reader(dir / "a.rawlog", RawlogClasses::Known);
    EXPECT_TRUE(reader.next());
    EXPECT_FALSE(reader.next());
    EXPECT_EQ(reader.ending().kind, RawlogEnd::NotSupported);
    EXPECT_THAT(reader.ending().message, testing::HasSubstr("class CObservationRange, version"));
}

/** Whose lengths MRPT would believe: a flipped bit anywhere in the file is enough. */
TEST(RawlogDamage, withAWrongChecksumMrptIsNotAskedForClassesThatAreNotKnown)
{
    const TempDir dir;
    {
        RawlogWriter writer(dir / "a.rawlog");
        writer.write(*test::sampleScan(0, 160, 120));
        writer.write(mrpt::obs::CObservationRange());
        writer.write(*test::sampleScan(1, 160, 120));
        writer.close();
    }
    std::string bytes = readBytes(dir / "a.rawlog");
    bytes[bytes.size() - 1000] = static_cast<char>(bytes[bytes.size() - 1000] ^ 4);
    writeBytes(dir / "b.rawlog", bytes);
    const RawlogContents contents = readAll(dir / "b.rawlog");
    EXPECT_EQ(contents.objects.size(), 1U);
    EXPECT_EQ(contents.ending.kind, RawlogEnd::Damaged);
    EXPECT_THAT(contents.ending.message, testing::HasSubstr("class CObservationRange, version"));
}

/** A count of four billion observations must not become an allocation, whatever the version. */
TEST(RawlogDamage, countsOfObservationsAreNotBelieved)
{
    const TempDir dir;
    for (int version = 0; version < 5; ++version)
    {
        std::string bytes =
            "\x8d"
            "CSensoryFrame";
        bytes += static_cast<char>(version);
        bytes += std::string(1500, '\xff');
        writeBytes(dir / "a.rawlog", bytes);
        rusage before{}, after{};
        getrusage(RUSAGE_SELF, &before);
        EXPECT_THROW(RawlogReader(dir / "a.rawlog"), InputError) << version;
        getrusage(RUSAGE_SELF, &after);
        EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 100'000) << version;
    }
}

/** Also between two objects, where nothing is missing but what follows. */
TEST(RawlogDamage, noCutOfAWrittenFileLooksComplete)
{
    const TempDir dir;
    RawlogWriterOptions options;
    options.flushEveryObjects = 1;
    {
        RawlogWriter writer(dir / "a.rawlog", options);
        for (int i = 0; i < 4; ++i)
        {
            mrpt::obs::CObservationComment comment;
            comment.text = std::to_string(i);
            writer.write(comment);
        }
        writer.close();
    }
    const std::string bytes = readBytes(dir / "a.rawlog");
    for (std::size_t cut = 0; cut < bytes.size(); ++cut)
    {
        writeBytes(dir / "cut.rawlog", bytes.substr(0, cut));
        try
        {
            EXPECT_EQ(readAll(dir / "cut.rawlog").ending.kind, RawlogEnd::Truncated) << cut;
        }
        catch (const InputError& error)  // before the first object's end
        {
            EXPECT_LT(cut, bytes.size() / 3);
        }
    }
}

/** A scan whose colour is JPEG, as MRPT serialises it. */
std::string jpegScan()
{
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(false);
    std::vector<std::uint8_t> bytes;
    mrpt::serialization::ObjectToOctetVector(test::sampleScan(0).get(), bytes);
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(true);
    return {bytes.begin(), bytes.end()};
}

TEST(RawlogDamage, jpegImagesAreThoseThatMrptReads)
{
    const TempDir dir;
    const std::string bytes = jpegScan();
    writeBytes(dir / "a.rawlog", bytes);
    const RawlogContents contents = readAll(dir / "a.rawlog");
    ASSERT_EQ(contents.objects.size(), 1U);
    mrpt::serialization::CSerializable::Ptr expected;
    mrpt::serialization::OctetVectorToObject({bytes.begin(), bytes.end()}, expected);
    const auto imageOf = [](const mrpt::serialization::CSerializable::Ptr& object)
    {
        return std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(object)
            ->intensityImage.asCvMatRef()
            .clone();
    };
    EXPECT_EQ(cv::norm(imageOf(contents.objects[0]), imageOf(expected), cv::NORM_INF), 0);
}

/** libjpeg's own answer to a damaged image, which MRPT leaves it to, is to end the process. */
TEST(RawlogDamage, noDamagedJpegEndsTheProcess)
{
    const TempDir dir;
    const std::string bytes = jpegScan();
    const std::size_t begin = bytes.find("\xff\xd8\xff");
    ASSERT_NE(begin, std::string::npos);
    int reported = 0;
    for (std::size_t at = begin; at < begin + 700 && at < bytes.size(); ++at)
    {
        std::string damaged = bytes;
        damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
        writeBytes(dir / "b.rawlog", damaged);
        try
        {
            (void)readAll(dir / "b.rawlog");
        }
        catch (const InputError& error)
        {
            EXPECT_THAT(error.what(), testing::HasSubstr("b.rawlog"));
            ++reported;
        }
    }
    EXPECT_GT(reported, 20);
}

/** What a rawlog is made of. */
enum class Kind
{
    Format1,
    Format2,
    ExternalImages
};

/** Scans whose pixels are in files beside: in the rawlog are their names. */
void writeExternalObservations(const std::string& path, int n)
{
    RawlogWriter writer(path);
    for (int i = 0; i < n; ++i)
    {
        const auto scan = test::sampleScan(i);
        const std::string name = std::filesystem::path(path).stem().string() + std::to_string(i);
        const std::string folder = std::filesystem::path(path).parent_path().string();
        ASSERT_TRUE(scan->intensityImage.saveToFile(folder + "/" + name + ".png"));
        scan->intensityImage.setExternalStorage(name + ".png");
        moveRangeToFile(*scan, folder, name + ".bin");
        writer.write(*scan);
    }
    writer.close();
}

class RawlogDamageOf : public testing::TestWithParam<Kind>
{
 protected:
    static constexpr int kFrames = 4;

    void SetUp() override
    {
        const std::string path = dir_ / "gz.rawlog";
        switch (GetParam())
        {
            case Kind::Format1:
                test::writeActionsAndFrames(path, kFrames);
                break;
            case Kind::Format2:
                test::writeObservations(path, kFrames);
                break;
            case Kind::ExternalImages:
                writeExternalObservations(path, kFrames);
                break;
        }
        gz_ = readBytes(path);
        plain_ = decompressed(path);
        numObjects_ = GetParam() == Kind::Format1 ? 2 * kFrames : kFrames;
    }

    /** Number of objects read from damaged bytes, 0 if the file was refused. */
    std::size_t objectsIn(const std::string& bytes, RawlogEnding* ending)
    {
        writeBytes(dir_ / "damaged.rawlog", bytes);
        try
        {
            const RawlogContents contents = readAll(dir_ / "damaged.rawlog");
            *ending = contents.ending;
            return contents.objects.size();
        }
        catch (const InputError& e)
        {
            ending->kind = RawlogEnd::Damaged;
            ending->message = e.what();
            return 0;
        }
    }

    TempDir dir_;
    std::string gz_, plain_;
    std::size_t numObjects_{0};
    std::mt19937 rng_{20171};
};

TEST_P(RawlogDamageOf, everyCutIsReported)
{
    for (int i = 0; i < 125; ++i)
    {
        for (const std::string& bytes : {gz_, plain_})
        {
            const std::size_t cut = 1 + rng_() % (bytes.size() - 1);
            RawlogEnding ending;
            const std::size_t n = objectsIn(bytes.substr(0, cut), &ending);
            // Everything before the cut is delivered: objects are of nearly equal size.
            if (&bytes == &plain_)
            {
                EXPECT_GE(n + 2, numObjects_ * cut / bytes.size());
            }
            EXPECT_LE(n, numObjects_);
            EXPECT_NE(ending.kind, RawlogEnd::Clean) << "cut at " << cut << " of " << bytes.size();
            EXPECT_THAT(ending.message, testing::HasSubstr("damaged.rawlog"));
        }
    }
}

TEST_P(RawlogDamageOf, noFlippedBitCrashesOrPassesInGz)
{
    for (int i = 0; i < 500; ++i)
    {
        std::string bytes = gz_;
        const std::size_t at = rng_() % bytes.size();
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << (rng_() % 8)));
        RawlogEnding ending;
        const std::size_t n = objectsIn(bytes, &ending);
        // Some bits of gz mean nothing: the time in the header, padding before a flush.
        if (ending.kind == RawlogEnd::Clean)
        {
            EXPECT_EQ(decompressed(dir_ / "damaged.rawlog"), plain_)
                << "bit flipped in byte " << at;
        }
        EXPECT_LE(n, numObjects_);
    }
}

TEST_P(RawlogDamageOf, noFlippedBitCrashesInPlainFiles)
{
    int reported = 0;
    for (int i = 0; i < 500; ++i)
    {
        std::string bytes = plain_;
        const std::size_t at = rng_() % bytes.size();
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << (rng_() % 8)));
        RawlogEnding ending;
        const std::size_t n = objectsIn(bytes, &ending);
        // A plain file has no checksum: a flipped pixel cannot be seen, a lost object must be.
        if (n < numObjects_)
        {
            EXPECT_NE(ending.kind, RawlogEnd::Clean) << "bit flipped in byte " << at;
            ++reported;
        }
    }
    EXPECT_GT(reported, 0);
}

std::string nameOf(const testing::TestParamInfo<Kind>& info)
{
    static constexpr const char* kNames[] = {"format1", "format2", "externalImages"};
    return kNames[static_cast<std::size_t>(info.param)];
}

INSTANTIATE_TEST_SUITE_P(
    Formats,
    RawlogDamageOf,
    testing::Values(Kind::Format1, Kind::Format2, Kind::ExternalImages),
    nameOf);
}  // namespace
}  // namespace pointplane
