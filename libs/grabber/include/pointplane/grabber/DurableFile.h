// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace pointplane
{
/** A file that grows by whole records. A record that does not fit on the disk is removed again.
 * After sync(), what was appended survives a power failure. */
class DurableFile
{
 public:
    /** Creates the file; an existing one is never touched.
     * \throws InputError if it exists \throws EnvironmentError if it cannot be created */
    explicit DurableFile(std::string path);
    ~DurableFile();
    DurableFile(const DurableFile&) = delete;
    DurableFile& operator=(const DurableFile&) = delete;

    /** \throws EnvironmentError after removing what had been written of this record */
    void append(const void* data, std::size_t numBytes);

    /** Waits until everything is on the disk. \throws EnvironmentError */
    void sync();

    /** sync() and close. \throws EnvironmentError */
    void close();

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::uint64_t numBytes() const { return numBytes_; }

 private:
    [[noreturn]] void fail(const char* what, int error) const;

    std::string path_;
    int fd_{-1};
    std::uint64_t numBytes_{0};
};

/** Writes a whole file. \throws EnvironmentError, leaving no file */
void writeFile(const std::string& path, const void* data, std::size_t numBytes);

/** Waits until all files on the disk of this folder are written. \throws EnvironmentError */
void syncFolder(const std::string& folder);
}  // namespace pointplane
