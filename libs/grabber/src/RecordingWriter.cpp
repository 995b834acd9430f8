// SPDX-License-Identifier: BSD-3-Clause
#include <pointplane/core/check.h>
#include <pointplane/grabber/DurableFile.h>
#include <pointplane/grabber/RecordingWriter.h>
#include <pointplane/mrpt_io/errors.h>
#include <pointplane/mrpt_io/rawlog_names.h>
#include <pointplane/mrpt_io/recording_marks.h>

#include <algorithm>
#include <filesystem>

namespace pointplane
{
namespace
{
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Encoded frames that may wait for the writer, besides those in the queue.
constexpr std::size_t kMaxEncoded = 16;
}  // namespace

std::string segmentPath(const std::string& path, int segment)
{
    std::string number = std::to_string(segment + 1);
    number.insert(0, number.size() < 3 ? 3 - number.size() : 0, '0');
    const fs::path p(path);
    return (p.parent_path() / (p.stem().string() + "_" + number + p.extension().string())).string();
}

RecordingWriter::RecordingWriter(RecordingOptions options, const ObservationBuilder& builder)
    : options_(std::move(options)),
      builder_(builder),
      told_(builder.calibration().sensorLabel),
      queue_(options_.queueFrames),
      encoded_(kMaxEncoded)
{
    POINTPLANE_CHECK(options_.numThreads > 0, "numThreads is " << options_.numThreads);
    POINTPLANE_CHECK(options_.queueFrames > 0, "queueFrames is " << options_.queueFrames);
    openSegment(0);
    try
    {
        startThreads();
    }
    catch (...)  // no memory for another one: those that run would end the program
    {
        joinThreads();
        throw;
    }
}

void RecordingWriter::startThreads()
{
    workersRunning_ = options_.numThreads;
    for (int i = 0; i < options_.numThreads; ++i)
    {
        threads_.emplace_back(
            [this]
            {
                guarded(&RecordingWriter::compressLoop);
                if (--workersRunning_ == 0)
                {
                    encoded_.close();
                }
            });
    }
    threads_.emplace_back([this] { guarded(&RecordingWriter::writeLoop); });
}

RecordingWriter::~RecordingWriter()
{
    try
    {
        finish();
    }
    catch (const std::exception&)
    {
        // finish() is where errors are reported.
    }
}

void RecordingWriter::guarded(void (RecordingWriter::*work)())
{
    try
    {
        (this->*work)();
    }
    catch (...)
    {
        {
            const std::lock_guard<std::mutex> lock(mutex_);
            error_ = error_ ? error_ : std::current_exception();
        }
        failed_ = true;
        queue_.close();
        encoded_.close();
    }
}

std::string RecordingWriter::rawlogPath(int segment) const
{
    return options_.splitAfter > 0.0 ? segmentPath(options_.path, segment) : options_.path;
}

std::string RecordingWriter::imagesFolder(int segment) const
{
    return imagesFolderOf(rawlogPath(segment));
}

RecordingWriter::Job RecordingWriter::makeJob(const ImagePair& pair) const
{
    Job job;
    job.number = numJobs_;
    job.pair = pair;
    if (options_.splitAfter > 0.0 && numJobs_ > 0)
    {
        // A file that is done stays so, whatever the clock does.
        job.segment = std::max(
            openedSegment_, static_cast<int>((pair.stamp - firstStamp_) / options_.splitAfter));
    }
    job.opensFile = job.segment != openedSegment_;
    const RgbdCalibration& calibration = builder_.calibration();
    job.told = job.opensFile ? CameraNews(calibration.sensorLabel) : told_;
    job.news = job.told.before(
        options_.tellDelay ? pair.depthDelay() : ShutterModel::kUnknown, calibration.isNominal);
    return job;
}

void RecordingWriter::accepted(const Job& job)
{
    if (numJobs_++ == 0)
    {
        firstStamp_ = job.pair.stamp;
    }
    openedSegment_ = job.segment;
    told_ = job.told;
}

bool RecordingWriter::tryPush(const ImagePair& pair)
{
    const Job job = makeJob(pair);
    const bool taken = queue_.tryPush(job);
    if (taken)
    {
        accepted(job);
    }
    return taken;
}

bool RecordingWriter::push(const ImagePair& pair)
{
    const Job job = makeJob(pair);
    const bool taken = queue_.push(job);
    if (taken)
    {
        accepted(job);
    }
    return taken;
}

std::vector<std::string> RecordingWriter::commentsOf(const Job& job) const
{
    std::vector<std::string> out;
    if (job.opensFile && options_.marksEnds)
    {
        out.emplace_back(kRecordingBegins);
    }
    if (!job.news.empty())
    {
        out.push_back(job.news);
    }
    return out;
}

void RecordingWriter::openSegment(int segment)
{
    const auto path = rawlogPath(segment);
    file_ = std::make_unique<DurableFile>(path);
    segment_ = segment;
    const std::lock_guard<std::mutex> lock(mutex_);
    paths_.push_back(path);
}

void RecordingWriter::compressLoop()
{
    FrameEncoder encoder(options_.encoding, builder_);
    while (auto job = queue_.pop())
    {
        const auto folder = imagesFolder(job->segment);
        std::error_code error;
        if (options_.encoding.storage == ImageStorage::External &&
            !fs::create_directories(folder, error) && error)
        {
            throw EnvironmentError("cannot create '" + folder + "': " + error.message());
        }
        Record record;
        record.segment = job->segment;
        record.stamp = job->pair.stamp;
        record.bytes = encoder.encode(job->pair, folder, record.externalBytes, commentsOf(*job));
        encoded_.put(job->number, std::move(record));
    }
}

void RecordingWriter::writeLoop()
{
    auto nextSync = Clock::now() + options_.syncInterval;
    while (!encoded_.isFinished())
    {
        auto record = encoded_.takeFor(options_.syncInterval);
        if (record)
        {
            if (record->segment != segment_)
            {
                closeSegment(true);
                openSegment(record->segment);
            }
            pending_.push_back(std::move(*record));
            if (options_.encoding.storage == ImageStorage::Embedded)
            {
                appendPending();
            }
        }
        if (Clock::now() >= nextSync)
        {
            syncSegment();
            nextSync = Clock::now() + options_.syncInterval;
        }
    }
    closeSegment(!failed_);  // a thread that encodes may have given up
}

void RecordingWriter::closeSegment(bool isWhole)
{
    syncSegment();
    if (isWhole && options_.marksEnds && file_->numBytes() > 0)
    {
        const auto bytes =
            FrameEncoder(options_.encoding, builder_).encode(kRecordingEnds, latestStamp_);
        file_->append(bytes.data(), bytes.size());
    }
    file_->close();
}

void RecordingWriter::appendPending()
{
    for (const auto& record : pending_)
    {
        file_->append(record.bytes.data(), record.bytes.size());
        latestStamp_ = record.stamp;
        bytesWritten_ += record.bytes.size() + record.externalBytes;
        ++framesWritten_;
    }
    pending_.clear();
}

void RecordingWriter::syncSegment()
{
    if (options_.encoding.storage == ImageStorage::External && !pending_.empty())
    {
        syncFolder(imagesFolder(segment_));
    }
    appendPending();
    file_->sync();
}

void RecordingWriter::joinThreads()
{
    queue_.close();
    for (auto& thread : threads_)
    {
        thread.join();
    }
    threads_.clear();
    if (file_ && file_->numBytes() == 0)  // it would be in the way of the next attempt
    {
        std::error_code error;
        fs::remove(file_->path(), error);
        file_.reset();
        const std::lock_guard<std::mutex> lock(mutex_);
        paths_.pop_back();
    }
}

void RecordingWriter::finish()
{
    joinThreads();
    if (error_)
    {
        std::rethrow_exception(std::exchange(error_, nullptr));
    }
}

RecordingStats RecordingWriter::stats() const
{
    return {framesWritten_, bytesWritten_, queue_.size()};
}

std::vector<std::string> RecordingWriter::paths() const
{
    const std::lock_guard<std::mutex> lock(mutex_);
    return paths_;
}
}  // namespace pointplane
