// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace pointplane
{
/** Where the bytes of an output go. */
struct OutputTarget
{
    std::string path;        //!< symbolic links followed; to be opened
    bool isReplaced{false};  //!< a regular file, or none: appears complete, by renaming

    /** The file that is being written: `<path>.partial` if it is replaced, else the path itself. */
    [[nodiscard]] std::string writtenPath() const { return isReplaced ? path + ".partial" : path; }
};

/** Where to write an output that the user names. Devices, pipes, and the file that the standard
 * output goes to are written directly; anything else is replaced when it is complete. */
[[nodiscard]] OutputTarget outputTarget(const std::string& path);

/** Whether this output goes to the file or pipe that the standard output goes to, as /dev/stdout
 * does. Then nothing else may be written there. No: a terminal, which takes both. */
[[nodiscard]] bool isStandardOutput(const std::string& path);

/** A file that appears under its name when it is complete. Until then it is `<target>.partial`, and
 * an earlier file with its name is untouched. Every write is checked and reaches the operating
 * system at once. All members throw EnvironmentError naming the file. */
class OutputFile
{
 public:
    /** Creates or truncates the partial file; one that is replaced keeps its permissions. A partial
     * file that another program is writing, or that is a link or anything else than a file, is
     * refused. */
    explicit OutputFile(const std::string& path);
    /** Leaves the partial file if neither commit() nor discard() was called. */
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(const void* bytes, std::size_t size);
    /** Waits until the disk has everything, and renames the file. */
    void commit();
    /** Renames it at once: for pictures, of which a power failure may take the latest. */
    void commitUnsynced();
    /** Removes the partial file; nothing after commit(). */
    void discard() noexcept;

    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string writtenPath() const { return target_.writtenPath(); }

 private:
    [[noreturn]] void fail(const char* action) const;

    std::string path_;
    OutputTarget target_;
    int fd_{-1};
};
}  // namespace pointplane
