// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/mrpt_io/OutputFile.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <zlib.h>

namespace pointplane
{
/** gz file of which every write is checked, complete or marked as not (OutputFile). zlib's gzFile
 * cannot do it: its close adds the trailer to a file that was not finished, and hides its
 * descriptor from fsync. All members throw EnvironmentError. */
class GzOutput
{
 public:
    GzOutput(const std::string& path, int compressionLevel);
    ~GzOutput();
    GzOutput(const GzOutput&) = delete;
    GzOutput& operator=(const GzOutput&) = delete;

    void write(const void* bytes, std::size_t size);
    /** Everything so far can be decompressed from the file, even if the process is killed. */
    void flush();
    /** Ends the gz stream and gives the file its name. */
    void commit();
    void discard() noexcept { file_.discard(); }
    [[nodiscard]] const OutputFile& file() const { return file_; }

 private:
    void deflateInput(int flushMode);

    OutputFile file_;
    z_stream zlib_{};
    bool usable_{true};
    std::vector<std::uint8_t> compressed_;
};
}  // namespace pointplane
