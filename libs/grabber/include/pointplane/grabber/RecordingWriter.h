// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/BoundedQueue.h>
#include <pointplane/grabber/FrameEncoder.h>
#include <pointplane/grabber/ReorderBuffer.h>
#include <pointplane/mrpt_io/CameraNews.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace pointplane
{
class DurableFile;

struct RecordingOptions
{
    std::string path;  //!< of the rawlog; with splitting: name_001.rawlog, name_002.rawlog, ...
    EncodingOptions encoding;
    double splitAfter{0};          //!< [s] of recorded time per file; 0 = one file
    std::size_t queueFrames{150};  //!< that wait in memory, 1.5 MB each at 640x480
    int numThreads{2};             //!< that compress
    bool marksEnds{false};         //!< comments that tell a complete file from one that was cut
    bool tellDelay{false};  //!< of depth after colour, where it changes; images have device times
    std::chrono::milliseconds syncInterval{500};  //!< how much a power failure may cost
};

struct RecordingStats
{
    std::uint64_t framesWritten{0};
    std::uint64_t bytesWritten{0};  //!< rawlogs and external files
    std::size_t framesQueued{0};
};

/** `name_001.rawlog` for segment 0 of `name.rawlog`. */
[[nodiscard]] std::string segmentPath(const std::string& path, int segment);

/** Records image pairs to a rawlog that is readable at any moment.
 *
 * Several threads compress, one appends in order and syncs to the disk. Every record is a complete
 * gz member. A rawlog entry is written only after the external files that it names are on the disk.
 * So a killed process, a power failure or a full disk cost only what came after the last sync. */
class RecordingWriter
{
 public:
    /** \throws InputError if a file exists \throws EnvironmentError if none can be created */
    RecordingWriter(RecordingOptions options, const ObservationBuilder& builder);
    /** As finish(), without reporting errors. */
    ~RecordingWriter();
    RecordingWriter(const RecordingWriter&) = delete;
    RecordingWriter& operator=(const RecordingWriter&) = delete;

    /** Never waits for the disk. \return false if the queue is full: the pair is lost */
    [[nodiscard]] bool tryPush(const ImagePair& pair);

    /** Waits for room in the queue: for sources that can wait. \return false after a failure */
    [[nodiscard]] bool push(const ImagePair& pair);

    /** Whether a disk error has ended the recording; finish() throws it. */
    [[nodiscard]] bool hasFailed() const { return failed_; }

    /** Writes what is queued and closes the file. One without a frame is removed.
     * \throws EnvironmentError if the recording ended early; the frames before are in the file */
    void finish();

    [[nodiscard]] RecordingStats stats() const;

    /** All rawlogs so far. */
    [[nodiscard]] std::vector<std::string> paths() const;

 private:
    struct Job
    {
        std::uint64_t number{0};
        int segment{0};
        bool opensFile{false};
        CameraNews told{""};
        std::string news;  //!< comment before the frame, or empty
        ImagePair pair;
    };
    struct Record
    {
        int segment{0};
        double stamp{0};
        std::vector<std::uint8_t> bytes;
        std::uint64_t externalBytes{0};
    };

    [[nodiscard]] Job makeJob(const ImagePair& pair) const;
    void accepted(const Job& job);
    [[nodiscard]] std::vector<std::string> commentsOf(const Job& job) const;
    void closeSegment(bool isWhole);
    [[nodiscard]] std::string imagesFolder(int segment) const;
    [[nodiscard]] std::string rawlogPath(int segment) const;
    void openSegment(int segment);
    void compressLoop();
    void writeLoop();
    void appendPending();
    void syncSegment();
    void startThreads();
    void joinThreads();
    void guarded(void (RecordingWriter::*work)());

    const RecordingOptions options_;
    const ObservationBuilder& builder_;
    std::uint64_t numJobs_{0};  // of the pushing thread
    double firstStamp_{0};
    CameraNews told_;  // in the opened segment
    int openedSegment_{-1};
    BoundedQueue<Job> queue_;
    ReorderBuffer<Record> encoded_;
    std::unique_ptr<DurableFile> file_;  // of the writing thread, after construction
    double latestStamp_{0};              // likewise
    std::vector<Record> pending_;        // refer to external files that are not synced yet
    int segment_{0};
    std::atomic<std::uint64_t> framesWritten_{0}, bytesWritten_{0};
    std::atomic<int> workersRunning_{0};
    std::atomic<bool> failed_{false};
    mutable std::mutex mutex_;
    std::exception_ptr error_;
    std::vector<std::string> paths_;
    std::vector<std::thread> threads_;
};
}  // namespace pointplane
