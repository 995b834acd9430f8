// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/grabber/DurableFile.h>
#include <pointplane/grabber/RecordingWriter.h>
#include <pointplane/mrpt_io/ObservationConverter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/rawlog_names.h>

#include <mrpt/io/lazy_load_path.h>
#include <mrpt/obs/CRawlog.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "grabber_testing.h"
#include "rawlog_samples.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

namespace
{
using namespace pointplane;
using namespace pointplane::test;
namespace fs = std::filesystem;

constexpr int kColumns = 64, kRows = 48;
constexpr double kFirstStamp = 1.7e9;

CameraFacts facts()
{
    CameraFacts f;
    f.mode = {kColumns, kRows, 30, ""};
    f.registered = true;
    f.colourFocal_px = 52.5;
    return f;
}

ImagePair makePair(const PlainFrame& frame, double stamp)
{
    ImagePair pair;
    pair.stamp = stamp;
    pair.depth.pixels = frame.depth;
    pair.colour.stream = StreamKind::Colour;
    pair.colour.layout = PixelLayout::Rgb8;
    pair.colour.pixels = cv::Mat(frame.colour.size(), CV_8UC3);
    cv::mixChannels(frame.colour, pair.colour.pixels, {0, 2, 1, 1, 2, 0});
    return pair;
}

class Recording : public ::testing::Test
{
 protected:
    void record(const RecordingOptions& options)
    {
        RecordingWriter writer(options, builder_);
        for (std::size_t k = 0; k < frames_.size(); ++k)
        {
            ASSERT_TRUE(writer.push(makePair(frames_[k], stamp(k))));
        }
        writer.finish();
        EXPECT_EQ(writer.stats().framesWritten, frames_.size());
        paths_ = writer.paths();
    }
    static double stamp(std::size_t k) { return kFirstStamp + static_cast<double>(k) / 30.0; }

    RecordingOptions options()
    {
        RecordingOptions o;
        o.path = dir_ / "out.rawlog";
        return o;
    }

    void expectFrame(const mrpt::obs::CObservation3DRangeScan& scan, std::size_t k)
    {
        EXPECT_TRUE(samePixels(depthOf(scan), frames_[k].depth)) << "frame " << k;
        EXPECT_TRUE(samePixels(scan.intensityImage.asCvMatRef(), frames_[k].colour))
            << "frame " << k;
        EXPECT_NEAR(mrpt::Clock::toDouble(scan.timestamp), stamp(k), 1e-6);
    }

    TempDir dir_;
    std::vector<PlainFrame> frames_{patternFrames(40, kColumns, kRows)};
    /** As nominal, but somebody's own. */
    [[nodiscard]] static RgbdCalibration calibration()
    {
        RgbdCalibration out = nominalCalibration(facts());
        out.isNominal = false;
        return out;
    }
    ObservationBuilder builder_{calibration()};
    std::vector<std::string> paths_;
};

TEST_F(Recording, isLosslessAndInOrderAtEveryCompression)
{
    for (const int level : {0, 1, 9})
    {
        auto o = options();
        o.path = dir_ / ("level" + std::to_string(level) + ".rawlog");
        o.encoding.compression = level;
        record(o);
        const auto scans = scansOf(o.path);
        ASSERT_EQ(scans.size(), frames_.size());
        for (std::size_t k = 0; k < scans.size(); ++k)
        {
            expectFrame(*scans[k], k);
        }
    }
}

TEST_F(Recording, observationCarriesTheCalibration)
{
    record(options());
    const auto scan = scansOf(options().path).front();
    EXPECT_EQ(scan->sensorLabel, "OPENNI2");
    EXPECT_EQ(scan->rangeUnits, 0.001F);
    EXPECT_TRUE(scan->range_is_depth);
    EXPECT_EQ(scan->cameraParams.fx(), 52.5);
    EXPECT_EQ(scan->cameraParamsIntensity.cx(), 31.5);
    EXPECT_TRUE(scan->doDepthAndIntensityCamerasCoincide());
}

TEST_F(Recording, isReadByMrptItself)
{
    record(options());
    mrpt::obs::CRawlog rawlog;
    ASSERT_TRUE(rawlog.loadFromRawLogFile(options().path));
    ASSERT_EQ(rawlog.size(), frames_.size());
    const auto scan =
        std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(rawlog.getAsObservation(7));
    ASSERT_TRUE(scan);
    expectFrame(*scan, 7);
}

TEST_F(Recording, externalImagesAreReadByMrptItself)
{
    auto o = options();
    o.encoding.storage = ImageStorage::External;
    record(o);
    EXPECT_LT(fs::file_size(o.path), 40U * 1500U);
    mrpt::obs::CRawlog rawlog;
    ASSERT_TRUE(rawlog.loadFromRawLogFile(o.path));
    ASSERT_EQ(rawlog.size(), frames_.size());
    // CRawlog::detectImagesDirectory() finds this folder for paths without a directory only.
    mrpt::io::setLazyLoadPathBase(dir_ / "out_Images/");
    for (std::size_t k = 0; k < frames_.size(); ++k)
    {
        const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(
            rawlog.getAsObservation(k));
        ASSERT_TRUE(scan);
        scan->load();
        expectFrame(*scan, k);
    }
}

TEST_F(Recording, jpegIsSmallerAndClose)
{
    auto o = options();
    o.path = dir_ / "raw.rawlog";
    record(o);
    o.path = dir_ / "jpeg.rawlog";
    o.encoding.jpegQuality = 95;
    record(o);
    EXPECT_LT(fs::file_size(dir_ / "jpeg.rawlog"), fs::file_size(dir_ / "raw.rawlog"));
    const auto scans = scansOf(dir_ / "jpeg.rawlog");
    ASSERT_EQ(scans.size(), frames_.size());
    EXPECT_TRUE(samePixels(depthOf(*scans[3]), frames_[3].depth));
    cv::Mat difference;
    cv::absdiff(scans[3]->intensityImage.asCvMatRef(), frames_[3].colour, difference);
    EXPECT_LT(cv::norm(cv::mean(difference)), 5.0);
    mrpt::img::CImage::DISABLE_JPEG_COMPRESSION(true);
}

TEST_F(Recording, splitsByRecordedTime)
{
    auto o = options();
    o.splitAfter = 0.5;
    record(o);
    const std::vector<std::string> expected{
        dir_ / "out_001.rawlog", dir_ / "out_002.rawlog", dir_ / "out_003.rawlog"};
    EXPECT_EQ(paths_, expected);
    EXPECT_EQ(scansOf(expected[0]).size(), 15U);
    EXPECT_EQ(scansOf(expected[1]).size(), 15U);
    EXPECT_EQ(scansOf(expected[2]).size(), 10U);
}

TEST_F(Recording, neverOverwrites)
{
    writeBytes(options().path, "precious");
    EXPECT_THROW(RecordingWriter(options(), builder_), InputError);
    EXPECT_EQ(readBytes(options().path), "precious");
}

/** It would be in the way of the next attempt. */
TEST_F(Recording, aFileWithoutAFrameIsRemoved)
{
    for (const double splitAfter : {0.0, 0.5})
    {
        auto o = options();
        o.splitAfter = splitAfter;
        o.marksEnds = true;
        RecordingWriter writer(o, builder_);
        ASSERT_EQ(writer.paths().size(), 1U);
        const std::string path = writer.paths().front();
        EXPECT_TRUE(fs::exists(path));
        writer.finish();
        EXPECT_FALSE(fs::exists(path));
        EXPECT_TRUE(writer.paths().empty());
    }
}

TEST_F(Recording, anImpossibleFolderIsAnEnvironmentError)
{
    auto o = options();
    o.path = dir_ / "missing/out.rawlog";
    EXPECT_THROW(RecordingWriter(o, builder_), EnvironmentError);
}

/** Complete records make a complete file of any part, unless it says where it ends. */
TEST_F(Recording, aCutBetweenTwoFramesIsTold)
{
    for (const double splitAfter : {0.0, 0.5})
    {
        auto o = options();
        o.path = dir_ / (splitAfter > 0 ? "split.rawlog" : "one.rawlog");
        o.splitAfter = splitAfter;
        o.marksEnds = true;
        record(o);
        for (const std::string& path : paths_)
        {
            const std::string bytes = test::readBytes(path);
            const test::RawlogContents whole = test::readAll(path);
            EXPECT_EQ(whole.ending.kind, RawlogEnd::Clean) << whole.ending.message;
            // Members of the file are frames, the first one with a mark, and the end mark.
            std::size_t numCuts = 0;
            const std::string member("\x1F\x8B\x08", 3);
            for (std::size_t at = bytes.find(member, 1); at != std::string::npos;
                 at = bytes.find(member, at + 1))
            {
                test::writeBytes(dir_ / "cut.rawlog", bytes.substr(0, at));
                const test::RawlogContents cut = test::readAll(dir_ / "cut.rawlog");
                EXPECT_EQ(cut.ending.kind, RawlogEnd::Truncated);
                EXPECT_THAT(cut.ending.message, testing::HasSubstr("its program still records or"));
                ++numCuts;
            }
            EXPECT_GE(numCuts, whole.objects.size() - 2);
            EXPECT_GE(numCuts, 9U);
        }
    }
}

TEST_F(Recording, aLabelLeadsToNoOtherFolder)
{
    RgbdCalibration named = calibration();
    named.sensorLabel = "../../front";
    const ObservationBuilder builder(named);
    auto o = options();
    o.encoding.storage = ImageStorage::External;
    RecordingWriter writer(o, builder);
    ASSERT_TRUE(writer.push(makePair(frames_[0], stamp(0))));
    writer.finish();
    const fs::directory_iterator files(imagesFolderOf(o.path));
    EXPECT_EQ(std::distance(begin(files), end(files)), 2);
    EXPECT_EQ(test::scansOf(o.path).at(0)->sensorLabel, "../../front");
}

/** Of a thread that encodes: the other one then has all that came before, and nothing more. */
TEST_F(Recording, isNotMarkedAsWholeAfterAFailure)
{
    auto o = options();
    o.marksEnds = true;
    o.encoding.storage = ImageStorage::External;
    o.numThreads = 1;
    RecordingWriter writer(o, builder_);
    for (std::size_t k = 0; k < 5; ++k)
    {
        ASSERT_TRUE(writer.push(makePair(frames_[k], stamp(k))));
    }
    while (writer.stats().framesWritten < 5)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const std::string folder = imagesFolderOf(o.path);
    fs::rename(folder, dir_ / "elsewhere");
    test::writeBytes(folder, "in the way");
    while (!writer.hasFailed())
    {
        (void)writer.push(makePair(frames_[5], stamp(5)));
    }
    EXPECT_THROW(writer.finish(), EnvironmentError);
    EXPECT_EQ(test::readAll(o.path).ending.kind, RawlogEnd::Truncated);
}

/** A clock that is set back does not lead back to the file before. */
TEST_F(Recording, splitsOnceWhereStampsGoBack)
{
    auto o = options();
    o.splitAfter = 0.5;
    RecordingWriter writer(o, builder_);
    for (const double second : {0.0, 0.6, 0.1, -3.0, 0.7, 1.1})
    {
        ASSERT_TRUE(writer.push(makePair(frames_[0], kFirstStamp + second)));
    }
    writer.finish();
    const auto paths = writer.paths();
    ASSERT_EQ(paths.size(), 3U);
    EXPECT_EQ(test::readAll(paths[1]).objects.size(), 4U);
}

TEST_F(Recording, tellsThatIntrinsicsAreNominal)
{
    const ObservationBuilder builder(nominalCalibration(facts()));
    RecordingWriter writer(options(), builder);
    for (std::size_t k = 0; k < 3; ++k)
    {
        ASSERT_TRUE(writer.push(makePair(frames_[k], stamp(k))));
    }
    writer.finish();
    ObservationConverter converter;
    const test::RawlogContents contents = test::readAll(options().path);
    ASSERT_EQ(contents.objects.size(), 4U);  // told once
    converter.readComment(
        dynamic_cast<const mrpt::obs::CObservationComment&>(*contents.objects[0]));
    const auto scan =
        std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(contents.objects[3]);
    ASSERT_TRUE(scan);
    EXPECT_TRUE(converter.convert(*scan).frame.camera.isNominal);
    EXPECT_FALSE(ObservationConverter().convert(*scan).frame.camera.isNominal);
}

/** Told at the start of each file and where it changes, as the odometry reads it. */
TEST_F(Recording, tellsTheDelayBetweenTheTwoImages)
{
    auto o = options();
    o.tellDelay = true;
    o.splitAfter = 1.0;
    RecordingWriter writer(o, builder_);
    for (std::size_t k = 0; k < frames_.size(); ++k)
    {
        ImagePair pair = makePair(frames_[k], stamp(k));
        pair.colour.deviceTime = 5 + static_cast<double>(k) / 30;
        pair.depth.deviceTime = pair.colour.deviceTime + (k < 10 ? 0.004 : -0.012);
        ASSERT_TRUE(writer.push(pair));
    }
    writer.finish();
    std::size_t frame = 0, comments = 0;
    ASSERT_EQ(writer.paths().size(), 2U);
    for (const std::string& path : writer.paths())
    {
        ObservationConverter converter;
        RawlogReader reader(path);
        while (const auto object = reader.next())
        {
            if (const auto comment =
                    std::dynamic_pointer_cast<mrpt::obs::CObservationComment>(object))
            {
                converter.readComment(*comment);
                ++comments;
                continue;
            }
            const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation3DRangeScan>(object);
            ASSERT_TRUE(scan);
            EXPECT_NEAR(
                converter.convert(*scan).frame.shutter.depthDelay,
                frame < 10 ? 0.004 : -0.012,
                1e-9);
            ++frame;
        }
    }
    EXPECT_EQ(frame, frames_.size());
    EXPECT_EQ(comments, 3U);
}

TEST_F(Recording, aFullQueueRefusesInsteadOfWaiting)
{
    auto o = options();
    o.queueFrames = 2;
    o.numThreads = 1;
    const auto big = patternFrames(1, 640, 480).front();
    RecordingWriter writer(o, builder_);
    std::uint64_t taken = 0;
    for (int k = 0; k < 200; ++k)
    {
        taken += writer.tryPush(makePair(big, kFirstStamp + k)) ? 1 : 0;
    }
    writer.finish();
    EXPECT_LT(taken, 200U);
    EXPECT_EQ(writer.stats().framesWritten, taken);
}

/** Size limit of this process's files: writes fail in the middle of a record, as on a full disk. */
class FileSizeLimit
{
 public:
    explicit FileSizeLimit(rlim_t numBytes)
    {
        std::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &before_);
        rlimit limit = before_;
        limit.rlim_cur = numBytes;
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
    rlimit before_{};
};

TEST_F(Recording, aFullDiskKeepsEverythingBefore)
{
    const auto o = options();
    RecordingWriter writer(o, builder_);
    {
        const FileSizeLimit limit(50'000);  // about 9 frames
        for (std::size_t k = 0; k < frames_.size(); ++k)
        {
            (void)writer.push(makePair(frames_[k], stamp(k)));
        }
        EXPECT_THROW(writer.finish(), EnvironmentError);
    }
    EXPECT_TRUE(writer.hasFailed());
    const auto scans = scansOf(o.path);  // ends cleanly: no part of a record is left
    EXPECT_EQ(scans.size(), writer.stats().framesWritten);
    EXPECT_GE(scans.size(), 3U);
    EXPECT_LT(scans.size(), frames_.size());
    expectFrame(*scans.back(), scans.size() - 1);
}

TEST(DurableFile, takesBackARecordThatDoesNotFit)
{
    const TempDir dir;
    DurableFile file(dir / "file");
    file.append("12345678", 8);
    {
        const FileSizeLimit limit(10);
        EXPECT_THROW(file.append("abcdefgh", 8), EnvironmentError);
    }
    EXPECT_EQ(file.numBytes(), 8U);
    EXPECT_EQ(readBytes(dir / "file"), "12345678");
    file.append("xy", 2);
    file.close();
    EXPECT_EQ(readBytes(dir / "file"), "12345678xy");
}
}  // namespace
