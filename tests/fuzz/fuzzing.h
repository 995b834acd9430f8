// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pointplane/core/PoseGaussian.h>
#include <pointplane/core/covariance.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <stdexcept>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace pointplane::fuzzing
{
/** What must be true of any input; libFuzzer keeps the input when it is not. */
inline void require(bool condition, const char* what)
{
    if (!condition)
    {
        std::fprintf(stderr, "broken promise: %s\n", what);
        std::abort();
    }
}

/** Messages for users are one line that says something. */
inline void requireOneLine(const std::string& message)
{
    require(!message.empty() && message.find('\n') == std::string::npos, "a message of one line");
}

/** A result that a filter downstream can use. */
inline void requireSound(const PoseGaussian& pose)
{
    if (!pose.mean.matrix().allFinite() || !isPositiveDefinite(pose.cov))
    {
        std::cerr << "pose\n" << pose.mean.matrix() << "\ncovariance\n" << pose.cov << "\n";
    }
    require(pose.mean.matrix().allFinite(), "a finite pose");
    require(isPositiveDefinite(pose.cov), "a positive definite covariance");
}

/** A file in memory, for readers that take a path. */
class MemoryFile
{
 public:
    MemoryFile() : fd_(::memfd_create("fuzz", MFD_CLOEXEC))
    {
        if (fd_ < 0)
        {
            throw std::runtime_error("memfd_create failed");
        }
    }
    ~MemoryFile() { ::close(fd_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    void assign(const std::uint8_t* data, std::size_t size) const
    {
        const bool good = ::ftruncate(fd_, 0) == 0 &&
                          ::pwrite(fd_, data, size, 0) == static_cast<::ssize_t>(size);
        require(good, "the file in memory can be written");
    }
    [[nodiscard]] static std::string folder() { return "/proc/self/fd"; }
    [[nodiscard]] std::string name() const { return std::to_string(fd_); }
    [[nodiscard]] std::string path() const { return folder() + "/" + name(); }

 private:
    int fd_;
};
}  // namespace pointplane::fuzzing
