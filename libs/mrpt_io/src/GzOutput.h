// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <zlib.h>

namespace pointplane
{
/** gz file of which every write is checked. zlib's gzFile cannot do it: its close adds the trailer
 * to a file that was not finished, and hides its descriptor from fsync. Nothing happens at
 * destruction but closing the descriptor. All members throw EnvironmentError. */
class GzOutput
{
 public:
    /** Creates or truncates the file. */
    GzOutput(const std::string& path, int compressionLevel);
    ~GzOutput();
    GzOutput(const GzOutput&) = delete;
    GzOutput& operator=(const GzOutput&) = delete;

    void write(const void* bytes, std::size_t size);
    /** Everything so far can be decompressed from the file, even if the process is killed. */
    void flush();
    /** Ends the gz stream and waits until the disk has it. */
    void finish();

 private:
    void deflateInput(int flushMode);
    void writeToFile(const std::uint8_t* bytes, std::size_t size);
    [[noreturn]] void fail(const char* action) const;

    std::string path_;
    int fd_{-1};
    z_stream zlib_{};
    std::vector<std::uint8_t> compressed_;
};
}  // namespace pointplane
